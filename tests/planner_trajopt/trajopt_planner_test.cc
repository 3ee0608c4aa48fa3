#include "planner_trajopt/trajopt_planner.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "planner_trajopt/trajopt_settings.h"
#include "planning/path_measures.h"
#include "tests/contract/planner_contract.h"
#include "tests/contract/random_robots_contract.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

YamlNode Settings(const std::string& text) { return YamlNode::Parse(text, "trajopt.yaml"); }

std::vector<PlannerFactory> AllPlanners() {
  std::vector<PlannerFactory> factories;
  for (const std::string name : {"STOMP", "CHOMP"}) {
    factories.push_back({name, [name](const Robot& robot) {
                           return MakeTrajoptPlanner(robot, Settings("algorithm: " + name));
                         }});
  }
  return factories;
}

INSTANTIATE_TEST_SUITE_P(Trajopt, PlannerContract, testing::ValuesIn(AllPlanners()),
                         [](const auto& info) { return info.param.name; });

TEST(TrajoptPlanner, PlansForRandomRobots) {
  for (const PlannerFactory& factory : AllPlanners()) {
    SCOPED_TRACE(factory.name);
    ExpectPlansForRandomRobots(factory.make);
  }
}

class TrajoptPlannerTest : public testing::Test {
 protected:
  PlanResult Solve(const std::string& settings, const Scene& scene, std::uint64_t seed = 1) const {
    PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
    request.seed = seed;
    return MakeTrajoptPlanner(robot_, Settings(settings))->Plan(request, scene, nullptr);
  }

  const Robot robot_ = LoadPlanarRobot();
};

TEST_F(TrajoptPlannerTest, RefusesBadSettingsByFileLineAndKey) {
  const auto expect_refused = [&](const std::string& text, const std::vector<std::string>& parts) {
    SCOPED_TRACE(text);
    ExpectInputError([&] { MakeTrajoptPlanner(robot_, Settings(text)); }, parts);
  };
  expect_refused("algorithm: TrajOpt",
                 {"trajopt.yaml:1", "algorithm", "TrajOpt", "STOMP or CHOMP"});
  expect_refused("clearance: 0.1\nclearence: 0.2", {"trajopt.yaml:2", "clearence"});
  expect_refused("noise: 1\nclearance:", {"trajopt.yaml:2: clearance:", "has no value"});
  expect_refused("clearance: ~", {"trajopt.yaml:1: clearance:", "has no value"});
  expect_refused("waypoints: 0", {"trajopt.yaml:1", "waypoints", "1 to 1000", "0"});
  expect_refused("rollouts: 1", {"trajopt.yaml:1", "rollouts", "1"});
  expect_refused("guesses: some", {"trajopt.yaml:1", "guesses", "some"});
  for (const std::string key : {"clearance", "noise", "gain", "step", "gradient_step"}) {
    const std::string owner = key.find("step") == key.npos ? "STOMP" : "CHOMP";
    for (const std::string value : {"0", "-1", "1e-300", "1e300"}) {
      expect_refused("algorithm: " + owner + "\n" + key + ": " + value,
                     {"trajopt.yaml:2: " + key + ": must be from 1e-06 to 1000000, found "});
    }
  }
  for (const std::string key : {"smoothness", "given_smoothness"}) {
    expect_refused(key + ": -1", {"trajopt.yaml:1: " + key + ": must be from 0 to 1000000", "-1"});
    expect_refused(key + ": 1e308", {"trajopt.yaml:1: " + key, "1e+308"});
  }
  expect_refused("\nstep: 0.1", {"trajopt.yaml:2", "step", "CHOMP only"});
  expect_refused("algorithm: CHOMP\nnoise: 0.1", {"trajopt.yaml:2", "noise", "STOMP only"});
}

TEST_F(TrajoptPlannerTest, ARequestCannotChangeTheAlgorithm) {
  const std::unique_ptr<Planner> planner = MakeTrajoptPlanner(robot_, Settings(""));
  for (const auto& [key, value] : std::map<std::string, std::string>{
           {"algorithm", "CHOMP"}, {"noise", "loud"}, {"step", "1"}}) {
    PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
    request.parameters[key] = value;
    const PlanResult result = planner->Plan(request, PostsScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kInvalidRequest) << key;
    EXPECT_NE(result.message.find(key), std::string::npos) << result.message;
  }
}

TEST_F(TrajoptPlannerTest, Describes) {
  const PlannerDescription stomp = MakeTrajoptPlanner(robot_, Settings(""))->Describe();
  EXPECT_EQ(stomp.algorithm, "STOMP (restarted)");
  EXPECT_EQ(stomp.planner_class, PlannerClass::kTrajectoryOptimisation);
  EXPECT_TRUE(stomp.anytime);
  EXPECT_FALSE(stomp.deterministic);
  EXPECT_FALSE(stomp.bidirectional);
  EXPECT_EQ(stomp.settings.at("guesses"), "unlimited");
  EXPECT_TRUE(stomp.settings.contains("noise"));
  EXPECT_FALSE(stomp.settings.contains("step"));
  const PlannerDescription chomp =
      MakeTrajoptPlanner(robot_, Settings("{algorithm: CHOMP, guesses: 1}"))->Describe();
  EXPECT_EQ(chomp.algorithm, "CHOMP (straight guess)");
  EXPECT_TRUE(chomp.deterministic) << "without guesses nothing is drawn";
  EXPECT_FALSE(chomp.settings.contains("noise"));
  EXPECT_EQ(MakeTrajoptPlanner(robot_, Settings("guesses: 5"))->Describe().algorithm,
            "STOMP (5 guesses)");
}

TEST_F(TrajoptPlannerTest, EverySettingOfItsAlgorithmTakesEffect) {
  const std::map<std::string, std::vector<std::string>> by_algorithm = {
      {"STOMP",
       {"waypoints: 20", "clearance: 0.1", "smoothness: 0.1", "rollouts: 8", "noise: 0.1",
        "gain: 3"}},
      {"CHOMP",
       {"waypoints: 20", "clearance: 0.1", "smoothness: 0.1", "step: 0.05", "gradient_step: 0.1"}}};
  for (const auto& [algorithm, settings] : by_algorithm) {
    const std::string common = "{guesses: 3, algorithm: " + algorithm;
    const PlanResult result = Solve(common + "}", PostsScene());
    ASSERT_EQ(result.status, PlanStatus::kSolved) << algorithm;
    for (const std::string setting : {"iterations: 3", "patience: 1"}) {
      EXPECT_NE(Solve(common + ", " + setting + "}", WallsScene()).counters,
                Solve(common + "}", WallsScene()).counters)
          << algorithm << ", " << setting;
    }
    for (const std::string& setting : settings) {
      const PlanResult other = Solve(common + ", " + setting + "}", PostsScene());
      EXPECT_TRUE(other.path != result.path || other.counters != result.counters)
          << algorithm << ", " << setting;
    }
  }
}

TEST_F(TrajoptPlannerTest, WhatCollidesAfterTheLastGuessSaysSo) {
  for (const std::string algorithm : {"STOMP", "CHOMP"}) {
    const PlanResult result =
        Solve("{guesses: 2, iterations: 5, algorithm: " + algorithm + "}", WallsScene());
    EXPECT_EQ(result.status, PlanStatus::kExhausted);
    EXPECT_EQ(result.message,
              "in collision all the same: " + algorithm + " optimised from 2 guesses");
    EXPECT_EQ(result.counters.at("guesses"), 2);
    EXPECT_LE(result.counters.at("iterations"), 10);
    EXPECT_GT(result.phases.collision_s, 0);
  }
}

TEST_F(TrajoptPlannerTest, AStraightMotionThatIsFreeIsThePath) {
  const PlanResult result = Solve("waypoints: 9", EmptyPlanarScene());
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_EQ(result.path.size(), 11u);
  EXPECT_EQ(result.counters.at("iterations"), 0);
  EXPECT_EQ(result.counters.at("guesses"), 1);
  EXPECT_NEAR(result.cost, 1.2, 1e-9);
  EXPECT_EQ(result.counters.at("edges_checked"), 10);
}

TEST_F(TrajoptPlannerTest, TheCostIsThePathsLengthAlsoWhereWaypointsAreFarApart) {
  const JointSpace& space = robot_.groups.front().space;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PlanResult result = Solve("{waypoints: 1, noise: 1}", PostsScene(), seed);
    ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
    EXPECT_NEAR(result.cost, PathLength(space, result.path), 1e-9) << seed;
  }
}

TEST_F(TrajoptPlannerTest, SeedsDecideThePath) {
  for (const std::string settings : {"", "algorithm: CHOMP"}) {
    const Path one = Solve(settings, PostsScene(), 1).path;
    EXPECT_EQ(Solve(settings, PostsScene(), 1).path, one) << settings;
    EXPECT_NE(Solve(settings, PostsScene(), 2).path, one) << settings;
  }
}

TEST_F(TrajoptPlannerTest, APathThatIsGivenIsNoGuess) {
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {1.2, 0, 0});
  request.initial_joint_names = {"shoulder", "elbow", "wrist"};
  request.initial_path = {{0.6, 0, 0}, {-0.6, 0, 0}, {1.2, 0, 0}};  // Twice through a post.
  const auto solve = [&](const Scene& scene) {
    return MakeTrajoptPlanner(robot_, Settings("{guesses: 1, iterations: 1, algorithm: CHOMP}"))
        ->Plan(request, scene, nullptr);
  };
  const PlanResult result = solve(PostsScene());
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_EQ(result.counters.at("guesses"), 1);
  EXPECT_NEAR(result.cost, 0.6, 1e-9) << "the straight motion";

  request = MakeRequest(robot_, {1.57, 0, 0}, {-1.57, 0, 0});
  request.initial_joint_names = {"shoulder", "elbow", "wrist"};
  request.initial_path = {{1.57, 0, 0}, {0, 0.5, 0}, {-1.57, 0, 0}};
  EXPECT_EQ(solve(WallsScene()).message,
            "in collision all the same: CHOMP optimised from the path given and the straight "
            "motion");
}

TEST_F(TrajoptPlannerTest, APathInHandWhenTheLimitComesCounts) {
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  request.initial_joint_names = {"shoulder", "elbow", "wrist"};
  request.initial_path = {{0.6, 0, 0}, {-0.6, 0, 0}};  // In collision, but not for long.
  request.time_limit_s = 1;
  const PlanResult result =
      MakeTrajoptPlanner(robot_, Settings("{patience: 1000000, iterations: 1000000}"))
          ->Plan(request, PostsScene(), nullptr);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_EQ(result.planning_time_s, request.time_limit_s);
  EXPECT_GE(result.total_time_s, request.time_limit_s);
}

TEST_F(TrajoptPlannerTest, APathThatIsGivenIsImproved) {
  const Path detour = {{0.6, 0, 0},    {1.2, 1, 1},  {1.2, 2.2, 1},
                       {-1.2, 2.2, 1}, {-1.2, 1, 1}, {-0.6, 0, 0}};
  for (const std::string algorithm : {"STOMP", "CHOMP"}) {
    SCOPED_TRACE(algorithm);
    PlanRequest request = MakeRequest(robot_, detour.front(), detour.back());
    request.initial_joint_names = {"shoulder", "elbow", "wrist"};
    request.initial_path = detour;
    const auto planner =
        MakeTrajoptPlanner(robot_, Settings("{guesses: 1, algorithm: " + algorithm + "}"));
    const PlanResult result = planner->Plan(request, PostsScene(), nullptr);
    ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
    EXPECT_EQ(result.counters.at("guesses"), 0) << "none of its own";
    EXPECT_GT(result.counters.at("iterations"), 0);
    const JointSpace& space = robot_.groups.front().space;
    EXPECT_LT(PathLength(space, result.path), 0.9 * PathLength(space, detour));
    request.parameters["smoothness"] = "0.1";
    EXPECT_EQ(planner->Plan(request, PostsScene(), nullptr).path, result.path) << "of guesses";
    request.parameters = {{"given_smoothness", "0.001"}};
    EXPECT_NE(planner->Plan(request, PostsScene(), nullptr).path, result.path);
  }
}

TEST_F(TrajoptPlannerTest, APathThatIsGivenIsNotSaidToCollideIfThereWasNoTimeToCheckIt) {
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  request.initial_joint_names = {"shoulder", "elbow", "wrist"};
  request.initial_path = {{0.6, 0, 0}, {-0.6, 0, 0}};
  request.edge_check = EdgeCheck::kFixed;
  request.edge_resolution_m = 1e-4;
  request.time_limit_s = 1e-6;
  const PlanResult result =
      MakeTrajoptPlanner(robot_, Settings(""))->Plan(request, EmptyPlanarScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kTimedOut);
  EXPECT_EQ(result.message, "the path given was not checked in time");
}

TEST_F(TrajoptPlannerTest, NothingIsSaidToCollideThatWasNotLookedAt) {
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  request.time_limit_s = 1e-6;  // Gone with the set-up.
  const PlanResult result =
      MakeTrajoptPlanner(robot_, Settings(""))->Plan(request, EmptyPlanarScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kTimedOut);
  EXPECT_EQ(result.message, "the time was up before anything was optimised");
}

}  // namespace
}  // namespace planbench
