#include "benchmark_driver/driver.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/version.h"
#include "robot_model/referee_misfits.h"
#include "tests/benchmark_driver/driver_fixture.h"

namespace planbench {
namespace {

TEST_F(DriverTest, MakesAndRecordsEveryRun) {
  FakePlanner planner(&bus_);
  planner.status.settings["learned_from"] = "cans";
  planner.Restart();
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  Driver driver(&bus_, Options(), LineUp({"arm"}), {{"key", "value"}});
  MakeAll(&driver);
  const RunRecordMessage first = logger.records().messages().at(0);
  EXPECT_EQ(first.request_id, "run/cans/1/arm/forward/1");
  EXPECT_EQ(first.status, PlanStatus::kSolved);
  EXPECT_EQ(first.algorithm, "Fake*");
  EXPECT_EQ(first.settings.at("step"), "5");
  EXPECT_EQ(first.request.edge_resolution_m, 0.02);  // the robot's
  EXPECT_EQ(first.result.result.path, FakePath());
  ASSERT_EQ(driver.runs().size(), 4u);
  const RunRow& row = driver.runs().rows().front();
  EXPECT_EQ(*row.contestant, "Fake*");
  EXPECT_TRUE(row.trained);
  EXPECT_TRUE(row.claimed);
  EXPECT_TRUE(row.confirmed());

  EXPECT_EQ(Ids(logger.records()).size(), 4u);
  const auto sessions = logger.sessions().messages();
  ASSERT_GE(sessions.size(), 2u);
  EXPECT_FALSE(sessions.front().finished);
  EXPECT_TRUE(sessions.back().finished);
  EXPECT_EQ(sessions[0].run_id, "run");
  EXPECT_EQ(sessions[0].num_runs, 4);
  const SessionConditions& conditions = sessions[0].conditions;
  EXPECT_EQ(conditions.request.robot_id, kFakeRobotId);
  EXPECT_EQ(conditions.request.edge_resolution_m, 0.02);
  EXPECT_EQ(conditions.request.edge_check, EdgeCheck::kFixed);
  EXPECT_EQ(conditions.referee_step_m, 0.01);
  EXPECT_EQ(conditions.problem_sets, (std::map<std::string, std::string>{{"cans", "cans-1"}}));
  ASSERT_EQ(conditions.contestants.size(), 1u);
  const Contestant& contestant = conditions.contestants[0];
  EXPECT_EQ(contestant.planner, "arm");
  EXPECT_EQ(contestant.name, "Fake*");  // what it says of itself
  EXPECT_EQ(first.contestant, "Fake*");
  EXPECT_EQ(contestant.collision_model, CollisionModel::kSpheres);
  EXPECT_EQ(contestant.edge_resolution_m, 0.02);
  EXPECT_EQ(contestant.edge_check, EdgeCheck::kFixed);
  EXPECT_EQ(sessions[0].settings.at("key"), "value");
  EXPECT_EQ(sessions[0].nodes.size(), 3u);
}

TEST_F(DriverTest, InWhatTheRefereesRobotIsAnotherOneTheSceneServerTells) {
  const FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_, {{kRefereeMisfits, "its link 'hand' is elsewhere"}});
  const FakeLogger logger(&bus_);
  Driver driver(&bus_, Options(), LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  EXPECT_EQ(driver.referee_misfits(), "its link 'hand' is elsewhere");
}

TEST_F(DriverTest, AutoGoesBackwardWhereForwardFailed) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  SolveSecondBackwardOnly(&planner);
  DriverOptions options = Options();
  options.directions = Directions::kAuto;
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  MakeAll(&driver);
  EXPECT_EQ(Ids(logger.records()),
            (std::set<std::string>{"run/cans/1/arm/forward/1", "run/cans/2/arm/backward/1",
                                   "run/cans/2/arm/forward/1"}));
  EXPECT_EQ(logger.sessions().messages().back().num_runs, 3);
  for (const RunRow& run : driver.runs().rows()) {
    EXPECT_EQ(run.needs_other, run.problem_index == 2 && run.direction == Direction::kForward);
  }
}

TEST_F(DriverTest, OfBothDirectionsAFailureNeedsTheOther) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  const FakeLogger logger(&bus_);
  SolveSecondBackwardOnly(&planner);
  Driver driver(&bus_, Options(), LineUp({"arm"}), {});
  MakeAll(&driver);
  ASSERT_EQ(driver.runs().size(), 4u);
  for (const RunRow& run : driver.runs().rows()) EXPECT_EQ(run.needs_other, !run.confirmed());
}

TEST_F(DriverTest, ContestantsOfOneAlgorithmAreToldApart) {
  const FakePlanner arm(&bus_, "arm");
  const FakePlanner leg(&bus_, "leg");
  const FakeSceneServer server(&bus_);
  Driver driver(&bus_, Options(), LineUp({"arm", "leg"}), {});
  driver.Discover(false, Idle);
  ASSERT_EQ(driver.conditions().contestants.size(), 2u);
  EXPECT_EQ(driver.conditions().contestants[0].name, "Fake* [arm]");
  EXPECT_EQ(driver.conditions().contestants[1].name, "Fake* [leg]");
}

TEST_F(DriverTest, RunsOfOneWithoutAnAlgorithmAreRecordedByItsNameOnTheBus) {
  FakePlanner planner(&bus_);
  planner.status.algorithm = planner.status.planner_class = "";
  planner.Restart();
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  Driver driver(&bus_, Options(), LineUp({"arm"}), {});
  MakeAll(&driver);
  EXPECT_EQ(logger.records().messages().at(0).contestant, "arm");
  EXPECT_EQ(logger.sessions().messages().at(0).conditions.contestants.at(0).name, "arm");
}

TEST_F(DriverTest, ContestantsHaveConditionsOfTheirOwn) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  std::vector<LineUpEntry> line_up = LineUp({"arm"});
  line_up[0].contestant.edge_resolution_m = 0.05;
  line_up[0].contestant.edge_check = EdgeCheck::kCertified;
  line_up[0].contestant.name = "Arm (coarse)";
  line_up[0].directions = Directions::kForward;
  Driver driver(&bus_, Options(), line_up, {});
  MakeAll(&driver);
  EXPECT_EQ(driver.runs().size(), 2u);
  const RunRecordMessage record = logger.records().messages().at(0);
  EXPECT_EQ(record.contestant, "Arm (coarse)");
  EXPECT_EQ(record.request.edge_resolution_m, 0.05);
  EXPECT_EQ(record.request.edge_check, EdgeCheck::kCertified);
  EXPECT_EQ(driver.conditions().referee_step_m, 0.01);  // the referee is the session's
}

TEST_F(DriverTest, WithoutAskingTheRefereesStepIsNotTooFine) {
  const FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  DriverOptions options = Options();
  options.conditions.request.edge_resolution_m = 1e-6;
  const auto step_m = [&] {
    Driver driver(&bus_, options, LineUp({"arm"}), {});
    driver.Discover(false, Idle);
    return driver.conditions().referee_step_m;
  };
  EXPECT_EQ(step_m(), 2e-4);
  options.conditions.referee_step_m = 1e-6;
  EXPECT_EQ(step_m(), 1e-6) << "as it was asked for";
}

TEST_F(DriverTest, PlannersMayWorkAtOnce) {
  const FakePlanner arm(&bus_, "arm");
  const FakePlanner leg(&bus_, "leg");
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.conditions.parallel = true;
  Driver driver(&bus_, options, LineUp({"arm", "leg"}), {});
  MakeAll(&driver);
  EXPECT_EQ(driver.runs().size(), 8u);
  EXPECT_EQ(Ids(logger.records()).size(), 8u);
}

TEST_F(DriverTest, RunsThatAreNotRecordedAreAFailure) {
  const FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  Driver driver(&bus_, Options(), LineUp({"arm"}), {});
  driver.Discover(false, Idle);
  EXPECT_FALSE(driver.Run(Never, Idle));
  EXPECT_EQ(driver.runs().size(), 4u);
}

TEST_F(DriverTest, InterruptionStopsAndSaysSo) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    if (request.direction == Direction::kForward) planner.Solve(request);
  });
  Driver driver(&bus_, Options(), LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  EXPECT_FALSE(driver.Run([&] { return Ids(planner.requests()).size() >= 3; }, Idle));
  EXPECT_EQ(driver.runs().size(), 1u);
  EXPECT_FALSE(logger.sessions().messages().back().finished);
}

TEST_F(DriverTest, WatchEndsTheSession) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  planner.OnRequest([](const PlanRequest&) {});
  Driver driver(&bus_, Options(), LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  EXPECT_THROW(driver.Run(Never,
                          [&] {
                            if (!planner.requests().messages().empty()) {
                              throw std::runtime_error("a child died");
                            }
                          }),
               std::runtime_error);
  EXPECT_FALSE(logger.sessions().messages().back().finished);
}

TEST_F(DriverTest, DeadPlannersRunsSayWhatItWas) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.problem_indices = {1};
  options.directions = Directions::kForward;
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  planner.OnRequest([&](const PlanRequest& request) {
    if (request.request_id.ends_with("/warm-up")) {
      planner.Solve(request);
    } else {
      planner.FallSilent();
    }
  });
  EXPECT_TRUE(driver.Run(Never, Idle));
  EXPECT_EQ(driver.runs().size(), 1u);
  const RunRecordMessage record = logger.records().messages().at(0);
  EXPECT_EQ(record.status, PlanStatus::kNoAnswer);
  EXPECT_EQ(record.algorithm, "Fake*");
  EXPECT_EQ(record.settings.at("step"), "5");
}

TEST_F(DriverTest, OneThatIsGivenUpLeavesTheOthersTheirRuns) {
  FakePlanner arm(&bus_, "arm");
  FakePlanner leg(&bus_, "leg");
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  Driver driver(&bus_, Options(), LineUp({"arm", "leg"}), {});
  driver.Discover(true, Idle);
  arm.FallSilent();
  EXPECT_TRUE(driver.given_up().empty());
  EXPECT_TRUE(driver.Run(Never, [&] { driver.GiveUp("arm", "it died"); }));
  EXPECT_EQ(driver.given_up(), (std::map<std::string, std::string>{{"arm", "it died"}}));
  ASSERT_EQ(driver.runs().size(), 8u);
  int num_solved = 0;
  std::set<std::string> not_asked;
  for (const RunRecordMessage& record : logger.records().messages()) {
    if (record.planner == "leg") {
      num_solved += record.status == PlanStatus::kSolved;
    } else if (record.message != "the process died or fell silent") {
      EXPECT_EQ(record.status, PlanStatus::kNoAnswer);
      EXPECT_EQ(record.message, "given up: it died");
      not_asked.insert(record.request_id);
    }
  }
  EXPECT_EQ(driver.num_not_asked(), static_cast<int>(not_asked.size()));
  EXPECT_EQ(
      driver.UnaskedRunLines(),
      std::vector{fmt::format("the planner 'arm': given up: it died ({} runs)", not_asked.size())});
  EXPECT_GE(num_solved, 4);
  EXPECT_GE(not_asked.size(), 2u);
  EXPECT_FALSE(logger.sessions().messages().back().finished) << "they are still to be made";
}

TEST_F(DriverTest, PathsThatTheRefereeRefusesAreToldFromWhatAResumedSessionMakes) {
  const FakePlanner planner(&bus_);
  FakeSceneServer server(&bus_);
  server.OnPathCheck([](const PathCheckRequestMessage& request) {
    if (request.scene_id == "scene-2") throw InputError("the step is too fine");
    return FakeSceneServer::Verdict(true);
  });
  FakeLogger logger(&bus_);
  Driver driver(&bus_, Options(), LineUp({"arm"}), {});
  MakeAll(&driver);
  EXPECT_EQ(driver.num_not_asked(), 2);
  EXPECT_EQ(driver.num_unjudgeable(), 2);
  EXPECT_FALSE(logger.sessions().messages().back().finished);

  DriverOptions options = Options();
  options.problem_indices = {1};
  Driver of_others(&bus_, options, LineUp({"arm"}), {},
                   {logger.sessions().messages(), Held(logger.records().messages())});
  MakeAll(&of_others);
  EXPECT_EQ(of_others.num_unjudgeable(), 0);
  EXPECT_EQ(of_others.num_owed_unjudgeable(), 2);
  EXPECT_EQ(of_others.num_owed(), 2);
}

TEST_F(DriverTest, OneThatComesBackWithOtherSettingsHasNoMoreRuns) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  Driver driver(&bus_, Options(), LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  planner.status.settings["step"] = "6";
  Reannounce(&planner);
  EXPECT_TRUE(driver.Run(Never, Idle));
  EXPECT_TRUE(planner.requests().messages().empty());
  const RunRecordMessage record = logger.records().messages().at(0);
  EXPECT_EQ(record.status, PlanStatus::kNoAnswer);
  EXPECT_THAT(record.message, testing::HasSubstr("step"));
  EXPECT_EQ(record.settings.at("step"), "5") << "those of the contestant";
  const SessionMessage session = logger.sessions().messages().back();
  for (const NodeStatusMessage& node : session.nodes) {
    if (node.name == "arm") {
      EXPECT_EQ(node.settings.at("step"), "5");
    }
  }
}

TEST_F(DriverTest, SaysWhoIsMissingAndWhoIsThere) {
  const FakePlanner planner(&bus_);
  DriverOptions options = Options();
  options.discovery_timeout_s = 0.5;
  Driver driver(&bus_, options, LineUp({"arm", "leg"}), {});
  // Heard before, so that its being there does not depend on the half second.
  NodeRegistry registry(&bus_);
  ASSERT_TRUE(registry.WaitUntil([&] { return !registry.Live().empty(); }, kTestPatience));
  ExpectInputError(
      [&] { driver.Discover(true, Idle); },
      {"0.5 s", "a scene server", "a planner named 'leg'", "a logger", "heard: arm (planner)"});
}

TEST_F(DriverTest, PlannersMustFitTheSession) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  DriverOptions options = Options();
  options.conditions.request.collision_model = CollisionModel::kMeshes;
  planner.status.unusable_models = {{"meshes", "has none"}};
  Reannounce(&planner);
  ExpectNotDiscovered(options, {"--collision-model", "'arm'", "'meshes': has none"});
  options = Options();
  options.conditions.request.anytime = true;
  ExpectNotDiscovered(options, {"--anytime", "'arm'"});
  options = Options();
  options.sets = {"boxes"};
  ExpectNotDiscovered(options, {"'boxes'", "cans"});

  planner.status.settings["about"] = std::string(1'000'000, 'x');
  Reannounce(&planner);
  ExpectNotDiscovered(Options(), {"'arm' announces itself in", "1000000 at most"});
  planner.status.settings.erase("about");
  planner.status.can_backward = false;
  Reannounce(&planner);
  ExpectNotDiscovered(Options(), {"--directions", "'arm'"});
  planner.status.robot_id = "robot-2";
  Reannounce(&planner);
  ExpectNotDiscovered(Options(), {"'arm'", "robot-2", kFakeRobotId});
}

TEST_F(DriverTest, ALoggerOfAnotherBuildIsRefused) {
  const FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  NodeStatusMessage status = MakeNodeStatus("store", NodeKind::kLogger);
  status.commit = "older";
  const NodeAnnouncer logger(&bus_, [status] { return status; });
  NodeRegistry registry(&bus_);
  ASSERT_TRUE(
      registry.WaitUntil([&] { return !registry.Live(NodeKind::kLogger).empty(); }, kTestPatience));
  Driver driver(&bus_, Options(), LineUp({"arm"}), {});
  ExpectInputError([&] { driver.Discover(true, Idle); },
                   {"logger 'store'", "another build", "older"});
}

TEST_F(DriverTest, APlannerOfAnotherBuildIsRefusedWhateverItsNameUnlessItIsForeign) {
  FakePlanner planner(&bus_);
  const FakeSceneServer server(&bus_);
  planner.status.version = "0.0.1";
  planner.status.settings["program"] = "planner_of_somebody_else";
  Reannounce(&planner);
  Driver(&bus_, Options(), LineUp({"arm"}), {}).Discover(false, Idle);
  // One beside the driver: this test.
  planner.status.settings["program"] =
      std::filesystem::read_symlink("/proc/self/exe").filename().string();
  Reannounce(&planner);
  ExpectNotDiscovered(Options(), {"planner 'arm'", "another build", "0.0.1"});
  planner.status.version = Version();
  Reannounce(&planner);
  Driver(&bus_, Options(), LineUp({"arm"}), {}).Discover(false, Idle);
}

TEST_F(DriverTest, RunIdsAreDatedAndDiffer) {
  const std::string id = NewRunId();
  EXPECT_TRUE(std::regex_match(id, std::regex("[0-9]{8}T[0-9]{6}Z-[0-9a-f]{16}"))) << id;
}

}  // namespace
}  // namespace planbench
