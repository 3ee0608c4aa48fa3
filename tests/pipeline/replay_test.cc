#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "messaging/bus.h"
#include "messaging/channels.h"
#include "messaging/event_log.h"
#include "messaging/event_log_files.h"
#include "messaging/event_log_reader.h"
#include "tests/pipeline/pipeline_fixture.h"
#include "tests/support/message_collector.h"
#include "tests/support/private_bus.h"

namespace planbench {
namespace {

class Replay : public PipelineTest {};

TEST_F(Replay, OfAPlainLcmLogGivesTheSameRunsAndPaths) {
  const auto live = folder() / "live";
  const auto replayed = folder() / "replayed";
  const auto log = folder() / "plain.lcmlog";
  const auto first_file = log.string() + ".00";

  ChildProcess* recorder =
      Start({"lcm-logger", "--quiet", "-i", "--split-mb=0.02", "--lcm-url", url(), log.string()});
  ChildProcess* logger = StartLogger(live);
  ChildProcess* server = StartSceneServer();
  ChildProcess* ara = StartPlanner("ara");
  ChildProcess* rrtc = StartPlanner("rrtc");
  ASSERT_TRUE(WaitUntil([&] { return std::filesystem::exists(first_file); }));
  ChildProcess* driver =
      StartDriver({"--problems-range", "2-3", "--time", "20", "--directions", "both"});
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  for (ChildProcess* process : {server, ara, rrtc, logger}) ExpectEndsCleanly(process);
  recorder->Signal(SIGTERM);
  ASSERT_TRUE(recorder->Wait().has_value());

  // Its files, one after the other, are one log.
  EXPECT_GT(EventLogFiles(first_file).size(), 1);
  for (const auto& file : EventLogFiles(first_file)) {
    std::ofstream(log, std::ios::app) << std::ifstream(file).rdbuf();
  }
  ChildProcess* rebuilder = Start({Program("logger"), "--from", first_file, "--out",
                                   (folder() / "rebuilt").string(), "--split-mb", "0"});
  ASSERT_EQ(rebuilder->Wait(), 0) << rebuilder->Errors();
  EXPECT_EQ(Query(folder() / "rebuilt", "SELECT count(*) FROM runs"), 8);

  const std::string replay_url = PrivateUdpUrl();
  ChildProcess* second_logger =
      Start({Program("logger"), "--out", replayed.string(), "--lcm-url", replay_url});
  ASSERT_TRUE(WaitUntil([&] { return Query(replayed, "SELECT count(*) FROM runs") == 0; }))
      << second_logger->Errors();
  ChildProcess* player =
      Start({"lcm-logplayer", "--lcm-url=" + replay_url, "--speed=20", log.string()});
  ASSERT_EQ(player->Wait(), 0) << player->Errors();
  ASSERT_TRUE(WaitUntil([&] { return Query(replayed, "SELECT count(*) FROM runs") == 8; }))
      << second_logger->Errors();
  ExpectEndsCleanly(second_logger);

  const auto expect_same = [&](const std::string& sql, int columns) {
    const auto rows = Rows(live, sql, columns);
    EXPECT_FALSE(rows.empty()) << sql;
    EXPECT_EQ(rows, Rows(replayed, sql, columns)) << sql;
  };
  expect_same(
      "SELECT request_id, run_id, problem_set, problem_index, direction, seed, status, solved, "
      "time, "
      "roundtrip_time, path_length, path_length_simplified, clearance, referee_valid, memory, "
      "message "
      "FROM runs ORDER BY id",
      16);
  expect_same(
      "SELECT runs.request_id, kind, waypoint, joint, position FROM paths JOIN runs ON runs.id = "
      "runid "
      "ORDER BY 1, 2, 3, 4",
      5);
  expect_same(
      "SELECT name, timelimit, runcount, hostname, date, setup FROM experiments ORDER BY id", 6);
  expect_same("SELECT name, settings FROM plannerConfigs ORDER BY id", 2);
}

TEST_F(Replay, PlannersAnswerAsTheyDidOrItIsSaid) {
  const auto session = folder() / "session";
  ChildProcess* driver =
      StartLaunchedDriver(session, {"--problems-range", "2-3", "--time", "20", "--planners", "rrtc",
                                    "--collision-model", "voxels"});
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  const std::string log = (session / "session.lcmlog").string();
  const auto launched = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        Program("benchmark_driver"), "--launch", "--robot", RobotFolder(), "--replay", log, "--out",
        (folder() / out).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Start(arguments);
  };

  {
    Bus bus(url());
    MessageCollector<NodeStatusMessage> statuses(&bus, channel::kNodeStatus);
    bus.Start();
    ChildProcess* same = launched("same", {"--lcm-url", url()});
    EXPECT_EQ(same->Wait(), 0) << same->Output() << same->Errors();
    EXPECT_NE(same->Output().find("Answers now and as recorded"), std::string::npos)
        << same->Output();
    // What the log asks for is prepared, and nothing else.
    const std::vector<std::string> asked_for = {"voxels"};
    EXPECT_GE(statuses.Count([&](const auto& s) { return s.collision_models == asked_for; }), 1u);
    EXPECT_EQ(statuses.Count([](const auto& s) { return s.collision_models.size() > 1; }), 0u);
  }

  ChildProcess* of_folder =
      Start({Program("benchmark_driver"), "--launch", "--robot", RobotFolder(), "--replay",
             session.string(), "--out", (folder() / "of_folder").string()});
  EXPECT_EQ(of_folder->Wait(), 0) << of_folder->Output() << of_folder->Errors();
  ExpectBadInput(StartDriver({"--replay", (folder() / "same").string()}), "holds no .lcmlog file");

  ChildProcess* other = launched("other", {"--set", "rrtc.range=0.3"});
  EXPECT_EQ(other->Wait(), 1) << other->Output() << other->Errors();
  EXPECT_NE(other->Output().find("shelf_demo/2/rrtc/forward/1: path"), std::string::npos)
      << other->Output();
  EXPECT_NE(other->Errors().find("setting range was"), std::string::npos) << other->Errors();

  const std::string split = (folder() / "split.lcmlog").string();
  {
    EventLog files(split, EventLog::Mode::kNew, 1000);
    ReadEventLog(log, [&](const ReceivedMessage& message) { files.Write(message); });
    EXPECT_GT(files.num_files(), 2);
  }
  ChildProcess* rrtc = StartPlanner("rrtc");  // no scene server: the scenes are in the log
  ChildProcess* live = StartDriver({"--replay", split});
  EXPECT_EQ(live->Wait(), 0) << live->Output() << live->Errors();
  ExpectEndsCleanly(rrtc);

  ExpectBadInput(StartDriver({"--replay", log, "--planners", "ara"}), "'ara'");
}

}  // namespace
}  // namespace planbench
