#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <random>

#include "collision/collision_checker.h"
#include "planning/path_judge.h"
#include "planning/planner.h"
#include "planning/resolve.h"
#include "tests/robot_model/random_configuration.h"
#include "tests/support/planning_problems.h"
#include "tests/support/random_robot.h"

namespace planbench {

/// Expects a planner to solve a request for each of 13 random robots, of 2 to 14 joints, with paths
/// that the exact engine finds free. Start and goal are free and some 1 rad apart in every joint;
/// boxes stand about the robot.
inline void ExpectPlansForRandomRobots(
    const std::function<std::unique_ptr<Planner>(const Robot&)>& make) {
  for (int joints = 2; joints <= 14; ++joints) {
    SCOPED_TRACE(joints);
    const Robot robot = MakeRandomRobot(joints, 2);
    const PlanningGroup& group = robot.groups.front();
    Scene scene;
    scene.world_frame = "world";
    for (const double x : {-0.8, 0.8}) {
      AddBox(&scene, x < 0 ? "behind" : "ahead", {x, 0.6, 0.3}, {0.3, 0.3, 0.3});
    }
    const auto checker = MakeReferenceChecker(robot, group, CollisionModel::kSpheres);
    checker->SetScene(scene, robot.model.DefaultPositions());
    std::mt19937 random(static_cast<unsigned>(joints));
    Configuration start;
    Configuration goal;
    do {
      start = RandomConfiguration(group.space, &random);
      goal = start;
      for (int j = 0; j < group.space.size(); ++j) {
        const JointSpace::Joint& joint = group.space.joint(j);
        double& q = goal[static_cast<std::size_t>(j)];
        q = std::clamp(q + std::uniform_real_distribution<double>(-1, 1)(random), joint.lower,
                       joint.upper);
      }
    } while (!checker->IsFree(start) || !checker->IsFree(goal));
    const PlanRequest request = MakeRequest(robot, start, goal);
    const PlanResult result = make(robot)->Plan(request, scene, nullptr);
    ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
    const ResolvedQuery query = ResolveQuery(robot, group, request.start, request.goal, "query");
    for (const Path& path : {result.path, result.simplified_path}) {
      const PathVerdict verdict = JudgePath(checker.get(), path, query.start, query.goals,
                                            robot.edge_resolution_m / 4, false);
      EXPECT_TRUE(verdict.valid) << verdict.reason;
    }
  }
}

}  // namespace planbench
