#include "logger/session_recorder.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "messaging/asked_runs.h"
#include "messaging/channels.h"
#include "messaging/event_log_reader.h"
#include "results/bus_json.h"
#include "sample_messages.h"
#include "session_files.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

struct Acknowledged {
  std::string channel;
  AckMessage ack;
};

class SessionRecorderTest : public testing::Test {
 protected:
  std::filesystem::path Folder() const { return temporary_ / "s"; }

  std::unique_ptr<SessionRecorder> Open(bool resume = false) {
    return std::make_unique<SessionRecorder>(
        Folder(), resume, "scribe",
        [this](const std::string& channel, const AckMessage& ack) {
          acks_.push_back({channel, ack});
        },
        &contradictions_);
  }

  std::int64_t Count(const std::string& table) {
    SqliteConnection connection(Folder() / "results.sqlite", SqliteConnection::Mode::kReadOnly);
    return std::get<std::int64_t>(connection.QueryValue("SELECT count(*) FROM " + table));
  }

  std::vector<ReceivedMessage> Events() {
    std::vector<ReceivedMessage> events;
    ReadEventLog(Folder() / "s.lcmlog",
                 [&](const ReceivedMessage& message) { events.push_back(message); });
    return events;
  }

  TemporaryFolder temporary_;
  Contradictions contradictions_;
  std::vector<Acknowledged> acks_;
};

TEST_F(SessionRecorderTest, StoresAndAcknowledges) {
  const auto recorder = Open();
  recorder->Record(Received(channel::kSession, SampleSession()));
  recorder->Record({"SOMETHING_ELSE", {1, 2, 3}, 7});
  recorder->Record(Received(channel::kRunRecord, SampleRecord()));
  ASSERT_EQ(acks_.size(), 2);
  EXPECT_EQ(acks_[0].channel, channel::kSessionAck);
  EXPECT_EQ(acks_[0].ack.id, SessionAckId(SampleSession()));
  EXPECT_EQ(acks_[0].ack.sender, "scribe");
  EXPECT_TRUE(acks_[0].ack.ok);
  EXPECT_EQ(acks_[1].channel, channel::kRunRecordAck);
  EXPECT_EQ(acks_[1].ack.id, "request-1");
  EXPECT_TRUE(acks_[1].ack.ok);
  EXPECT_EQ(Count("runs"), 1);
  const std::vector<ReceivedMessage> events = Events();
  ASSERT_EQ(events.size(), 3);
  EXPECT_EQ(events[1].channel, "SOMETHING_ELSE");
  EXPECT_EQ(events[1].bytes, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(events[1].utime, 7);
}

TEST_F(SessionRecorderTest, AcknowledgesARepetitionAgain) {
  const auto recorder = Open();
  recorder->Record(Received(channel::kRunRecord, SampleRecord()));
  recorder->Record(Received(channel::kRunRecord, SampleRecord()));
  ASSERT_EQ(acks_.size(), 2);
  EXPECT_TRUE(acks_[1].ack.ok);
  EXPECT_EQ(Count("runs"), 1);
  EXPECT_EQ(recorder->tally().runs, 1);
  EXPECT_EQ(recorder->tally().repetitions, 1);
  EXPECT_EQ(recorder->tally().failures, 0);
  testing::internal::CaptureStdout();
  recorder->Report();
  EXPECT_NE(
      testing::internal::GetCapturedStdout().find("1 runs (1 records came again, 0 were replaced)"),
      std::string::npos)
      << "no word of repeats, which runs are that were disturbed";
}

TEST_F(SessionRecorderTest, TheFirstRecordOfARunStandsAndTheOtherIsRefused) {
  const auto recorder = Open();
  recorder->Record(Received(channel::kRunRecord, SampleRecord()));
  RunRecordMessage other = SampleRecord();
  other.result.result.planning_time_s = 1e-6;
  recorder->Record(Received(channel::kRunRecord, other));
  ASSERT_EQ(acks_.size(), 2);
  EXPECT_FALSE(acks_[1].ack.ok);
  EXPECT_NE(acks_[1].ack.message.find("contradicts"), std::string::npos);
  EXPECT_EQ(Count("runs"), 1);
  EXPECT_EQ(Count("runs WHERE time = 0.25"), 1);
  EXPECT_EQ(contradictions_.count(), 1);
}

TEST_F(SessionRecorderTest, NothingIsAcknowledgedIntoAFolderThatWasRemoved) {
  const auto recorder = Open();
  recorder->Record(Received(channel::kRunRecord, SampleRecord("a")));
  std::filesystem::rename(Folder(), temporary_ / "elsewhere");
  EXPECT_THROW(recorder->Record(Received(channel::kRunRecord, SampleRecord("b"))),
               std::runtime_error);
  EXPECT_THROW(recorder->Recover(), std::runtime_error);
  EXPECT_EQ(acks_.size(), 1);
  std::filesystem::rename(temporary_ / "elsewhere", Folder());
  recorder->Recover();
  recorder->Record(Received(channel::kRunRecord, SampleRecord("b")));
  EXPECT_EQ(acks_.size(), 2);
  EXPECT_EQ(Count("runs"), 2);
}

TEST_F(SessionRecorderTest, RefusesWhatItCannotDecode) {
  const auto recorder = Open();
  recorder->Record({channel::kRunRecord, {1, 2, 3}, 0});
  EXPECT_TRUE(acks_.empty());  // whose it was cannot be told
  RunRecordMessage record = SampleRecord();
  record.roundtrip_time_s = std::numeric_limits<double>::quiet_NaN();
  recorder->Record(Received(channel::kRunRecord, record));
  ASSERT_EQ(acks_.size(), 1);
  EXPECT_EQ(acks_[0].ack.id, "request-1");
  EXPECT_FALSE(acks_[0].ack.ok);
  EXPECT_NE(acks_[0].ack.message.find("roundtrip_time_s"), std::string::npos)
      << acks_[0].ack.message;
  recorder->Record({channel::kSession, {}, 0});
  EXPECT_EQ(acks_.size(), 1);
  SessionMessage session = SampleSession();
  session.conditions.contestants.emplace_back().planner = "nameless";
  recorder->Record(Received(channel::kSession, session));
  ASSERT_EQ(acks_.size(), 2);
  EXPECT_EQ(acks_[1].ack.id, session.run_id);
  EXPECT_FALSE(acks_[1].ack.ok);
  EXPECT_NE(acks_[1].ack.message.find("name: is empty"), std::string::npos) << acks_[1].ack.message;
  EXPECT_EQ(recorder->tally().failures, 4);
  EXPECT_EQ(Count("runs"), 0);
  EXPECT_EQ(Events().size(), 4);  // the event log has them all the same
  recorder->Record(Received(channel::kRunRecord, SampleRecord()));
  EXPECT_TRUE(acks_.back().ack.ok);
}

TEST_F(SessionRecorderTest, RunJsonDescribesTheSessions) {
  const auto recorder = Open();
  recorder->Record(Received(channel::kSession, SampleSession()));
  recorder->Record(Received(channel::kSession, FinishedSession()));
  SessionMessage second = SampleSession();
  second.run_id = "session-2";
  second.start_utime += 5;
  second.host = "caf\xe9";  // no UTF-8
  recorder->Record(Received(channel::kSession, second));
  const auto json = nlohmann::json::parse(TextOf(Folder() / "run.json"));
  ASSERT_EQ(json.at("sessions").size(), 2);
  const auto& session = json.at("sessions").at(0);
  EXPECT_EQ(session.at("run_id"), "session-1");
  EXPECT_EQ(session.at("start_time"), "2024-05-06T07:08:09.123456Z");
  EXPECT_EQ(session.at("finished"), true);
  EXPECT_EQ(session.at("total_time_s"), 321.5);
  EXPECT_EQ(session.at("num_runs"), 12);
  EXPECT_EQ(session.at("version"), "0.1.0");
  EXPECT_EQ(session.at("commit"), "abc123");
  EXPECT_EQ(session.at("host"), "bench-host");
  EXPECT_EQ(session.at("cpu"), "Fast CPU");
  EXPECT_EQ(session.at("seed"), 18'446'744'073'709'551'615u);
  EXPECT_EQ(session.at("time_limit_s"), 60.0);
  EXPECT_EQ(session.at("robot").at("name"), "fetch");
  EXPECT_EQ(session.at("flags").at("planners"), "ara,rrtc");
  EXPECT_TRUE(session.at("contestants").is_array());
  const auto& node = session.at("nodes").at(0);
  EXPECT_EQ(node.at("name"), "rrtc");
  EXPECT_EQ(node.at("kind"), "planner");
  EXPECT_EQ(node.at("algorithm"), "RRT-Connect");
  EXPECT_EQ(node.at("settings").at("range"), "2");
  EXPECT_EQ(json.at("sessions").at(1).at("run_id"), "session-2");
  EXPECT_EQ(json.at("sessions").at(1).at("finished"), false);
}

TEST_F(SessionRecorderTest, RunJsonIsWrittenBesideItsPlaceAndNoOtherFileIsTouched) {
  const auto recorder = Open();
  WriteText(Folder() / "run.json.part", "another's");
  recorder->Record(Received(channel::kSession, SampleSession()));
  recorder->Record(Received(channel::kSession, FinishedSession()));
  EXPECT_EQ(TextOf(Folder() / "run.json.part"), "another's");
  for (const auto& entry : std::filesystem::directory_iterator(Folder())) {
    if (entry.path().extension() != ".part") continue;
    EXPECT_EQ(entry.path().filename(), "run.json.part");
  }
}

TEST_F(SessionRecorderTest, RunJsonThatCannotBeWrittenIsAFailureAndNoBadUse) {
  const auto recorder = Open();
  std::filesystem::create_directory(Folder() / "run.json");
  try {
    recorder->Record(Received(channel::kSession, SampleSession()));
    ADD_FAILURE() << "nothing is thrown";
  } catch (const InputError& error) {
    ADD_FAILURE() << "the logger would not be started again: " << error.what();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("run.json: Is a directory"), std::string::npos)
        << error.what();
  }
  EXPECT_TRUE(acks_.empty());
  std::filesystem::remove(Folder() / "run.json");
  recorder->Record(Received(channel::kSession, SampleSession()));
  EXPECT_EQ(acks_.size(), 1);
}

TEST_F(SessionRecorderTest, ARunWhoseRecordIsReplacedIsCountedOnce) {
  const RunRecordMessage not_asked = UnansweredRecord("a");
  RunRecordMessage not_asked_again = not_asked;
  not_asked_again.start_utime += 1;
  const auto recorder = Open();
  for (const RunRecordMessage& record : {not_asked, not_asked_again, SampleRecord("a")}) {
    recorder->Record(Received(channel::kRunRecord, record));
  }
  EXPECT_EQ(recorder->tally().runs, 1);
  EXPECT_EQ(recorder->tally().replacements, 2);
  EXPECT_EQ(recorder->tally().repetitions, 0);
  recorder->Record(Received(channel::kRunRecord, SampleRecord("b")));
  EXPECT_EQ(recorder->tally().runs, 2);
}

TEST_F(SessionRecorderTest, ResumesWhereItWasLeft) {
  Open()->Record(Received(channel::kRunRecord, SampleRecord("a")));
  EXPECT_THROW(Open(), InputError);
  Open(true)->Record(Received(channel::kRunRecord, SampleRecord("b")));
  EXPECT_EQ(Count("runs"), 2);
  EXPECT_EQ(Count("experiments"), 1);
  EXPECT_EQ(Events().size(), 2);
}

TEST_F(SessionRecorderTest, AResumedDatabaseIsBroughtUpToDateWithTheLog) {
  {
    const auto recorder = Open();
    recorder->Record(Received(channel::kSession, SampleSession()));
    recorder->Record(Received(channel::kRunRecord, SampleRecord("a")));
    recorder->Record({channel::kRunRecord, {1, 2, 3}, 0});
    recorder->Record(Received(channel::kRunRecord, UnansweredRecord("b")));
  }
  const std::string before = DumpDatabase(Folder() / "results.sqlite");
  std::filesystem::remove(Folder() / "results.sqlite");
  std::filesystem::remove(Folder() / "run.json");
  acks_.clear();
  {
    const auto recorder = Open(true);
    EXPECT_EQ(recorder->tally().runs, 0);
    EXPECT_EQ(recorder->tally().failures, 0);
  }
  EXPECT_EQ(DumpDatabase(Folder() / "results.sqlite"), before);
  EXPECT_TRUE(std::filesystem::exists(Folder() / "run.json"));
  EXPECT_TRUE(acks_.empty());
  EXPECT_EQ(Events().size(), 4);
}

TEST_F(SessionRecorderTest, WhatWasLostOnTheBusIsThatOfAllParts) {
  const auto lost = [&] {
    return nlohmann::json::parse(TextOf(Folder() / "run.json")).at("bus").at("lost_messages");
  };
  Open()->Report(R"({"lost_messages": 3})");
  EXPECT_EQ(lost(), 3);
  Open(true)->Record(Received(channel::kSession, SampleSession()));
  EXPECT_EQ(lost(), 3);
  Open(true)->Report(R"({"lost_messages": 4})");
  EXPECT_EQ(lost(), 7);
}

TEST_F(SessionRecorderTest, WhatWasLostOnTheBusIsNotKnownOfAPartWhoseEndIsLacking) {
  const auto told = [&] { return ReadBusJson(Folder() / "run.json"); };
  {
    const auto recorder = Open();
    recorder->Record(Received(channel::kSession, SampleSession()));
    EXPECT_EQ(told(), kBusNotTold);
    recorder->Report();
    EXPECT_EQ(told(), "");
  }
  Open(true)->Record(Received(channel::kSession, SampleSession()));  // as if it were killed then
  EXPECT_EQ(told(), kBusNotTold);
  Open(true)->Report();
  EXPECT_EQ(told(), kBusNotTold);
  std::filesystem::remove(Folder() / "run.json");
  Open(true)->Report(R"({"lost_messages":4})");
  EXPECT_EQ(told(), R"({"logs_not_told_of":1,"lost_messages":4})");
}

TEST_F(SessionRecorderTest, AReplayBuildsAnEqualDatabase) {
  {
    const auto recorder = Open();
    recorder->Record(Received(channel::kSession, SampleSession()));
    recorder->Record(Received(channel::kRunRecord, SampleRecord("a")));
    recorder->Record(Received(channel::kRunRecord, SampleRecord("a")));
    recorder->Record(Received(channel::kRunRecord, UnansweredRecord("b")));
    recorder->Record(Received(channel::kSession, FinishedSession()));
  }
  {
    SessionRecorder replay(
        temporary_ / "replay", false, "other", [](const std::string&, const AckMessage&) {},
        &contradictions_);
    for (ReceivedMessage event : Events()) {
      event.utime += 1'000'000'000;  // received at another time
      replay.Record(event);
    }
  }
  EXPECT_EQ(DumpDatabase(Folder() / "results.sqlite"),
            DumpDatabase(temporary_ / "replay" / "results.sqlite"));
  EXPECT_EQ(TextOf(Folder() / "run.json"), TextOf(temporary_ / "replay" / "run.json"));
}

TEST_F(SessionRecorderTest, WhatWasAcknowledgedSurvivesAKill) {
  int acks[2];
  ASSERT_EQ(pipe(acks), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    SessionRecorder recorder(
        Folder(), false, "scribe",
        [&](const std::string&, const AckMessage& ack) {
          const char byte = ack.ok ? 'y' : 'n';
          if (write(acks[1], &byte, 1) != 1) _exit(1);
        },
        &contradictions_);
    for (int i = 0;; ++i) {
      recorder.Record(Received(channel::kRunRecord, SampleRecord(std::to_string(i))));
    }
  }
  close(acks[1]);
  constexpr int kNumAcks = 40;
  for (int i = 0; i < kNumAcks; ++i) {
    char byte = 0;
    ASSERT_EQ(read(acks[0], &byte, 1), 1);
    ASSERT_EQ(byte, 'y');
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  close(acks[0]);

  {
    SqliteConnection connection(Folder() / "results.sqlite",
                                SqliteConnection::Mode::kReadWriteCreate);
    EXPECT_EQ(connection.QueryValue("PRAGMA integrity_check"), SqliteValue("ok"));
    EXPECT_EQ(connection.QueryValue("SELECT count(*) FROM runs r WHERE (SELECT count(*) FROM "
                                    "paths p WHERE p.runid = r.id) <> 10"),
              SqliteValue(std::int64_t{0}));  // no half runs
  }
  const std::int64_t runs = Count("runs");
  EXPECT_GE(runs, kNumAcks);
  const auto logged = static_cast<std::int64_t>(Events().size());
  EXPECT_GE(logged, runs) << "the log is written first";
  Open(true)->Record(Received(channel::kRunRecord, SampleRecord("after")));
  EXPECT_EQ(Count("runs"), logged + 1);
  EXPECT_EQ(Events().back().bytes.size(), Encode(SampleRecord("after")).size());
}

TEST_F(SessionRecorderTest, AFullDiskIsAFailureAndNothingIsAcknowledged) {
  // A limit on the size of files stands for the full disk.
  const auto record_until_full = [&] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {600'000, 600'000};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(3);
    int recorded = 0;
    int acknowledged = 0;
    try {
      SessionRecorder recorder(
          Folder(), false, "scribe",
          [&](const std::string&, const AckMessage& ack) {
            if (ack.ok) ++acknowledged;
          },
          &contradictions_);
      for (; recorded < 10'000; ++recorded) {
        recorder.Record(Received(channel::kRunRecord, SampleRecord(std::to_string(recorded))));
      }
      _exit(4);
    } catch (const InputError&) {
      _exit(5);
    } catch (const std::runtime_error&) {
      _exit(recorded > 0 && acknowledged == recorded ? 0 : 6);
    }
  };
  EXPECT_EXIT(record_until_full(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace planbench
