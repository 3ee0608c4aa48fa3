#include "benchmark_driver/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <set>

#include "messaging/asked_runs.h"
#include "tests/benchmark_driver/fake_nodes.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class RecorderTest : public testing::Test {
 protected:
  RecorderTest() { bus_.Start(); }

  static RunRecordMessage RunOf(const std::string& id) {
    RunRecordMessage record;
    record.run_id = "run";
    record.request_id = id;
    record.planner = record.contestant = "arm";
    return record;
  }
  static SessionMessage Session() {
    SessionMessage session;
    session.run_id = "run";
    return session;
  }
  void AwaitLogger() {
    ASSERT_TRUE(registry_.WaitUntil([&] { return !registry_.Live(NodeKind::kLogger).empty(); },
                                    kTestPatience));
  }

  Bus bus_{"memq://"};
  NodeRegistry registry_{&bus_};
  TemporaryFolder folder_;
  Recorder recorder_{&bus_, &registry_, folder_.path()};
};

TEST_F(RecorderTest, RecordsRunsAndSessions) {
  FakeLogger logger(&bus_);
  AwaitLogger();
  recorder_.Record(Session());
  recorder_.Record(RunOf("a"));
  EXPECT_EQ(recorder_.num_unrecorded(), 0u);
  EXPECT_TRUE(recorder_.Complete());
  EXPECT_TRUE(recorder_.Shortcomings().empty());
  EXPECT_GE(logger.sessions().messages().size(), 1u);
  EXPECT_GE(logger.records().messages().size(), 1u);
}

TEST_F(RecorderTest, RepeatsUntilAcknowledged) {
  FakeLogger logger(&bus_);
  logger.num_to_ignore = 2;
  AwaitLogger();
  recorder_.Record(RunOf("a"));
  EXPECT_EQ(recorder_.num_unrecorded(), 0u);
  EXPECT_GE(logger.records().messages().size(), 3u);
}

TEST_F(RecorderTest, RefusalCountsAsNotRecorded) {
  FakeLogger logger(&bus_);
  logger.refuse = true;
  AwaitLogger();
  recorder_.Record(RunOf("a"));
  EXPECT_EQ(recorder_.num_unrecorded(), 1u);
  logger.refuse = false;
  recorder_.Record(RunOf("b"));
  EXPECT_EQ(recorder_.num_unrecorded(), 1u);
  EXPECT_FALSE(recorder_.Complete());
  EXPECT_THAT(recorder_.Shortcomings(),
              ElementsAre(AllOf(HasSubstr("1 of 2"), HasSubstr("'logger'"), HasSubstr("odd"))));
}

TEST_F(RecorderTest, ARefusedSessionIsToldOnceAndIsNotRecorded) {
  FakeLogger logger(&bus_);
  logger.refuse = true;
  AwaitLogger();
  testing::internal::CaptureStdout();  // Where messages go.
  recorder_.Record(Session());
  SessionMessage end = Session();
  end.total_time_s = 1;
  recorder_.Record(end);
  EXPECT_FALSE(recorder_.Complete());
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("the logger 'logger' refuses the session: it is odd"));
  EXPECT_EQ(said.find("refuses"), said.rfind("refuses")) << said;
  EXPECT_THAT(recorder_.Shortcomings(),
              ElementsAre(AllOf(HasSubstr("the session is not stored"), HasSubstr("it is odd"))));
  logger.refuse = false;
  end.total_time_s = 2;
  recorder_.Record(end);
  EXPECT_TRUE(recorder_.Complete());
}

TEST_F(RecorderTest, ALoggerThatCannotDecodeTheSessionAnswers) {
  FakeLogger logger(&bus_);
  logger.num_to_ignore = 1'000'000;
  const Subscription refusals =
      bus_.Subscribe<SessionMessage>(channel::kSession, [this](const SessionMessage& session) {
        bus_.Publish(channel::kSessionAck,
                     AckMessage{session.run_id, "logger", false, "cannot be decoded"});
      });
  AwaitLogger();
  testing::internal::CaptureStdout();  // Where messages go.
  recorder_.Record(Session());
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("the logger 'logger' refuses the session: cannot be decoded"));
  EXPECT_THAT(said, testing::Not(HasSubstr("NOBODY RECORDS")));
}

TEST_F(RecorderTest, WithoutLoggerIsPublishedAndSaidOnce) {
  MessageCollector<RunRecordMessage> watched(&bus_, channel::kRunRecord);
  testing::internal::CaptureStdout();  // Where messages go.
  recorder_.Record(Session());
  recorder_.Record(RunOf("a"));
  recorder_.Record(RunOf("b"));
  EXPECT_EQ(recorder_.num_unrecorded(), 2u);
  EXPECT_EQ(watched.WaitFor(2).size(), 2u);
  EXPECT_FALSE(recorder_.Complete());
  EXPECT_THAT(recorder_.Shortcomings(), ElementsAre(HasSubstr("none of 2 run records is stored")));
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_EQ(said.find("NOBODY RECORDS"), said.rfind("NOBODY RECORDS")) << said;
  EXPECT_THAT(said, HasSubstr("NOBODY RECORDS"));
}

TEST_F(RecorderTest, ALoggerThatComesLaterIsBroughtUpToDate) {
  recorder_.Record(Session());
  for (int i = 0; i < 40; ++i) recorder_.Record(RunOf(std::to_string(i)));  // more than a window
  FakeLogger logger(&bus_);
  AwaitLogger();
  testing::internal::CaptureStdout();
  recorder_.Record(RunOf("last"));
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("records again"));
  EXPECT_EQ(recorder_.num_unrecorded(), 0u);
  EXPECT_TRUE(recorder_.Complete());
  std::set<std::string> ids;
  for (const auto& record : logger.records().messages()) ids.insert(record.request_id);
  EXPECT_EQ(ids.size(), 41u);
  EXPECT_GE(logger.sessions().messages().size(), 1u);
}

TEST_F(RecorderTest, ASecondLoggersLossIsTold) {
  FakeLogger first(&bus_);
  FakeLogger second(&bus_, "second");
  second.num_to_ignore = 1'000'000;
  ASSERT_TRUE(registry_.WaitUntil([&] { return registry_.Live(NodeKind::kLogger).size() == 2; },
                                  kTestPatience));
  recorder_.silence_patience = std::chrono::milliseconds(100);
  recorder_.Record(Session());
  recorder_.Record(RunOf("a"));
  EXPECT_TRUE(recorder_.Complete());
  EXPECT_EQ(recorder_.num_unrecorded(), 0u);
  EXPECT_THAT(recorder_.Shortcomings(),
              ElementsAre(AllOf(HasSubstr("1 of 1"), HasSubstr("'second'"))));
}

TEST_F(RecorderTest, OfTwoLoggersOfAFolderTheOneThatCameLaterRecordsWhateverTheTimeOfDay) {
  const auto started_at = [](std::int64_t utime) {
    return [utime](NodeStatusMessage* status) {
      status->settings["out"] = "/session";
      status->start_utime = utime;
    };
  };
  FakeLogger killed(&bus_, "x", started_at(2'000'000));
  killed.num_to_ignore = 1'000'000;
  AwaitLogger();
  FakeLogger again(&bus_, "a", started_at(1'000'000));  // the clock was set back meanwhile
  ASSERT_TRUE(registry_.WaitUntil([&] { return registry_.Live(NodeKind::kLogger).size() == 2; },
                                  kTestPatience));
  recorder_.silence_patience = std::chrono::milliseconds(100);
  recorder_.Record(RunOf("a"));
  EXPECT_EQ(recorder_.num_unrecorded(), 0u);
  EXPECT_EQ(bus_.contradictions().count(), 0);
}

TEST_F(RecorderTest, ALoggerInTroubleIsNotWaitedForAndGetsEverythingAfterwards) {
  FakeLogger logger(&bus_);
  logger.troubled = true;
  logger.Announce();
  ASSERT_TRUE(registry_.WaitUntil(
      [&] {
        const auto live = registry_.Live(NodeKind::kLogger);
        return !live.empty() && !live[0].trouble.empty();
      },
      kTestPatience));
  recorder_.return_patience = std::chrono::milliseconds(0);
  testing::internal::CaptureStdout();
  recorder_.Record(Session());
  recorder_.Record(RunOf("a"));
  EXPECT_FALSE(recorder_.Complete());
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("NOBODY RECORDS: the logger 'logger' cannot: disk full"));
  EXPECT_THAT(recorder_.Shortcomings(), ElementsAre(HasSubstr("disk full")));
  logger.troubled = false;
  logger.Announce();
  ASSERT_TRUE(registry_.WaitUntil(
      [&] { return registry_.Live(NodeKind::kLogger)[0].trouble.empty(); }, kTestPatience));
  EXPECT_TRUE(recorder_.Complete());
}

TEST_F(RecorderTest, AcknowledgementOfTheBeginningIsNoneOfTheEnd) {
  FakeLogger logger(&bus_);
  AwaitLogger();
  recorder_.Record(Session());
  logger.num_to_ignore = 1;
  SessionMessage end = Session();
  end.total_time_s = 1;  // interrupted: it is not finished
  bus_.Publish(channel::kSessionAck, AckMessage{SessionAckId(Session()), "logger", true, ""});
  recorder_.Record(end);
  EXPECT_GE(logger.sessions().Count([](const SessionMessage& s) { return s.total_time_s == 1; }),
            2u);
}

TEST_F(RecorderTest, AcknowledgementOfADisturbedAttemptIsNoneOfItsRepeat) {
  FakeLogger logger(&bus_);
  logger.num_to_ignore = 1'000'000;
  AwaitLogger();
  recorder_.silence_patience = recorder_.return_patience = std::chrono::milliseconds(0);
  RunRecordMessage repeat = RunOf("a");
  repeat.result.result.counters["repeats"] = 1;
  recorder_.Record(RunOf("a"));
  recorder_.Record(repeat);
  const auto await_acks = [&](const std::string& id, std::size_t num_left) {
    bus_.Publish(channel::kRunRecordAck, AckMessage{id, "logger", true, ""});
    EXPECT_TRUE(
        registry_.WaitUntil([&] { return recorder_.num_unrecorded() == num_left; }, kTestPatience));
  };
  await_acks("a", 1);
  EXPECT_FALSE(recorder_.Complete());  // sends the repeat
  await_acks("a", 1);
  EXPECT_FALSE(recorder_.Complete());
  await_acks(RunRecordAckId(repeat), 0);
}

TEST_F(RecorderTest, ARefusalThatDoesNotTellOfWhichRepeatIsOfTheOneUnderWay) {
  FakeLogger logger(&bus_);
  logger.num_to_ignore = 1'000'000;
  AwaitLogger();
  recorder_.silence_patience = std::chrono::milliseconds(0);
  recorder_.Record(RunOf("a"));
  bus_.Publish(channel::kRunRecordAck, AckMessage{"a", "logger", true, ""});
  ASSERT_TRUE(registry_.WaitUntil([&] { return recorder_.num_unrecorded() == 0; }, kTestPatience));
  RunRecordMessage repeat = RunOf("a");
  repeat.result.result.counters["repeats"] = 1;
  recorder_.Record(repeat);
  bus_.Publish(channel::kRunRecordAck, AckMessage{"a", "logger", false, "cannot be decoded"});
  EXPECT_TRUE(registry_.WaitUntil(
      [&] { return recorder_.Shortcomings().at(0).ends_with("cannot be decoded"); },
      kTestPatience));
  EXPECT_EQ(recorder_.num_unrecorded(), 1u);
}

TEST_F(RecorderTest, AcknowledgementOfAnotherRecordOrByAStrangerIsNone) {
  FakeLogger logger(&bus_);
  logger.num_to_ignore = 1;
  AwaitLogger();
  bus_.Publish(channel::kRunRecordAck, AckMessage{"another", "logger", true, ""});
  bus_.Publish(channel::kRunRecordAck, AckMessage{"a", "stranger", true, ""});
  recorder_.Record(RunOf("a"));
  EXPECT_GE(logger.records().messages().size(), 2u);
  EXPECT_EQ(bus_.contradictions().count(), 1);
}

TEST_F(RecorderTest, ALoggerThatAcknowledgesNothingButOtherRecordsIsNotWaitedFor) {
  FakeLogger logger(&bus_);
  logger.num_to_ignore = 1'000'000;
  const Subscription others =
      bus_.Subscribe<RunRecordMessage>(channel::kRunRecord, [this](const RunRecordMessage&) {
        bus_.Publish(channel::kRunRecordAck, AckMessage{"another", "logger", true, ""});
      });
  AwaitLogger();
  recorder_.silence_patience = std::chrono::milliseconds(800);  // more than until it is sent again
  recorder_.Record(RunOf("a"));
  EXPECT_EQ(recorder_.num_unrecorded(), 1u);
}

/// Adds records of 0 to 49 bytes.
void AddFifty(RecordSpool* spool) {
  for (int i = 0; i < 50; ++i) {
    spool->Add({std::to_string(i),
                std::vector<std::uint8_t>(static_cast<std::size_t>(i), std::uint8_t(i))});
  }
}

void ExpectFifty(RecordSpool* spool) {
  ASSERT_EQ(spool->size(), 50u);
  for (const int i : {0, 49, 7, 14, 13, 30}) {
    const RecordSpool::Record record = spool->At(static_cast<std::size_t>(i));
    EXPECT_EQ(record.id, std::to_string(i));
    EXPECT_EQ(record.bytes,
              std::vector<std::uint8_t>(static_cast<std::size_t>(i), std::uint8_t(i)));
  }
}

TEST(RecordSpoolTest, GivesBackWhatItWasGivenInMemoryAndBeyond) {
  const TemporaryFolder folder;
  RecordSpool spool(folder.path(), 100);
  AddFifty(&spool);
  ExpectFifty(&spool);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "unlinked";
}

TEST(RecordSpoolTest, WithoutAFolderItKeepsAllInMemory) {
  const TemporaryFolder folder;
  RecordSpool spool(folder / "none", 100);
  testing::internal::CaptureStdout();
  AddFifty(&spool);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr((folder / "none").string() + ": No such file"), HasSubstr("memory")));
  ExpectFifty(&spool);
}

TEST(RecordSpoolTest, WhatAFullDiskHoldsCanBeReadAndTheRestIsInMemory) {
  const TemporaryFolder folder;
  RecordSpool spool(folder.path(), 100);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit full = before;
  full.rlim_cur = 500;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  AddFifty(&spool);
  ExpectFifty(&spool);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
}

}  // namespace
}  // namespace planbench
