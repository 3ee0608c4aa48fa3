#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/event_log_reader.h"
#include "messaging/node_registry.h"
#include "messaging/record_log.h"
#include "tests/pipeline/pipeline_fixture.h"
#include "tests/support/message_collector.h"

namespace planbench {
namespace {

class LaunchedSession : public PipelineTest {
 protected:
  static std::vector<std::string> Resuming(const std::filesystem::path& session,
                                           const std::vector<std::string>& flags) {
    std::vector<std::string> command = {Program("benchmark_driver"),
                                        "--launch",
                                        "--robot",
                                        RobotFolder(),
                                        "--problems",
                                        ProblemFolder(),
                                        "--resume",
                                        session.string()};
    command.insert(command.end(), flags.begin(), flags.end());
    return command;
  }
  /// Of a program that runs, -1 if none does.
  int PidOf(const std::string& program) const {
    for (const int pid : LeftRunning()) {
      std::ifstream file("/proc/" + std::to_string(pid) + "/cmdline");
      const std::string command{std::istreambuf_iterator<char>(file), {}};
      if (command.rfind(Program(program), 0) == 0) return pid;
    }
    return -1;
  }
  /// With which every run of RRT-Connect lasts to its time limit: steps so tiny.
  static std::vector<std::string> Endless(std::vector<std::string> flags) {
    flags.insert(flags.end(), {"--planners", "rrtc", "--set", "rrtc.range=0.00001", "--set",
                               "rrtc.extension=step", "--directions", "forward"});
    return flags;
  }
};

TEST_F(LaunchedSession, SolvesRecordsAndTabulates) {
  const auto session = folder() / "session";
  ChildProcess* driver = StartLaunchedDriver(
      session, {"--problems-range", "1-3", "--time", "30", "--seed", "7", "--directions", "both"});
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_TRUE(LeftRunning().empty());

  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs"), 3 * 2 * 2);
  // Of each problem and direction, the same for both planners.
  EXPECT_EQ(Query(session, "SELECT count(DISTINCT seed) FROM runs"), 3 * 2);
  // RRT-Connect solves these; ARA* at least from one side.
  EXPECT_EQ(Query(session,
                  "SELECT count(DISTINCT problem_index) FROM runs JOIN plannerConfigs p ON "
                  "p.id = plannerid WHERE solved AND p.name = 'RRT-Connect (balanced)'"),
            3);
  EXPECT_EQ(Query(session,
                  "SELECT count(DISTINCT problem_index) FROM runs JOIN plannerConfigs p ON "
                  "p.id = plannerid WHERE solved AND p.name LIKE 'ARA*%'"),
            3);
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE solved AND referee_valid IS NOT 1"), 0);
  EXPECT_EQ(Query(session,
                  "SELECT count(*) FROM runs WHERE solved AND id NOT IN "
                  "(SELECT runid FROM paths WHERE kind = 'raw')"),
            0);
  // Nothing was lost on the way: each path stands with as many positions as it has.
  EXPECT_EQ(
      Query(session,
            "SELECT count(*) FROM runs WHERE num_waypoints * 8 != (SELECT count(*) FROM paths "
            "WHERE runid = runs.id AND kind = 'raw')"),
      0);

  const std::string output = driver->Output();
  EXPECT_NE(output.find("Planning time, ms"), std::string::npos) << output;
  EXPECT_NE(output.find("shelf_demo"), std::string::npos) << output;
  std::ifstream tables_file(session / "tables.txt");
  const std::string tables{std::istreambuf_iterator<char>(tables_file), {}};
  const std::string common = tables.substr(0, tables.find("Planning time of confirmed attempts"));
  EXPECT_NE(common.find("Success"), std::string::npos) << tables;
  EXPECT_NE(output.find(common), std::string::npos) << output;

  const auto run_json = nlohmann::json::parse(std::ifstream(session / "run.json"));
  EXPECT_NE(run_json.dump().find("\"seed\""), std::string::npos) << run_json.dump(1);
  EXPECT_EQ(ReadRecords(session / "session.lcmlog").runs.size(), 12U);
  EXPECT_TRUE(std::filesystem::exists(session / "lcmtypes" / "lcmt_run_record.lcm"));
}

TEST_F(LaunchedSession, ALineUpsContestantsRunUnderTheirOwnConditions) {
  const auto session = folder() / "session";
  const auto line_up = folder() / "lineup.yaml";
  std::ofstream(line_up) << R"(contestants:
  coarse: {name: RRT-Connect (coarse), program: rrtc, edge_check: fixed, edge_resolution: 0.05}
  swept: {program: rrtc, sweep: {range: [0.5, 2]}, collision_model: voxels, edge_check: fixed}
)";
  ChildProcess* driver = StartLaunchedDriver(
      session, {"--lineup", line_up.string(), "--problems-range", "1", "--time", "30"});
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs"), 3);
  EXPECT_EQ(Query(session,
                  "SELECT count(*) FROM runs JOIN plannerConfigs p ON p.id = plannerid WHERE "
                  "p.name = 'RRT-Connect (coarse)' AND edge_resolution = 0.05 AND edge_check = "
                  "'fixed' AND collision_model = 'spheres'"),
            1);
  EXPECT_EQ(Query(session,
                  "SELECT count(*) FROM runs JOIN plannerConfigs p ON p.id = plannerid WHERE "
                  "p.settings LIKE '%program = planner_rrtc%range = 2%' AND "
                  "collision_model = 'voxels'"),
            1);
  const std::string output = driver->Output();
  EXPECT_NE(output.find("RRT-Connect (balanced) [swept_range_0_5]"), std::string::npos) << output;

  // Its planner has prepared the model of each, and no other.
  int num_planners = 0;
  const auto records = ReadRecords(session / "session.lcmlog");
  for (const auto& node : records.sessions.back().nodes) {
    if (node.kind != NodeKind::kPlanner) continue;
    ++num_planners;
    const std::string model = node.name == "coarse" ? "spheres" : "voxels";
    EXPECT_EQ(node.collision_models, std::vector<std::string>{model}) << node.name;
  }
  EXPECT_EQ(num_planners, 3);
}

TEST_F(LaunchedSession, PlannersWorkAtOnceWithParallel) {
  const auto session = folder() / "session";
  ChildProcess* driver = StartLaunchedDriver(session, {"--problems-range", "1,4", "--time", "30",
                                                       "--parallel", "--directions", "backward"});
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs"), 4);
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE solved"), 4);
}

TEST_F(LaunchedSession, PlannersThatFindFirstPathsDoNotWorkAtOnce) {
  const auto line_up = folder() / "lineup.yaml";
  std::ofstream(line_up) << "contestants: {chomp: {program: trajopt, first_path_of: rrtc}, rrtc: "
                            "{}}";
  ExpectBadInput(StartLaunchedDriver(folder() / "session",
                                     {"--lineup", line_up.string(), "--parallel", "--time", "30"}),
                 "--parallel: 'rrtc' cannot search for 'chomp'");
  EXPECT_FALSE(std::filesystem::exists(folder() / "session")) << "before anything is started";
}

TEST_F(LaunchedSession, InterruptedLeavesNothingRunningAndResumes) {
  const auto session = folder() / "session";
  const std::vector<std::string> flags = {"--problems-range", "1-2", "--time",     "30",
                                          "--trials",         "12",  "--planners", "rrtc"};
  ChildProcess* driver = StartLaunchedDriver(session, flags);
  ASSERT_TRUE(WaitUntil([&] { return Query(session, "SELECT count(*) FROM runs") >= 3; }))
      << driver->Errors();
  driver->Signal(SIGINT);
  // With much luck it was through before the signal came.
  const auto code = driver->Wait();
  ASSERT_TRUE(code == 1 || code == 0) << driver->Errors();
  EXPECT_TRUE(WaitUntil([this] { return LeftRunning().empty(); }));
  const long long before = Query(session, "SELECT count(*) FROM runs");
  EXPECT_GE(before, 3);
  EXPECT_EQ(driver->Output().find("Go on with: benchmark_driver ") != std::string::npos, code == 1)
      << driver->Output();
  std::filesystem::remove_all(session / "logs");  // as in merged sessions

  std::vector<std::string> resume = Resuming(session, flags);
  ChildProcess* resumed = Start(resume);
  ASSERT_EQ(resumed->Wait(), 0) << resumed->Errors();
  EXPECT_TRUE(std::filesystem::exists(session / "logs" / "logger.log"));
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs"), 24);
  EXPECT_EQ(Query(session, "SELECT count(DISTINCT request_id) FROM runs"), 24);
  EXPECT_EQ(Query(session, "SELECT count(DISTINCT run_id) FROM runs"), 1);
  EXPECT_EQ(ReadRecords(session / "session.lcmlog").runs.size(), 24U);

  std::vector<std::string> otherwise = resume;
  otherwise.insert(otherwise.end(), {"--set", "rrtc.range=3"});
  ExpectBadInput(Start(otherwise), "--resume: node[rrtc].setting[range]");
  const auto other_robot = folder() / "other_fetch";
  std::filesystem::copy(RobotFolder(), other_robot);
  std::ofstream(other_robot / "spheres.yaml", std::ios::app) << "\n# not the same description\n";
  std::replace(resume.begin(), resume.end(), RobotFolder(), other_robot.string());
  ExpectBadInput(Start(resume), "--resume: conditions.request.robot_id");
}

TEST_F(LaunchedSession, AClockThatIsSetBackCostsNothing) {
  const auto session = folder() / "session";
  const bool is_sanitized = !std::string(PLANBENCH_SANITIZED).empty();
  ChildProcess* driver = StartLaunchedDriver(
      session, {"--problems-range", "1", "--planners", "rrtc", "--time", "30"},
      {"env", std::string("LD_PRELOAD=") + (is_sanitized ? "" : PLANBENCH_ANOTHER_TIME),
       "PLANBENCH_SET_BACK_BY=" + (session / "run.json").string()});
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_EQ(Query(session, "SELECT count(*) FROM sessions WHERE finished AND total_time > 0"), 1);
  const RecordedSession recorded = ReadRecords(session / "session.lcmlog");
  EXPECT_TRUE(recorded.passed_over.empty());
  EXPECT_TRUE(recorded.sessions.back().finished);
}

TEST_F(LaunchedSession, PlannerThatDiesIsRestartedAndTheRunIsNoAnswer) {
  const auto session = folder() / "session";
  ChildProcess* driver = StartLaunchedDriver(
      session, Endless({"--problems-range", "1-2", "--time", "2", "--trials", "2"}));
  ASSERT_TRUE(WaitUntil([&] { return Query(session, "SELECT count(*) FROM runs") >= 1; }))
      << driver->Errors();
  const int victim = PidOf("planner_rrtc");
  ASSERT_GT(victim, 0);
  kill(victim, SIGKILL);
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs"), 4);
  EXPECT_EQ(Query(session,
                  "SELECT count(*) FROM runs WHERE status = 7 AND "
                  "message = 'the process ended by signal 9 (Killed)'"),
            1)
      << driver->Errors();
}

TEST_F(LaunchedSession, RunsThatAreNotMadeAreAFailure) {
  const auto session = folder() / "session";
  const auto begun = folder() / "begun";
  // Whenever it is started it has other settings than before, so that it is not asked again.
  const std::string command = fmt::format(
      "mine=echo >> {0}; exec {1} --robot {2} --name mine --set range=0.0000$(wc -l < {0}) "
      "--set extension=step",
      begun.string(), Program("planner_rrtc"), RobotFolder());
  ChildProcess* driver = StartLaunchedDriver(
      session, {"--problems-range", "1", "--time", "2", "--trials", "30", "--directions", "forward",
                "--planners", "mine", "--planner-command", command});
  ASSERT_TRUE(WaitUntil([&] { return Query(session, "SELECT count(*) FROM runs") >= 1; }))
      << driver->Errors();
  const int victim = PidOf("planner_rrtc");
  ASSERT_GT(victim, 0);
  kill(victim, SIGKILL);
  EXPECT_EQ(driver->Wait(), 1) << driver->Errors();
  EXPECT_EQ(Query(session, "SELECT count(*) FROM sessions WHERE finished"), 0);
  EXPECT_THAT(driver->Errors(), testing::HasSubstr(" could not be asked for or judged: "));
}

TEST_F(LaunchedSession, NobodyIsToldToResumeForAPathThatTheStepIsTooFineFor) {
  const auto session = folder() / "session";
  ChildProcess* driver =
      StartLaunchedDriver(session, {"--problems-range", "1", "--time", "30", "--planners", "rrtc",
                                    "--directions", "forward", "--referee-step", "1e-6"});
  EXPECT_EQ(driver->Wait(), 1) << driver->Errors();
  EXPECT_THAT(driver->Errors(),
              testing::HasSubstr("1 run could not be asked for or judged: a new session with a "
                                 "larger --referee-step makes it"));
  EXPECT_THAT(driver->Output(), testing::Not(testing::HasSubstr("Go on with")));
}

// As Slurm, systemd and others end a job.
TEST_F(LaunchedSession, ARunWhosePlannerIsToldToEndBeforeTheDriverIsNotRecorded) {
  const auto session = folder() / "session";
  const std::vector<std::string> flags =
      Endless({"--problems-range", "1", "--time", "2", "--trials", "5"});
  ChildProcess* driver = StartLaunchedDriver(session, flags);
  ASSERT_TRUE(WaitUntil([&] { return Query(session, "SELECT count(*) FROM runs") >= 1; }))
      << driver->Errors();
  for (const int pid : LeftRunning()) {
    if (pid != driver->pid()) kill(pid, SIGTERM);
  }
  driver->Signal(SIGTERM);
  EXPECT_EQ(driver->Wait(), 1) << driver->Errors();
  const std::string not_timed_out = "SELECT count(*) FROM runs WHERE status != 1";
  EXPECT_EQ(Query(session, not_timed_out), 0) << driver->Errors();

  ChildProcess* resumed = Start(Resuming(session, flags));
  EXPECT_EQ(resumed->Wait(), 0) << resumed->Errors();
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs"), 5);
  EXPECT_EQ(Query(session, not_timed_out), 0);
}

TEST_F(LaunchedSession, PlannersAreStartedAnewAfterSoManyProblems) {
  const auto session = folder() / "session";
  const auto line_up = folder() / "lineup.yaml";
  std::ofstream(line_up)
      << "contestants: {a: {name: A, program: rrtc}, b: {name: B, program: rrtc}}";
  std::vector<std::string> flags = {
      "--lineup", line_up.string(), "--problems-range", "1-4", "--trials", "2", "--time", "30"};
  std::vector<std::string> anew = flags;
  anew.insert(anew.end(), {"--problems-per-process", "2"});
  ChildProcess* driver = StartLaunchedDriver(session, anew);
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_TRUE(LeftRunning().empty());
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE solved"), 4 * 2 * 2);
  EXPECT_THAT(driver->Output(), testing::HasSubstr("(--problems-per-process 2)"));
  for (const char* trouble : {"starting it again", "warm-up"}) {
    EXPECT_THAT(driver->Errors(), testing::Not(testing::HasSubstr(trouble)));
  }
  const auto run_json = nlohmann::json::parse(std::ifstream(session / "run.json"));
  EXPECT_NE(run_json.dump().find("\"problems-per-process\":\"2\""), std::string::npos);

  // Each has answered a request before it made a run.
  std::map<std::string, std::set<std::string>> processes, warm_ups;
  ReadEventLog(session / "session.lcmlog", [&](const ReceivedMessage& message) {
    if (message.channel == channel::kNodeStatus) {
      const auto status = Decode<NodeStatusMessage>(message.bytes, message.channel);
      processes[status.name].insert(status.instance);
    }
    for (const char* name : {"a", "b"}) {
      if (message.channel != PlannerChannels(name).request) continue;
      const auto request = Decode<PlanRequest>(message.bytes, message.channel);
      if (request.request_id.ends_with("/warm-up")) warm_ups[name].insert(request.request_id);
    }
  });
  for (const char* name : {"a", "b"}) {
    EXPECT_EQ(processes[name].size(), 2u);
    EXPECT_EQ(warm_ups[name].size(), 2u);
  }
  EXPECT_EQ(processes["scene_server"].size(), 1u);

  ExpectBadInput(Start(Resuming(session, flags)), "setting[problems-per-process]");
  {
    Bus bus(url());
    MessageCollector<NodeStatusMessage> statuses(&bus, channel::kNodeStatus);
    bus.Start();
    ChildProcess* replay =
        Start({Program("benchmark_driver"), "--launch", "--robot", RobotFolder(), "--lineup",
               line_up.string(), "--replay", (session / "session.lcmlog").string(), "--out",
               (folder() / "replay").string(), "--lcm-url", url()});
    EXPECT_EQ(replay->Wait(), 0) << replay->Output() << replay->Errors();
    std::set<std::string> instances;
    for (const NodeStatusMessage& status : statuses.messages()) {
      if (status.kind == NodeKind::kPlanner) instances.insert(status.instance);
    }
    EXPECT_EQ(instances.size(), 4u);
  }
}

/// A planner `mine` that does `next` in the place of coming to the bus when there is that file,
/// which it makes.
std::string OnceOnlyCommand(const std::string& program, const std::string& robot,
                            const std::filesystem::path& begun, const std::string& next) {
  return fmt::format("mine=[ -e {0} ] && {{ {1}; }}; touch {0}; exec {2} --robot {3} --name mine",
                     begun.string(), next, program, robot);
}

TEST_F(LaunchedSession, OneThatIsNotToBeStartedAnewIsGivenUpAndItsRunsAreMissing) {
  const auto session = folder() / "session";
  ChildProcess* driver = StartLaunchedDriver(
      session, {"--problems-range", "1-3", "--time", "30", "--directions", "forward",
                "--problems-per-process", "1", "--planners", "rrtc,mine", "--planner-command",
                OnceOnlyCommand(Program("planner_rrtc"), RobotFolder(), folder() / "begun",
                                "echo no licence; exit 2")});
  EXPECT_EQ(driver->Wait(), 1) << driver->Errors();
  EXPECT_TRUE(LeftRunning().empty());
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE solved"), 3 + 1);
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE message LIKE 'given up: %licence'"), 2);
  EXPECT_EQ(Query(session, "SELECT count(*) FROM sessions WHERE finished"), 0);
  EXPECT_THAT(driver->Output(), testing::HasSubstr("2 OF 6 RUNS ARE MISSING"));
  EXPECT_THAT(driver->Errors(),
              testing::HasSubstr("the planner 'mine': given up: mine: no licence (2 runs)"));
}

TEST_F(LaunchedSession, InterruptedWhilePlannersAreStartedAnewLeavesNothingRunningAndResumes) {
  const auto session = folder() / "session";
  const auto begun = folder() / "begun", again = folder() / "again";
  const std::vector<std::string> flags = {
      "--problems-range",
      "1-2",
      "--time",
      "30",
      "--directions",
      "forward",
      "--problems-per-process",
      "1",
      "--planners",
      "mine",
      "--planner-command",
      OnceOnlyCommand(Program("planner_rrtc"), RobotFolder(), begun,
                      fmt::format("touch {}; exec sleep 1000", again.string()))};
  ChildProcess* driver = StartLaunchedDriver(session, flags);
  ASSERT_TRUE(WaitUntil([&] { return std::filesystem::exists(again); })) << driver->Errors();
  driver->Signal(SIGINT);
  EXPECT_EQ(driver->Wait(), 1) << driver->Errors();
  EXPECT_TRUE(LeftRunning().empty());
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs"), 1);
  EXPECT_THAT(driver->Output(), testing::HasSubstr("--problems-per-process 1"));

  std::filesystem::remove(begun);
  ChildProcess* resumed = Start(Resuming(session, flags));
  EXPECT_EQ(resumed->Wait(), 0) << resumed->Errors();
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE solved"), 2);
}

TEST_F(LaunchedSession, KilledLeavesNothingRunningNotEvenChildrenOfAPlannersScript) {
  const auto script = folder() / "mine.sh";
  for (const bool ends : {true, false}) {  // when it is told to
    std::ofstream(script) << "#!/bin/sh\n"
                          << (ends ? "" : "trap '' TERM\n") << Program("planner_rrtc")
                          << " --robot " << RobotFolder()
                          << " --name mine\necho the planner has ended\n"
                          << (ends ? "" : "sleep 1000\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    const auto session = folder() / (ends ? "ends" : "does not");
    ChildProcess* driver =
        StartLaunchedDriver(session, {"--time", "30", "--trials", "1000", "--planners", "mine",
                                      "--planner-command", "mine=cd / && " + script.string()});
    ASSERT_TRUE(WaitUntil([&] { return Query(session, "SELECT count(*) FROM runs") >= 1; }))
        << driver->Errors();
    EXPECT_GE(LeftRunning().size(), 4U);
    driver->Signal(SIGKILL);
    EXPECT_EQ(driver->Wait(), 128 + SIGKILL);
    EXPECT_TRUE(WaitUntil([this] { return LeftRunning().empty(); }));
  }
}

/// A planner `mine` that leaves its process group.
std::string LeavingCommand(const std::string& program, const std::string& robot) {
  return fmt::format("mine=setsid {} --robot {} --name mine & exec sleep 1000", program, robot);
}

TEST_F(LaunchedSession, APlannerThatLeftItsProcessGroupIsNamedWhenItOutlivesTheSession) {
  ChildProcess* driver = StartLaunchedDriver(
      folder() / "session",
      {"--problems-range", "1", "--time", "30", "--planners", "mine", "--planner-command",
       LeavingCommand(Program("planner_rrtc"), RobotFolder())});
  EXPECT_EQ(driver->Wait(), 0) << driver->Errors();
  const int planner = PidOf("planner_rrtc");
  ASSERT_GT(planner, 0);
  kill(planner, SIGTERM);
  EXPECT_THAT(driver->Errors(), testing::HasSubstr(fmt::format(", pid {}) still runs: ", planner)));
}

TEST_F(LaunchedSession, APlannerThatLeftItsProcessGroupIsNamedWhenASignalOrAnErrorEndsTheSession) {
  Bus bus(url());
  NodeRegistry registry(&bus);
  bus.Start();
  const auto mine = [&] { return registry.Find("mine", NodeKind::kPlanner).has_value(); };
  for (const bool is_signal : {true, false}) {
    // Another is waited for before the first run, until there is that file: then it refuses.
    const std::filesystem::path refuses = folder() / "refuses";
    ChildProcess* driver = StartLaunchedDriver(
        folder() / fmt::format("session{}", is_signal),
        {"--lcm-url", url(), "--planners", "mine,late", "--planner-command",
         fmt::format("late=until [ -e {} ]; do sleep 0.1; done; exit 2", refuses.string()),
         "--planner-command", LeavingCommand(Program("planner_rrtc"), RobotFolder())});
    ASSERT_TRUE(registry.WaitUntil(mine, kTestPatience)) << driver->Errors();
    if (is_signal) {
      driver->Signal(SIGTERM);
    } else {
      std::ofstream(refuses) << "\n";
    }
    EXPECT_EQ(driver->Wait(), is_signal ? 1 : 2) << driver->Errors();
    const int planner = PidOf("planner_rrtc");
    ASSERT_GT(planner, 0);
    kill(planner, SIGTERM);
    EXPECT_THAT(driver->Errors(),
                testing::HasSubstr(fmt::format(", pid {}) still runs: ", planner)));
    ASSERT_TRUE(registry.WaitUntil([&] { return registry.Live().empty(); }, kTestPatience));
  }
}

}  // namespace
}  // namespace planbench
