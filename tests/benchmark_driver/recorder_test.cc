#include "benchmark_driver/recorder.h"

#include <gtest/gtest.h>

#include "tests/benchmark_driver/fake_nodes.h"

namespace planbench {
namespace {

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
  Recorder recorder_{&bus_, &registry_};
};

TEST_F(RecorderTest, RecordsRunsAndSessions) {
  FakeLogger logger(&bus_);
  AwaitLogger();
  recorder_.Record(Session());
  recorder_.Record(RunOf("a"));
  EXPECT_EQ(recorder_.num_unrecorded(), 0);
  EXPECT_GE(logger.sessions().messages().size(), 1u);
  EXPECT_GE(logger.records().messages().size(), 1u);
}

TEST_F(RecorderTest, RepeatsUntilAcknowledged) {
  FakeLogger logger(&bus_);
  logger.num_to_ignore = 2;
  AwaitLogger();
  recorder_.Record(RunOf("a"));
  EXPECT_EQ(recorder_.num_unrecorded(), 0);
  EXPECT_GE(logger.records().messages().size(), 3u);
}

TEST_F(RecorderTest, RefusalCountsAsNotRecorded) {
  FakeLogger logger(&bus_);
  logger.refuse = true;
  AwaitLogger();
  recorder_.Record(RunOf("a"));
  EXPECT_EQ(recorder_.num_unrecorded(), 1);
  logger.refuse = false;
  recorder_.Record(RunOf("b"));
  EXPECT_EQ(recorder_.num_unrecorded(), 1);
}

TEST_F(RecorderTest, WithoutLoggerIsPublishedAndCounted) {
  MessageCollector<RunRecordMessage> watched(&bus_, channel::kRunRecord);
  recorder_.Record(RunOf("a"));
  recorder_.Record(RunOf("b"));
  EXPECT_EQ(recorder_.num_unrecorded(), 2);
  EXPECT_EQ(watched.WaitFor(2).size(), 2u);
}

TEST_F(RecorderTest, AcknowledgementOfAnotherRecordIsNone) {
  FakeLogger logger(&bus_);
  logger.num_to_ignore = 1;
  AwaitLogger();
  bus_.Publish(channel::kRunRecordAck, AckMessage{"another", "logger", true, ""});
  recorder_.Record(RunOf("a"));
  EXPECT_GE(logger.records().messages().size(), 2u);
}

}  // namespace
}  // namespace planbench
