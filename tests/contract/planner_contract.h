#pragma once

// What every planner must do, whatever its algorithm. A planner's test instantiates it:
//
//   INSTANTIATE_TEST_SUITE_P(Rrtc, PlannerContract, testing::Values(PlannerFactory{"rrtc", make}));

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <thread>

#include "planning/path_judge.h"
#include "planning/path_measures.h"
#include "planning/planner.h"
#include "planning/resolve.h"
#include "tests/support/planning_problems.h"

namespace planbench {

/// Makes the planner under test, with settings that suit the robot (planar3 of tests/data or
/// robots/fetch).
struct PlannerFactory {
  std::string name;
  std::function<std::unique_ptr<Planner>(const Robot&)> make;
};
inline void PrintTo(const PlannerFactory& factory, std::ostream* out) { *out << factory.name; }

/// The exact collision engine, which serves meshes, leads a planner to the same paths as the fast
/// one, unless its search comes on a configuration within 0.1 mm of contact, where the fast one
/// errs to the safe side: not in these requests.
inline void ExpectSamePathsFromBothEngines(
    const std::function<std::unique_ptr<Planner>(const Robot&)>& make) {
  const Robot robot = LoadPlanarRobot();
  const Scene scene = PostsScene();
  PlanRequest request = MakeRequest(robot, {0.6, 0, 0}, {-0.6, 0, 0});
  request.edge_check = EdgeCheck::kFixed;  // both engines judge the same samples
  const std::unique_ptr<Planner> planner = make(robot);
  for (const std::uint64_t seed : {1, 2, 3}) {
    request.seed = seed;
    request.collision_model = CollisionModel::kSpheres;
    const PlanResult fast = planner->Plan(request, scene, nullptr);
    request.collision_model = CollisionModel::kMeshes;  // the same balls, see planar3.urdf
    const PlanResult exact = planner->Plan(request, scene, nullptr);
    ASSERT_EQ(fast.status, PlanStatus::kSolved) << fast.message;
    EXPECT_EQ(fast.path, exact.path);
    EXPECT_EQ(fast.simplified_path, exact.simplified_path);
  }
}

class PlannerContract : public testing::TestWithParam<PlannerFactory> {
 protected:
  std::unique_ptr<Planner> Make(const Robot& robot) const { return GetParam().make(robot); }

  /// Expects the paths to be free all along, as certified edges are.
  static void ExpectSolved(const Robot& robot, const PlanRequest& request, const Scene& scene,
                           const PlanResult& result) {
    ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
    ExpectValid(robot, request, scene, result.path, "raw path");
    if (request.simplify) {
      ExpectValid(robot, request, scene, result.simplified_path, "simplified path");
      const JointSpace& space = robot.Group(request.group).space;
      EXPECT_LE(PathLength(space, result.simplified_path), PathLength(space, result.path) + 1e-9);
    }
    const PhaseTimes& phases = result.phases;
    EXPECT_NEAR(phases.setup_s + phases.collision_s + phases.guidance_s + phases.search_s,
                result.total_time_s, 1e-9 * result.total_time_s);
    EXPECT_GT(result.planning_time_s, 0);
    EXPECT_LE(result.planning_time_s, request.time_limit_s);
    if (request.anytime) return;
    EXPECT_EQ(result.planning_time_s, std::min(result.total_time_s, request.time_limit_s));
    EXPECT_TRUE(result.progress.empty());
  }

  static void ExpectValid(const Robot& robot, const PlanRequest& request, const Scene& scene,
                          const Path& path, const std::string& what) {
    const PlanningGroup& group = robot.Group(request.group);
    const ResolvedQuery query = ResolveQuery(robot, group, request.start, request.goal, what);
    const auto checker = MakeReferenceChecker(robot, group, request.collision_model);
    checker->SetScene(scene, query.base_positions);
    const PathVerdict verdict = JudgePath(checker.get(), path, query.start, query.goals,
                                          robot.edge_resolution_m / 8, false);
    EXPECT_TRUE(verdict.valid) << what << ": " << verdict.reason;
    EXPECT_EQ(path.front(), query.start) << what;
  }

  const Robot planar_ = LoadPlanarRobot();
  const Configuration left_ = {0.6, 0, 0};    ///< Stretched, left of post_ahead.
  const Configuration right_ = {-0.6, 0, 0};  ///< Stretched, right of it.
};

TEST_P(PlannerContract, SolvesAndThePathIsValid) {
  const Scene scene = PostsScene();
  const PlanRequest request = MakeRequest(planar_, left_, right_);
  const PlanResult result = Make(planar_)->Plan(request, scene, nullptr);
  ExpectSolved(planar_, request, scene, result);
  ASSERT_FALSE(result.path.empty());
  EXPECT_EQ(result.path.back(), right_);
  EXPECT_GT(result.counters.at("edges_checked"), 0);
  EXPECT_GT(result.counters.at("configurations_checked"), 0);
}

TEST_P(PlannerContract, BackwardPathsRunFromStartToGoal) {
  const std::unique_ptr<Planner> planner = Make(planar_);
  if (!planner->Describe().backward) GTEST_SKIP() << "does not search backward";
  const Scene scene = PostsScene();
  PlanRequest request = MakeRequest(planar_, left_, right_);
  request.direction = Direction::kBackward;
  const PlanResult result = planner->Plan(request, scene, nullptr);
  ExpectSolved(planar_, request, scene, result);
  ASSERT_FALSE(result.path.empty());
  EXPECT_EQ(result.path.front(), left_);
  EXPECT_EQ(result.path.back(), right_);
}

TEST_P(PlannerContract, SolvesForTheFetch) {
  const Robot fetch = LoadFetch();
  const Scene scene = FetchTableScene(fetch);
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    PlanRequest request = MakeRequest(fetch, FetchTucked(), FetchOverTable());
    request.direction = direction;
    ExpectSolved(fetch, request, scene, Make(fetch)->Plan(request, scene, nullptr));
  }
}

TEST_P(PlannerContract, SolvesForTheOtherRobotsThatShip) {
  for (const std::string name : {"panda", "ur5e"}) {
    SCOPED_TRACE(name);
    const Robot robot = LoadRobot(PLANBENCH_SOURCE_DIR "/robots/" + name);
    const PlanningGroup& group = robot.groups.front();
    const Configuration start = group.states.at("ready");
    Scene scene;
    scene.world_frame = robot.model.links().front().name;
    AddBox(&scene, "shelf", {0.4, 0, 1.2}, {0.3, 0.6, 0.02});
    AddBox(&scene, "table", {0.4, 0, -0.3}, {0.6, 1.2, 0.02});
    const auto checker = MakeReferenceChecker(robot, group, CollisionModel::kSpheres);
    checker->SetScene(scene, robot.model.DefaultPositions());
    std::mt19937 random(1);
    Configuration goal;
    do {
      goal = start;
      for (int j = 0; j < group.space.size(); ++j) {
        const JointSpace::Joint& joint = group.space.joint(j);
        double& q = goal[static_cast<std::size_t>(j)];
        q = std::clamp(q + std::uniform_real_distribution<double>(-0.6, 0.6)(random), joint.lower,
                       joint.upper);
      }
    } while (!checker->IsFree(goal));
    const PlanRequest request = MakeRequest(robot, start, goal);
    ExpectSolved(robot, request, scene, Make(robot)->Plan(request, scene, nullptr));
  }
}

TEST_P(PlannerContract, SolvesWithADistanceField) {
  const Scene scene = PostsScene();
  PlanRequest request = MakeRequest(planar_, left_, right_);
  request.collision_model = CollisionModel::kVoxels;
  request.edge_check = EdgeCheck::kCertified;
  ExpectSolved(planar_, request, scene, Make(planar_)->Plan(request, scene, nullptr));
}

TEST_P(PlannerContract, TheSameRequestGivesTheSamePathWhateverRanBefore) {
  const Scene scene = PostsScene();
  const PlanRequest request = MakeRequest(planar_, left_, right_);
  PlanRequest other = MakeRequest(planar_, {1.5, 0.5, 0.5}, {-1.5, 0.5, -0.5});
  other.seed = 7;

  const std::unique_ptr<Planner> planner = Make(planar_);
  const PlanResult first = planner->Plan(request, scene, nullptr);
  planner->Plan(other, EmptyPlanarScene(), nullptr);
  other.direction = Direction::kBackward;
  planner->Plan(other, scene, nullptr);
  const PlanResult again = planner->Plan(request, scene, nullptr);
  const PlanResult fresh = Make(planar_)->Plan(request, scene, nullptr);

  ASSERT_EQ(first.status, PlanStatus::kSolved) << first.message;
  EXPECT_EQ(first.path, again.path);
  EXPECT_EQ(first.simplified_path, again.simplified_path);
  EXPECT_EQ(first.counters, again.counters);
  EXPECT_EQ(first.path, fresh.path);
  EXPECT_EQ(first.simplified_path, fresh.simplified_path);
  EXPECT_EQ(first.counters, fresh.counters);
}

TEST_P(PlannerContract, OfSeveralGoalsReachesOneThatIsFree) {
  const Scene scene = PostsScene();
  PlanRequest request = MakeRequest(planar_, left_, {0, 0, 0});  // In a post.
  for (const Configuration& goal : {Configuration{0.02, 0, 0}, right_}) {
    const PlanRequest other = MakeRequest(planar_, left_, goal);
    request.goal.insert(request.goal.end(), other.goal.begin(), other.goal.end());
  }
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    request.direction = direction;
    const PlanResult result = Make(planar_)->Plan(request, scene, nullptr);
    ExpectSolved(planar_, request, scene, result);
    EXPECT_EQ(result.path.back(), right_);
  }
}

TEST_P(PlannerContract, EndsAnywhereInTheGoalBox) {
  const Scene scene = PostsScene();
  const PlanRequest request = MakeRequest(planar_, left_, right_, 0.2);
  ExpectSolved(planar_, request, scene, Make(planar_)->Plan(request, scene, nullptr));
}

TEST_P(PlannerContract, AStartInsideTheGoalBoxIsSolvedAtOnce) {
  const Scene scene = PostsScene();
  const PlanRequest request = MakeRequest(planar_, left_, {0.7, 0.1, 0}, 0.2);
  const PlanResult result = Make(planar_)->Plan(request, scene, nullptr);
  ExpectSolved(planar_, request, scene, result);
  EXPECT_LE(result.path.size(), 2u);
}

TEST_P(PlannerContract, AContinuousJointTakesTheShortWay) {
  const Scene scene = EmptyPlanarScene();
  const PlanRequest request = MakeRequest(planar_, {3.0, 0.3, 0}, {-3.0, 0.3, 0});
  const PlanResult result = Make(planar_)->Plan(request, scene, nullptr);
  ExpectSolved(planar_, request, scene, result);
  EXPECT_LT(PathLength(planar_.groups.front().space, result.simplified_path), 0.3);
}

TEST_P(PlannerContract, AStartBeyondATurnIsTheSameStart) {
  const Scene scene = PostsScene();
  PlanRequest request = MakeRequest(planar_, {0.6 + 2 * 3.14159265358979, 0, 0}, right_);
  ExpectSolved(planar_, request, scene, Make(planar_)->Plan(request, scene, nullptr));
  request.direction = Direction::kBackward;
  ExpectSolved(planar_, request, scene, Make(planar_)->Plan(request, scene, nullptr));
}

TEST_P(PlannerContract, AStartInCollisionIsNamed) {
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    PlanRequest request = MakeRequest(planar_, {0, 0, 0}, right_);
    request.direction = direction;
    const PlanResult result = Make(planar_)->Plan(request, PostsScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kStartInvalid) << result.message;
    EXPECT_NE(result.message.find("post_ahead"), std::string::npos) << result.message;
    EXPECT_TRUE(result.path.empty());
  }
}

TEST_P(PlannerContract, AGoalInCollisionIsNamed) {
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    PlanRequest request = MakeRequest(planar_, left_, {0, 0, 0});
    request.direction = direction;
    const PlanResult result = Make(planar_)->Plan(request, PostsScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kGoalInvalid) << result.message;
    EXPECT_NE(result.message.find("post_ahead"), std::string::npos) << result.message;
    EXPECT_TRUE(result.path.empty());
  }
}

TEST_P(PlannerContract, TheTimeLimitEndsAHopelessSearch) {
  PlanRequest request = MakeRequest(planar_, {1.57, 0, 0}, {-1.57, 0, 0});
  request.time_limit_s = 0.2;
  const PlanResult result = Make(planar_)->Plan(request, WallsScene(), nullptr);
  EXPECT_TRUE(result.status == PlanStatus::kTimedOut || result.status == PlanStatus::kExhausted)
      << EnumName(result.status) << ": " << result.message;
  EXPECT_TRUE(result.path.empty());
  EXPECT_FALSE(result.message.empty());
  EXPECT_LT(result.total_time_s, 10) << "far more than the slack of a busy machine";
}

TEST_P(PlannerContract, ACancelledSearchReturns) {
  PlanRequest request = MakeRequest(planar_, {1.57, 0, 0}, {-1.57, 0, 0});
  request.time_limit_s = 600;
  PlanControl control;
  const std::unique_ptr<Planner> planner = Make(planar_);
  std::thread canceller([&control] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    control.cancelled = true;
  });
  const PlanResult result = planner->Plan(request, WallsScene(), &control);
  canceller.join();
  EXPECT_TRUE(result.status == PlanStatus::kCancelled || result.status == PlanStatus::kExhausted)
      << EnumName(result.status) << ": " << result.message;
  EXPECT_LT(result.total_time_s, 60);

  // And the planner is as good as before.
  const PlanRequest next = MakeRequest(planar_, left_, right_);
  ExpectSolved(planar_, next, PostsScene(), planner->Plan(next, PostsScene(), nullptr));
}

TEST_P(PlannerContract, AnUnknownParameterIsRefusedByName) {
  PlanRequest request = MakeRequest(planar_, left_, right_);
  request.parameters["no_such_parameter"] = "1";
  const PlanResult result = Make(planar_)->Plan(request, PostsScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kInvalidRequest);
  EXPECT_NE(result.message.find("no_such_parameter"), std::string::npos) << result.message;
}

TEST_P(PlannerContract, ParametersServeTheirRequestOnly) {
  const std::unique_ptr<Planner> planner = Make(planar_);
  PlanRequest request = MakeRequest(planar_, left_, right_);
  request.parameters["no_such_parameter"] = "1";
  planner->Plan(request, PostsScene(), nullptr);
  request.parameters.clear();
  ExpectSolved(planar_, request, PostsScene(), planner->Plan(request, PostsScene(), nullptr));
}

TEST_P(PlannerContract, DescribesItself) {
  const PlannerDescription description = Make(planar_)->Describe();
  EXPECT_FALSE(description.algorithm.empty());
  EXPECT_FALSE(description.collision_models.empty());
  EXPECT_FALSE(description.settings.empty());
}

TEST_P(PlannerContract, ADeterministicPlannerDoesNotLookAtTheSeed) {
  const std::unique_ptr<Planner> planner = Make(planar_);
  if (!planner->Describe().deterministic) GTEST_SKIP() << "is randomised";
  PlanRequest request = MakeRequest(planar_, left_, right_);
  const PlanResult one = planner->Plan(request, PostsScene(), nullptr);
  request.seed = 20;
  const PlanResult other = planner->Plan(request, PostsScene(), nullptr);
  EXPECT_EQ(one.path, other.path);
  EXPECT_EQ(one.simplified_path, other.simplified_path);
  EXPECT_EQ(one.counters, other.counters);
}

TEST_P(PlannerContract, AnAnytimePlannerReportsItsSolutions) {
  const std::unique_ptr<Planner> planner = Make(planar_);
  if (!planner->Describe().anytime) GTEST_SKIP() << "is no anytime planner";
  PlanRequest request = MakeRequest(planar_, left_, right_);
  request.anytime = true;
  request.time_limit_s = 5;
  PlanControl control;
  std::vector<PlanProgress> seen;
  control.on_progress = [&seen](const PlanProgress& progress) { seen.push_back(progress); };
  const PlanResult result = planner->Plan(request, PostsScene(), &control);
  ExpectSolved(planar_, request, PostsScene(), result);
  ASSERT_FALSE(result.progress.empty());
  EXPECT_EQ(seen.size(), result.progress.size());
  EXPECT_EQ(result.planning_time_s, result.progress.front().elapsed_s);
  EXPECT_LE(result.planning_time_s, result.total_time_s);
  for (std::size_t i = 1; i < result.progress.size(); ++i) {
    EXPECT_LE(result.progress[i].cost, result.progress[i - 1].cost);
    if (result.progress[i - 1].epsilon > 0) {  // else nothing was proven yet
      EXPECT_LE(result.progress[i].epsilon, result.progress[i - 1].epsilon);
    }
    EXPECT_GE(result.progress[i].elapsed_s, result.progress[i - 1].elapsed_s);
  }
}

TEST_P(PlannerContract, WhatIsFoundBeforeAnythingIsProvenHasNoBound) {
  const std::unique_ptr<Planner> planner = Make(planar_);
  if (!planner->Describe().anytime) GTEST_SKIP() << "is no anytime planner";
  PlanRequest request = MakeRequest(planar_, left_, right_);
  request.anytime = true;
  request.time_limit_s = 0.2;
  const PlanResult result = planner->Plan(request, Scene(), nullptr);
  ExpectSolved(planar_, request, Scene(), result);
  ASSERT_FALSE(result.progress.empty());
  for (const PlanProgress& progress : result.progress) {
    EXPECT_TRUE(std::isfinite(progress.epsilon));
    EXPECT_TRUE(progress.epsilon == 0 || progress.epsilon >= 1) << progress.epsilon;
  }
}

TEST_P(PlannerContract, AnInitialPathIsImprovedOrRefused) {
  const std::unique_ptr<Planner> planner = Make(planar_);
  PlanRequest request = MakeRequest(planar_, left_, right_);
  const PlanResult found = planner->Plan(request, PostsScene(), nullptr);
  ASSERT_EQ(found.status, PlanStatus::kSolved) << found.message;
  request.initial_joint_names = {"shoulder", "elbow", "wrist"};
  request.initial_path = found.path;
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    request.direction = direction;
    const PlanResult result = planner->Plan(request, PostsScene(), nullptr);
    if (!planner->Describe().improve) {
      EXPECT_EQ(result.status, PlanStatus::kInvalidRequest);
      continue;
    }
    ExpectSolved(planar_, request, PostsScene(), result);
    const JointSpace& space = planar_.groups.front().space;
    EXPECT_LE(PathLength(space, result.path), PathLength(space, found.path) + 1e-9);
  }
}

}  // namespace planbench
