#include "planner_ara/two_way_search.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/numbers.h"
#include "support/planning_problems.h"
#include "tests/planner_ara/bound_of.h"
#include "tests/planner_ara/lattice_optimum.h"
#include "tests/planner_ara/point_goal.h"

namespace planbench {
namespace {

const auto kGoOn = [] { return false; };
const auto kSilent = [](double) {};

// The planar arm between its two posts.
class TwoWaySearchTest : public testing::Test {
 protected:
  TwoWaySearchTest() {
    checker_->SetScene(PostsScene(), std::vector<double>(4, 0.0));
    edges_ = std::make_unique<EdgeChecker>(checker_.get(), robot_.edge_resolution_m,
                                           EdgeCheck::kCertified);
    options_.discretization.assign(3, 0.3);
    options_.weights.assign(3, 1.0);
    options_.primitives.short_moves = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    options_.crowding = 0.1;
    options_.crowded_joints.assign(3, true);
  }

  // A scene of slots for the hand of the straight arm, walls 4 cm to either side of it: along x,
  // along y.
  void SetSlots(bool ahead, bool left) {
    Scene scene = EmptyPlanarScene();
    for (const double side : {-0.09, 0.09}) {
      if (ahead) AddBox(&scene, fmt::format("ahead {}", side), {1.0, side, 0}, {0.3, 0.02, 0.2});
      if (left) AddBox(&scene, fmt::format("left {}", side), {side, 1.0, 0}, {0.02, 0.3, 0.2});
    }
    checker_->SetScene(scene, std::vector<double>(4, 0.0));
  }

  double Optimum(const Configuration& start, const Configuration& goal,
                 const std::vector<Path>& recalled = {}) {
    return LatticeOptimum(edges_.get(), start, goal, options_, recalled);
  }

  void ExpectJoins(const Path& path, double cost) { ExpectJoins(kLeft_, kRight_, path, cost); }
  void ExpectJoins(const Configuration& start, const Configuration& goal, const Path& path,
                   double cost) {
    ASSERT_FALSE(path.empty());
    EXPECT_EQ(path.front(), start);
    EXPECT_EQ(path.back(), goal);
    double length = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
      EXPECT_TRUE(edges_->IsValidEdge(path[i - 1], path[i])) << i;
      length += edges_->space().Distance(path[i - 1], path[i]);
    }
    EXPECT_NEAR(length, cost, 1e-9);
  }

  const Configuration kLeft_ = {0.6, 0, 0};
  const Configuration kRight_ = {-0.65, 0.2, -0.1};  // on no lattice point of the other
  const Robot robot_ = LoadPlanarRobot();
  std::unique_ptr<CollisionChecker> checker_ =
      MakeCollisionChecker(robot_, robot_.groups.front(), CollisionModel::kSpheres);
  std::unique_ptr<EdgeChecker> edges_;
  ManipulationGraphOptions options_;
};

TEST_F(TwoWaySearchTest, BoundHoldsForBothLatticesAtEveryEpsilon) {
  const double forward = Optimum(kLeft_, kRight_);
  const double backward = Optimum(kRight_, kLeft_);
  ASSERT_TRUE(std::isfinite(forward));
  ASSERT_TRUE(std::isfinite(backward));
  struct Variant {
    double crowding;
    double tip_guide;
    double bridge_after = kInfinity;
    bool shorten = false;
  };
  for (const Variant& variant : {Variant{0, 0}, Variant{0.1, 0}, Variant{3, 0}, Variant{0.1, 5},
                                 Variant{0, 0, 1}, Variant{0.1, 5, 1}, Variant{3, 5, 500},
                                 Variant{0.1, 5, kInfinity, true}, Variant{0.1, 5, 1, true}}) {
    options_.crowding = variant.crowding;
    options_.bridge_after = variant.bridge_after;
    options_.shorten = variant.shorten;
    const Scene scene = PostsScene();
    TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
    if (variant.tip_guide > 0) {
      search.GuideByTip(scene, std::vector<double>(4, 0.0), variant.tip_guide);
    }
    double last_cost = kInfinity;
    double last_bound = kInfinity;
    for (const double epsilon : {50.0, 3.0, 1.5, 1.2, 1.0}) {
      ASSERT_EQ(search.Improve(epsilon, kGoOn, kSilent), ImproveOutcome::kConverged);
      const double bound = BoundOf(search);
      EXPECT_LE(bound, epsilon + 1e-12);
      EXPECT_GE(bound, 1);
      EXPECT_LE(bound, last_bound);
      EXPECT_LE(search.cost(), last_cost);
      EXPECT_LE(search.cost(), bound * std::min(forward, backward) + 1e-9);
      ExpectJoins(search.path(), search.cost());
      last_bound = bound;
      last_cost = search.cost();
    }
    EXPECT_LE(search.cost(), std::min(forward, backward) + 1e-9);
    const bool has_random_moves = variant.bridge_after == 1;
    if (variant.shorten || has_random_moves) continue;  // beyond the lattices
    EXPECT_NEAR(search.cost(), std::min(forward, backward), 1e-9);
  }
}

TEST_F(TwoWaySearchTest, BoundHoldsWithBurs) {
  options_.burs = true;
  options_.shorten = false;
  options_.discretization.assign(3, 0.2);
  TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, false);
  const double optimum = Optimum(kLeft_, kRight_);
  for (const double epsilon : {50.0, 1.5, 1.0}) {
    ASSERT_EQ(search.Improve(epsilon, kGoOn, kSilent), ImproveOutcome::kConverged);
    EXPECT_LE(search.cost(), BoundOf(search) * optimum + 1e-9);
    ExpectJoins(search.path(), search.cost());
  }
  EXPECT_NEAR(search.cost(), optimum, 1e-9);
}

TEST_F(TwoWaySearchTest, BoundHoldsWithRecalledPaths) {
  options_.shorten = false;
  // Straight through the posts, and two moves of a good path at a time, the short way.
  std::vector<Path> recalled = {{kLeft_, kRight_}, {}};
  TwoWaySearch before(edges_.get(), kLeft_, PointGoal(kRight_), options_, false);
  before.Improve(1, kGoOn, kSilent);
  for (std::size_t i = 0; i < before.path().size(); i += 2) {
    recalled.back().push_back(before.path()[i]);
  }
  const double forward = Optimum(kLeft_, kRight_, recalled);
  const double backward = Optimum(kRight_, kLeft_, recalled);
  EXPECT_LT(std::min(forward, backward),
            std::min(Optimum(kLeft_, kRight_), Optimum(kRight_, kLeft_)));
  for (const double tip_guide : {0.0, 5.0}) {
    const Scene scene = PostsScene();
    TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
    if (tip_guide > 0) search.GuideByTip(scene, std::vector<double>(4, 0.0), tip_guide);
    search.AddPaths(recalled);
    for (const double epsilon : {50.0, 1.5, 1.0}) {
      ASSERT_EQ(search.Improve(epsilon, kGoOn, kSilent), ImproveOutcome::kConverged);
      EXPECT_LE(search.cost(), BoundOf(search) * std::min(forward, backward) + 1e-9);
      ExpectJoins(search.path(), search.cost());
    }
    EXPECT_NEAR(search.cost(), std::min(forward, backward), 1e-9);
    EXPECT_GT(search.counts().recalled_edges, 0);
  }
}

TEST_F(TwoWaySearchTest, BoundHoldsWhereverItIsStoppedWithinAnEdge) {
  options_.shorten = false;
  const double straight = edges_->space().Distance(kLeft_, kRight_);
  struct Variant {
    Evaluation evaluation;
    bool burs;
    double bridge_after;
  };
  for (const Variant& variant :
       {Variant{Evaluation::kLazy, false, kInfinity}, Variant{Evaluation::kEager, false, kInfinity},
        Variant{Evaluation::kLazy, true, kInfinity}, Variant{Evaluation::kLazy, false, 500}}) {
    options_.evaluation = variant.evaluation;
    options_.burs = variant.burs;
    options_.bridge_after = variant.bridge_after;
    const double optimum = std::min(Optimum(kLeft_, kRight_), Optimum(kRight_, kLeft_));
    TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
    int num_stops = 0;
    for (const double epsilon : {50.0, 1.5, 1.0}) {
      for (ImproveOutcome outcome = ImproveOutcome::kStopped;
           outcome == ImproveOutcome::kStopped;) {
        int num_asked = 0;
        bool stopped = false;
        edges_->StopWhen([&] { return stopped = ++num_asked > 10 + num_stops; });
        outcome = search.Improve(
            epsilon, [&] { return stopped; }, kSilent);
        num_stops += stopped ? 1 : 0;
        const double lower_bound = search.ProveLowerBound();
        EXPECT_GE(lower_bound, straight - 1e-9);
        EXPECT_LE(lower_bound, optimum + 1e-9);
        edges_->StopWhen({});
      }
      EXPECT_LE(search.cost(), BoundOf(search) * optimum + 1e-9);
      ExpectJoins(search.path(), search.cost());
    }
    EXPECT_LE(search.cost(), optimum + 1e-9);
    EXPECT_GT(num_stops, 3);
  }
}

TEST_F(TwoWaySearchTest, TheStraightMotionIsAProofBeforeASearchHasBegun) {
  checker_->SetScene(EmptyPlanarScene(), std::vector<double>(4, 0.0));
  for (const bool two_way : {false, true}) {
    TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, two_way);
    EXPECT_NEAR(search.ProveLowerBound(), edges_->space().Distance(kLeft_, kRight_), 1e-9);
    int num_told = 0;
    ASSERT_EQ(search.Improve(1 + 1e-9, kGoOn,
                             [&](double lower_bound) {
                               ++num_told;
                               EXPECT_NEAR(lower_bound, search.cost(), 1e-9);
                             }),
              ImproveOutcome::kConverged);
    EXPECT_EQ(num_told, 1);
    EXPECT_EQ(search.counts().expansions, 1) << "the other direction has nothing to add";
    // Without wrapping nothing is proven.
    ManipulationGraphOptions options = options_;
    options.wrap_heuristic = false;
    EXPECT_EQ(
        TwoWaySearch(edges_.get(), kLeft_, PointGoal(kRight_), options, two_way).ProveLowerBound(),
        0);
  }
}

TEST_F(TwoWaySearchTest, ShortensAPathOnlyIfItIsNotGoodEnough) {
  TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
  ASSERT_EQ(search.Improve(50, kGoOn, kSilent), ImproveOutcome::kConverged);
  const double first = search.cost();
  options_.shorten = false;
  TwoWaySearch as_found(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
  as_found.Improve(50, kGoOn, kSilent);
  EXPECT_EQ(first, as_found.cost());

  std::vector<double> costs;
  search.Improve(BoundOf(search) - 1e-6, kGoOn, [&](double) { costs.push_back(search.cost()); });
  ASSERT_EQ(costs.size(), 1u);
  EXPECT_LT(costs.front(), first);
  EXPECT_EQ(search.counts().iterations, as_found.counts().iterations) << "the search went on";
  ExpectJoins(search.path(), search.cost());
}

TEST_F(TwoWaySearchTest, ShortensAPathOnceItMay) {
  TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
  ASSERT_EQ(search.Improve(50, kGoOn, kSilent), ImproveOutcome::kConverged);
  const double first = search.cost();
  const double epsilon = BoundOf(search) - 1e-6;
  ASSERT_EQ(search.Improve(
                epsilon, [] { return true; }, kSilent),
            ImproveOutcome::kStopped);
  EXPECT_EQ(search.cost(), first);
  const auto num_expansions = search.counts().expansions;
  ASSERT_EQ(search.Improve(epsilon, kGoOn, kSilent), ImproveOutcome::kConverged);
  EXPECT_LT(search.cost(), first);
  EXPECT_EQ(search.counts().expansions, num_expansions) << "by shortening alone";
}

TEST_F(TwoWaySearchTest, FirstPathIsFoundInTheSameWayWhateverTheEpsilon) {
  const auto first_cost = [&](double epsilon) {
    TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
    std::optional<double> cost;
    search.Improve(epsilon, kGoOn, [&](double) {
      if (!cost) cost = search.cost();
    });
    return cost;
  };
  ASSERT_TRUE(first_cost(100));
  EXPECT_EQ(first_cost(1.1), first_cost(100));
}

// Start and goal lie in slots that the arm has to draw its hand out of.
TEST_F(TwoWaySearchTest, ABridgeJoinsSearchesThatHaveLongFoundNothing) {
  SetSlots(true, true);
  const Configuration ahead = {0, 0, 0};
  const Configuration left = {kPi / 2, 0, 0};
  options_.discretization.assign(3, 0.03);
  options_.primitives.long_moves = {{8, 0, 0}, {0, 8, 0}, {0, 0, 8}};
  options_.bridge_after = 2000;
  TwoWaySearch search(edges_.get(), ahead, PointGoal(left), options_, true);
  ASSERT_EQ(search.Improve(50, kGoOn, kSilent), ImproveOutcome::kConverged);
  EXPECT_TRUE(search.is_bridged());
  ExpectJoins(ahead, left, search.path(), search.cost());
  EXPECT_LT(BoundOf(search), kInfinity);
}

TEST_F(TwoWaySearchTest, RandomMovesLeadOnWhereBridgesDoNot) {
  // Without the elbow, which no primitive bends, there is no way round the posts.
  options_.discretization.assign(3, 0.05);
  options_.primitives = {{{1, 0, 0}, {0, 0, 1}}, {}};
  options_.refine = false;
  const auto outcome = [&](double bridge_after) {
    options_.bridge_after = bridge_after;
    TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
    const ImproveOutcome outcome = search.Improve(50, kGoOn, kSilent);
    if (outcome == ImproveOutcome::kConverged) ExpectJoins(search.path(), search.cost());
    return outcome;
  };
  EXPECT_EQ(outcome(kInfinity), ImproveOutcome::kExhausted);
  EXPECT_EQ(outcome(1), ImproveOutcome::kConverged);
}

TEST_F(TwoWaySearchTest, TheSearchOutOfTheNarrowerPlaceDoesMostOfTheWork) {
  SetSlots(true, false);
  const Configuration narrow = {0, 0, 0};
  const Configuration wide = {kPi / 2, 0, 0};
  options_.discretization.assign(3, 0.05);
  options_.bridge_after = kInfinity;
  const auto find = [&](const Configuration& start, const Configuration& goal, bool two_way) {
    TwoWaySearch search(edges_.get(), start, PointGoal(goal), options_, two_way);
    EXPECT_EQ(search.Improve(50, kGoOn, kSilent), ImproveOutcome::kConverged);
    EXPECT_EQ(search.found_backward(), two_way && start == wide);
    return search.counts().expansions;
  };
  const auto alone = static_cast<double>(find(narrow, wide, false));
  EXPECT_LT(find(narrow, wide, true), 1.5 * alone);
  EXPECT_LT(find(wide, narrow, true), 1.5 * alone);
}

// A post beside the column, which the upper arm cannot pass, is on the short way.
TEST_F(TwoWaySearchTest, IsGuidedRoundWhatAContinuousJointCannotPass) {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "post", {-0.3, 0, 0}, {0.05, 0.05, 0.2});
  checker_->SetScene(scene, std::vector<double>(4, 0.0));
  const Configuration start = {2.5, 0.1, 0};
  const Configuration goal = {-2.5, 0, -0.1};
  options_.discretization.assign(3, 0.05);
  for (const bool two_way : {false, true}) {
    TwoWaySearch search(edges_.get(), start, PointGoal(goal), options_, two_way);
    ASSERT_EQ(search.Improve(50, kGoOn, kSilent), ImproveOutcome::kConverged);
    EXPECT_LT(search.counts().expansions, 1000) << two_way;
    ExpectJoins(start, goal, search.path(), search.cost());
    // The bound is of the wrapped heuristic still: the start's, to the goal across the post.
    EXPECT_GE(search.ProveLowerBound(), edges_->space().Distance(start, goal) - 1e-9);
    EXPECT_LT(search.ProveLowerBound(), search.cost());
  }
}

TEST_F(TwoWaySearchTest, OneWayKnowsItsOwnLatticeOnly) {
  options_.shorten = false;
  TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, false);
  ASSERT_EQ(search.Improve(1, kGoOn, kSilent), ImproveOutcome::kConverged);
  EXPECT_NEAR(search.cost(), Optimum(kLeft_, kRight_), 1e-9);
  EXPECT_FALSE(search.found_backward());
}

TEST_F(TwoWaySearchTest, SaysEachBetterPathOnce) {
  TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
  std::vector<double> costs;
  const auto note = [&](double lower_bound) {
    costs.push_back(search.cost());
    EXPECT_EQ(lower_bound, search.ProveLowerBound());
  };
  for (const double epsilon : {50.0, 2.0, 1.0}) search.Improve(epsilon, kGoOn, note);
  ASSERT_FALSE(costs.empty());
  for (std::size_t i = 1; i < costs.size(); ++i) EXPECT_LT(costs[i], costs[i - 1]);
  EXPECT_EQ(costs.back(), search.cost());
}

TEST_F(TwoWaySearchTest, WhatIsKnownFromElsewhereEndsTheSearchOfDearerPaths) {
  options_.shorten = false;
  const double optimum = std::min(Optimum(kLeft_, kRight_), Optimum(kRight_, kLeft_));
  const std::vector<std::pair<double, int>> variants = {{0, 0}, {0, 10}, {0.1, 0}, {0.1, 10}};
  for (const auto& [crowding, num_before] : variants) {
    options_.crowding = crowding;
    for (const double factor : {0.8, 1.2}) {
      SCOPED_TRACE(fmt::format("crowding {}, {} times the optimum, known after {} steps", crowding,
                               factor, num_before));
      TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
      if (int budget = num_before; budget > 0) {
        ASSERT_EQ(search.Improve(
                      50, [&] { return budget-- == 0; }, kSilent),
                  ImproveOutcome::kStopped);
      }
      search.SetKnownCost(factor * optimum);
      for (const double epsilon : {50.0, 1.5, 1.0}) {
        ASSERT_EQ(search.Improve(epsilon, kGoOn, kSilent), ImproveOutcome::kConverged);
        EXPECT_LE(BoundOf(search), epsilon + 1e-12);
        EXPECT_LE(search.ProveLowerBound(), optimum + 1e-9);
      }
      EXPECT_NEAR(search.best_cost(), std::min(1.0, factor) * optimum, 1e-9);
      EXPECT_EQ(search.path().empty(), factor < 1);
    }
  }
}

// Of 50 times the optimum what is known from elsewhere needs no search to be proven.
TEST_F(TwoWaySearchTest, NoPathIsLookedForWhereTheKnownOneIsGoodEnough) {
  const double optimum = std::min(Optimum(kLeft_, kRight_), Optimum(kRight_, kLeft_));
  const Scene scene = PostsScene();
  options_.bridge_after = 1;
  TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
  search.GuideByTip(scene, std::vector<double>(4, 0.0), 5);
  search.SetKnownCost(0.8 * optimum);
  ASSERT_EQ(search.Improve(50, kGoOn, kSilent), ImproveOutcome::kConverged);
  EXPECT_LE(BoundOf(search), 50 + 1e-12);
  EXPECT_EQ(search.counts().expansions, 2) << "of the roots alone";
}

TEST_F(TwoWaySearchTest, IsExhaustedWhenBothLatticesAre) {
  checker_->SetScene(WallsScene(), std::vector<double>(4, 0.0));
  const Configuration left = {1.57, 0, 0};
  const Configuration right = {-1.57, 0, 0};
  TwoWaySearch search(edges_.get(), left, PointGoal(right), options_, true);
  EXPECT_EQ(search.Improve(50, kGoOn, kSilent), ImproveOutcome::kExhausted);
  EXPECT_TRUE(search.path().empty());
  EXPECT_EQ(BoundOf(search), kInfinity);
}

TEST_F(TwoWaySearchTest, GoesOnWithFinerMovesWhereTheLatticeHoldsNoPath) {
  options_.discretization.assign(3, 0.1);
  // The arm has to bend, but the elbow's limits leave no room for 3 rad.
  options_.primitives = {{{9, 0, 0}, {0, 30, 0}, {0, 0, 9}}, {}};
  for (const bool two_way : {false, true}) {
    options_.refine = false;
    TwoWaySearch coarse(edges_.get(), kLeft_, PointGoal(kRight_), options_, two_way);
    ASSERT_EQ(coarse.Improve(50, kGoOn, kSilent), ImproveOutcome::kExhausted);
    options_.refine = true;
    TwoWaySearch search(edges_.get(), kLeft_, PointGoal(kRight_), options_, two_way);
    ASSERT_EQ(search.Improve(50, kGoOn, kSilent), ImproveOutcome::kConverged);
    ExpectJoins(search.path(), search.cost());
    EXPECT_GT(search.counts().expansions, coarse.counts().expansions);
    EXPECT_LT(BoundOf(search), kInfinity);
  }
}

TEST_F(TwoWaySearchTest, GoesOnWhereItWasStopped) {
  TwoWaySearch at_once(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
  TwoWaySearch in_steps(edges_.get(), kLeft_, PointGoal(kRight_), options_, true);
  ASSERT_EQ(at_once.Improve(50, kGoOn, kSilent), ImproveOutcome::kConverged);
  int num_stops = 0;
  for (int budget = 20;; budget = 20, ++num_stops) {
    const ImproveOutcome outcome = in_steps.Improve(
        50, [&] { return budget-- == 0; }, kSilent);
    if (outcome != ImproveOutcome::kStopped) break;
  }
  EXPECT_GT(num_stops, 0);
  EXPECT_EQ(in_steps.path(), at_once.path());
}

}  // namespace
}  // namespace planbench
