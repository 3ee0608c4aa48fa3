#include <gtest/gtest.h>

#include <memory>

#include "planner_ara/ara_planner.h"
#include "planner_ara/two_way_search.h"
#include "support/planning_problems.h"
#include "support/two_arm_robot.h"
#include "tests/planner_ara/bound_of.h"
#include "tests/planner_ara/is_free.h"
#include "tests/planner_ara/lattice_optimum.h"

namespace planbench {
namespace {

// A post on each side, which the arm has to fold to get past.
Scene PostsOnBothSides() {
  Scene scene;
  scene.world_frame = "base";
  AddBox(&scene, "left_post", {0.54, 0.72, 0}, {0.1, 0.1, 0.2});
  AddBox(&scene, "right_post", {0.54, -0.72, 0}, {0.1, 0.1, 0.2});
  return scene;
}

class ArmByArmTest : public testing::Test {
 protected:
  ArmByArmTest() {
    checker_->SetScene(PostsOnBothSides(), robot_.model.DefaultPositions());
    edges_ = std::make_unique<EdgeChecker>(checker_.get(), robot_.edge_resolution_m,
                                           EdgeCheck::kCertified);
    options_.discretization.assign(4, 0.5);
    options_.weights.assign(4, 1.0);
    options_.primitives.long_moves = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    options_.crowding = 0.05;
    options_.crowded_joints.assign(4, true);
    options_.arm_by_arm = true;
    options_.shorten = false;
  }

  const Robot robot_ = MakeTwoArmRobot();
  std::unique_ptr<CollisionChecker> checker_ =
      MakeCollisionChecker(robot_, robot_.groups.front(), CollisionModel::kSpheres);
  std::unique_ptr<EdgeChecker> edges_;
  ManipulationGraphOptions options_;
  // The goal is on no point of the lattice.
  const Configuration start_ = {1.25, 0, -1.25, 0};
  const Configuration goal_ = {0.05, 0.1, -0.1, -0.05};
};

TEST_F(ArmByArmTest, EachArmHasTheMoveToWhereItStandsAtTheGoal) {
  ManipulationGraph graph(edges_.get(), start_, PointGoal(goal_), options_);
  options_.arm_by_arm = false;
  ManipulationGraph as_one(edges_.get(), start_, PointGoal(goal_), options_);
  std::vector<CandidateEdge> candidates, fewer;
  graph.CandidateEdges(ManipulationGraph::kStart, &candidates);
  as_one.CandidateEdges(ManipulationGraph::kStart, &fewer);
  ASSERT_EQ(candidates.size(), fewer.size() + 2);
  StateId left_there = 0;
  for (const std::size_t arm : {0, 1}) {
    const CandidateEdge& edge = candidates[1 + arm];
    const StateId target = graph.Target(ManipulationGraph::kStart, edge.action);
    Configuration q(4);
    graph.ConfigurationOf(target, q);
    for (std::size_t j = 0; j < 4; ++j) {
      if (j / 2 == arm) {
        EXPECT_NEAR(q[j], goal_[j], 0.25);
      } else {
        EXPECT_EQ(q[j], start_[j]);
      }
    }
    EXPECT_NEAR(edge.cost, edges_->space().Distance(start_, q), 1e-12);
    EXPECT_EQ(edge.target_heuristic, graph.Heuristic(target));
    EXPECT_EQ(IsFree(graph, ManipulationGraph::kStart, edge.action),
              edges_->IsValidEdge(start_, q));
    if (arm == 0) left_there = target;
  }
  // Once there it has no further to go.
  std::vector<CandidateEdge> later;
  graph.CandidateEdges(left_there, &later);
  ASSERT_GT(later.size(), 1u);
  const StateId both = graph.Target(left_there, later[1].action);
  Configuration q(4);
  graph.ConfigurationOf(both, q);
  for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(q[j], goal_[j], 0.25);
}

TEST_F(ArmByArmTest, BoundHolds) {
  const double optimum = std::min(LatticeOptimum(edges_.get(), start_, goal_, options_),
                                  LatticeOptimum(edges_.get(), goal_, start_, options_));
  ASSERT_LT(optimum, kInfinity);
  for (const double tip_guide : {0.0, 3.0}) {
    const Scene scene = PostsOnBothSides();
    const std::vector<double> positions = robot_.model.DefaultPositions();
    TwoWaySearch search(edges_.get(), start_, PointGoal(goal_), options_, true);
    if (tip_guide > 0) search.GuideByTip(scene, positions, tip_guide);
    for (const double epsilon : {50.0, 1.5, 1.0}) {
      ASSERT_EQ(search.Improve(
                    epsilon, [] { return false; }, [](double) {}),
                ImproveOutcome::kConverged);
      EXPECT_LE(search.cost(), BoundOf(search) * optimum + 1e-9);
    }
    EXPECT_NEAR(search.cost(), optimum, 1e-9);
  }
}

TEST_F(ArmByArmTest, TwoNarrowPlacesAreAsHardAsOneAfterTheOther) {
  const auto expansions = [&](const Configuration& start, const Configuration& goal,
                              const std::string& settings) {
    const auto planner = MakeAraPlanner(robot_, YamlNode::Parse(settings, "test"));
    const PlanResult result =
        planner->Plan(MakeRequest(robot_, start, goal), PostsOnBothSides(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
    return result.counters.at("expansions");
  };
  const Configuration left_only = {goal_[0], goal_[1], start_[2], start_[3]};
  const Configuration right_only = {start_[0], start_[1], goal_[2], goal_[3]};
  const double apart = expansions(start_, left_only, "") + expansions(start_, right_only, "");
  const double together = expansions(start_, goal_, "");
  EXPECT_LT(together, 1.2 * apart);
  EXPECT_LT(together, expansions(start_, goal_, "arm_by_arm: false"));
}

TEST_F(ArmByArmTest, ATorsoMovesWithBoth) {
  const Robot robot = MakeTwoArmRobot(/*with_torso=*/true);
  const auto planner = MakeAraPlanner(robot, YamlNode::Parse("", "test"));
  const Configuration start = {0.1, 1.25, 0, -1.25, 0};
  const Configuration goal = {-0.1, 0.05, 0.1, -0.1, -0.05};
  const PlanResult result =
      planner->Plan(MakeRequest(robot, start, goal), PostsOnBothSides(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
}

}  // namespace
}  // namespace planbench
