#include "messaging/record_log.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "messaging/channels.h"
#include "messaging/codec.h"
#include "tests/messaging/allocation_meter.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

SessionMessage Session(const std::string& run_id) {
  SessionMessage session;
  session.run_id = run_id;
  return session;
}

RunRecordMessage Record(const std::string& request_id, double roundtrip_time_s = 1) {
  RunRecordMessage run;
  run.run_id = "run";
  run.request_id = request_id;
  run.planner = run.contestant = "arm";
  run.roundtrip_time_s = roundtrip_time_s;
  return run;
}

class RecordLogTest : public testing::Test {
 protected:
  void Add(const std::string& channel, std::vector<std::uint8_t> bytes) {
    lcm_eventlog_event_t event = {};
    event.timestamp = ++time_;
    event.channellen = static_cast<int>(channel.size());
    event.channel = const_cast<char*>(channel.c_str());
    event.datalen = static_cast<int>(bytes.size());
    event.data = bytes.data();
    ASSERT_EQ(lcm_eventlog_write_event(log_.get(), &event), 0);
  }
  RecordedSession Read() {
    log_.reset();
    return ReadRecords(file_);
  }

  TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "session.lcmlog";
  std::int64_t time_ = 0;
  std::unique_ptr<lcm_eventlog_t, void (*)(lcm_eventlog_t*)> log_{
      lcm_eventlog_create(file_.c_str(), "w"), lcm_eventlog_destroy};
};

TEST_F(RecordLogTest, ReadsSessionsAndRunsInOrder) {
  Add(channel::kSession, Encode(Session("run")));
  Add(channel::kRunRecord, Encode(Record("b")));
  Add("UNRELATED", {1, 2, 3});
  Add(channel::kRunRecord, Encode(Record("a")));
  Add(channel::kSession, Encode(Session("later run")));
  const RecordedSession recorded = Read();
  ASSERT_EQ(recorded.sessions.size(), 2u);
  EXPECT_EQ(recorded.sessions[0].run_id, "run");
  EXPECT_EQ(recorded.sessions[1].run_id, "later run");
  EXPECT_EQ(LastTold(recorded, "run"), recorded.sessions[0]);
  EXPECT_EQ(LastTold(recorded, "another"), SessionMessage());
  ASSERT_EQ(recorded.runs.size(), 2u);
  EXPECT_EQ(recorded.runs[0].request_id, "b");
  EXPECT_EQ(recorded.runs[1].request_id, "a");
}

TEST_F(RecordLogTest, RepeatedRecordsCountOnce) {
  Add(channel::kRunRecord, Encode(Record("a", 1)));
  Add(channel::kRunRecord, Encode(Record("a", 2)));
  const RecordedSession recorded = Read();
  ASSERT_EQ(recorded.runs.size(), 1u);
  EXPECT_EQ(ReadRecord(recorded.runs[0].place).roundtrip_time_s, 1);
}

TEST_F(RecordLogTest, ARunThatWasNotAskedGivesWayToOneThatWas) {
  const RunRecordMessage not_asked = Record("a", 0);
  RunRecordMessage not_asked_again = not_asked;
  not_asked_again.start_utime += 1;
  not_asked_again.message = "given up again";
  Add(channel::kRunRecord, Encode(not_asked));
  Add(channel::kRunRecord, Encode(Record("b", 1)));
  Add(channel::kRunRecord, Encode(not_asked_again));
  Add(channel::kRunRecord, Encode(not_asked));
  EXPECT_EQ(ReadRecord(Read().runs.front().place), not_asked_again);
  log_.reset(lcm_eventlog_create(file_.c_str(), "a"));
  Add(channel::kRunRecord, Encode(Record("a", 2)));
  Add(channel::kRunRecord, Encode(not_asked_again));
  Add(channel::kRunRecord, Encode(Record("a", 3)));
  const RecordedSession recorded = Read();
  ASSERT_EQ(recorded.runs.size(), 2u);
  EXPECT_EQ(ReadRecord(recorded.runs[0].place), Record("a", 2));
  EXPECT_EQ(ReadRecord(recorded.runs[1].place), Record("b", 1));
}

TEST_F(RecordLogTest, ADisturbedRunGivesWayToItsLastRepeatWhateverTheOrder) {
  std::vector<RunRecordMessage> attempts(3, Record("a"));
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    attempts[i].result.result.counters = {{"disturbed", 1}, {"repeats", static_cast<double>(i)}};
  }
  for (const std::size_t i : {1u, 0u, 2u, 1u}) {
    Add(channel::kRunRecord, Encode(attempts[i]));
  }
  const RecordedSession recorded = Read();
  ASSERT_EQ(recorded.runs.size(), 1u);
  EXPECT_EQ(ReadRecord(recorded.runs[0].place), attempts[2]);
}

TEST_F(RecordLogTest, RecordsStayInTheLogAndAreReadOneByOne) {
  constexpr std::size_t kRuns = 40;
  std::vector<RunRecordMessage> records(kRuns);
  for (std::size_t i = 0; i < kRuns; ++i) {
    records[i] = Record(fmt::format("{}", i));
    records[i].result.joint_names = {"j"};
    records[i].result.result.path = Path(2000, Configuration(1, 0.5));
    Add(channel::kRunRecord, Encode(records[i]));
  }
  log_.reset();
  const AllocationMeter of_all;
  const RecordedSession recorded = ReadRecords(file_);
  const std::size_t peak_of_all = of_all.Peak();
  ASSERT_EQ(recorded.runs.size(), kRuns);
  for (std::size_t i = 0; i < kRuns; ++i) {
    const AllocationMeter of_one;
    EXPECT_EQ(ReadRecord(recorded.runs[i].place), records[i]);
    EXPECT_LT(peak_of_all, 2 * of_one.Peak());
  }
}

TEST_F(RecordLogTest, ALogThatIsNotWhatItWasIsNamed) {
  Add(channel::kRunRecord, Encode(Record("a")));
  const RecordedSession recorded = Read();
  const EventPlace& place = recorded.runs.at(0).place;
  std::fstream(file_, std::ios::binary | std::ios::in | std::ios::out)
      .seekp(static_cast<std::streamoff>(place.offset))
      .write("another", 8);
  ExpectInputError([&] { ReadRecord(place); },
                   {file_.string(), "was changed", channel::kRunRecord});
  std::filesystem::resize_file(file_, place.offset);
  ExpectInputError([&] { ReadRecord(place); }, {file_.string(), "was shortened"});
}

TEST_F(RecordLogTest, TornLastEventIsNoError) {
  Add(channel::kRunRecord, Encode(Record("a")));
  Add(channel::kRunRecord, Encode(Record("b")));
  log_.reset();
  const auto size = std::filesystem::file_size(file_);
  EXPECT_TRUE(ReadRecords(file_).passed_over.empty());
  const auto whole = size / 2;  // of two like events
  for (const std::uintmax_t torn : {whole - 1, whole - 20, whole - 100, 3ul, 1ul}) {
    std::filesystem::resize_file(file_, whole + torn);
    const RecordedSession recorded = ReadRecords(file_);
    ASSERT_EQ(recorded.runs.size(), 1u) << torn;
    EXPECT_EQ(recorded.runs[0].request_id, "a");
    ASSERT_EQ(recorded.passed_over.size(), 1u) << torn;
    EXPECT_TRUE(recorded.passed_over[0].starts_with(
        fmt::format("{}: {} bytes after the last whole event are not read", file_.string(), torn)))
        << recorded.passed_over[0];
  }
}

TEST_F(RecordLogTest, WhatIsDamagedIsPassedOverAndToldOnce) {
  Add(channel::kSession, Encode(Session("run")));
  std::fflush(log_->f);
  const auto offset = std::filesystem::file_size(file_);
  Add(channel::kRunRecord, Encode(Record("a")));
  Add(channel::kRunRecord, Encode(Record("b")));
  log_.reset();
  std::fstream(file_, std::ios::binary | std::ios::in | std::ios::out)
      .seekp(static_cast<std::streamoff>(offset))
      .put(0);
  const RecordedSession recorded = ReadRecords(file_);
  ASSERT_EQ(recorded.sessions.size(), 1u);
  ASSERT_EQ(recorded.runs.size(), 1u);
  EXPECT_EQ(recorded.runs[0].request_id, "b");
  ASSERT_EQ(recorded.passed_over.size(), 1u);
  EXPECT_NE(recorded.passed_over[0].find(fmt::format("from byte {} on", offset)), std::string::npos)
      << recorded.passed_over[0];
}

TEST_F(RecordLogTest, EmptyLogHoldsNothing) {
  const RecordedSession recorded = Read();
  EXPECT_TRUE(recorded.sessions.empty());
  EXPECT_TRUE(recorded.runs.empty());
}

TEST_F(RecordLogTest, RecordOfAnotherVersionNamesFileAndChannel) {
  std::vector<std::uint8_t> bytes = Encode(Record("a"));
  bytes[0] = static_cast<std::uint8_t>(bytes[0] + 1);  // the type's fingerprint
  Add(channel::kRunRecord, bytes);
  ExpectInputError([&] { Read(); }, {file_.string(), channel::kRunRecord});
}

TEST_F(RecordLogTest, WhatCannotBeDecodedBesideWhatCanIsPassedOverAndCounted) {
  // As a driver wrote it whose clock was set back.
  SessionMessage negative = Session("run");
  negative.total_time_s = -1;
  Add(channel::kSession, Encode(Session("run")));
  Add(channel::kRunRecord, Encode(Record("a")));
  Add(channel::kSession, Encode(negative));
  Add(channel::kSession, {1, 2, 3});
  Add(channel::kRunRecord, {});
  const RecordedSession recorded = Read();
  EXPECT_EQ(recorded.sessions.size(), 1u);
  EXPECT_EQ(recorded.runs.size(), 1u);
  ASSERT_EQ(recorded.passed_over.size(), 2u);
  EXPECT_EQ(recorded.passed_over[0],
            file_.string() +
                ": 2 messages are passed over, the first: SESSION: total_time_s: -1 is negative");
  EXPECT_TRUE(recorded.passed_over[1].starts_with(file_.string() + ": one message is passed over"));
}

TEST_F(RecordLogTest, ReadsScenesByTheirContent) {
  SceneMessage message;
  message.request_id = "a";
  message.scene.world_frame = "base";
  message.scene.objects.push_back({"ball", Eigen::Isometry3d::Identity(), {{Sphere{0.5}}}});
  message.scene_id = SceneId(message.scene);
  Add(channel::kScene, Encode(message));
  Add(channel::kScene, Encode(message));
  SceneMessage refused;
  refused.request_id = "b";
  refused.ok = false;
  refused.scene_id = "unknown";
  refused.message = "no such scene";
  Add(channel::kScene, Encode(refused));
  Add(channel::kScene, {1, 2, 3});
  Add(channel::kScene, {});
  log_.reset();
  std::vector<std::string> passed_over;
  const std::map<std::string, Scene> scenes = ReadScenes(file_, &passed_over);
  ASSERT_EQ(scenes.size(), 1u);
  EXPECT_EQ(scenes.at(message.scene_id).objects.at(0).id, "ball");
  ASSERT_EQ(passed_over.size(), 1u);
  EXPECT_TRUE(passed_over[0].starts_with(file_.string() + ": 2 messages are passed over"));
}

TEST_F(RecordLogTest, ScenesNoneOfWhichCanBeDecodedAreRefused) {
  Add(channel::kScene, {1, 2, 3});
  log_.reset();
  std::vector<std::string> passed_over;
  ExpectInputError([&] { ReadScenes(file_, &passed_over); }, {file_.string(), channel::kScene});
}

TEST_F(RecordLogTest, ASessionFolderHasOneLog) {
  log_.reset();
  EXPECT_EQ(FindEventLog(folder_.path()), file_);
  folder_.Write("other.lcmlog", "");
  ExpectInputError([&] { FindEventLog(folder_.path()); }, {"several .lcmlog files"});
}

TEST_F(RecordLogTest, MissingFileIsNamed) {
  const std::string missing = (folder_.path() / "missing.lcmlog").string();
  ExpectInputError([&] { ReadRecords(missing); }, {missing});
}

}  // namespace
}  // namespace planbench
