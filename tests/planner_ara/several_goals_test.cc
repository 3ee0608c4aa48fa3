#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "common/numbers.h"
#include "common/read_text.h"
#include "planner_ara/ara_planner.h"
#include "support/planning_problems.h"
#include "tests/planner_ara/lattice_optimum.h"

namespace planbench {
namespace {

/// The planar arm between its two posts, and goals on either side of them.
class AraSeveralGoalsTest : public testing::Test {
 protected:
  AraSeveralGoalsTest() { checker_->SetScene(scene_, std::vector<double>(4, 0.0)); }

  PlanRequest RequestFor(const std::vector<Configuration>& goals) const {
    PlanRequest request = MakeRequest(robot_, start_, goals.front());
    for (std::size_t i = 1; i < goals.size(); ++i) {
      const PlanRequest other = MakeRequest(robot_, start_, goals[i]);
      request.goal.insert(request.goal.end(), other.goal.begin(), other.goal.end());
    }
    request.anytime = true;
    request.simplify = false;
    request.time_limit_s = 600;
    return request;
  }

  /// Cost of the best path to any of the goals, over the lattices that are searched.
  double Optimum(const std::string& settings, Direction direction,
                 const std::vector<Configuration>& goals) {
    AraSettings ara;
    ara.Apply(YamlNode::Parse(settings, "ara.yaml"));
    const ManipulationGraphOptions options = ResolveOptions(
        ara, {ara.primitives, ReadText(ara.primitives)}, robot_, robot_.groups.front(), "ara.yaml");
    EdgeChecker edges(checker_.get(), robot_.edge_resolution_m, robot_.edge_check);
    double optimum = kInfinity;
    for (const Configuration& goal : goals) {
      if (ara.two_way || direction == Direction::kForward) {
        optimum = std::min(optimum, LatticeOptimum(&edges, start_, goal, options));
      }
      if (ara.two_way || direction == Direction::kBackward) {
        optimum = std::min(optimum, LatticeOptimum(&edges, goal, start_, options));
      }
    }
    return optimum;
  }

  PlanResult Plan(const std::string& settings, const PlanRequest& request) const {
    return MakeAraPlanner(robot_, YamlNode::Parse(settings, "ara.yaml"))
        ->Plan(request, scene_, nullptr);
  }

  const Configuration start_ = {0.6, 0, 0};
  Scene scene_ = PostsScene();
  const Robot robot_ = LoadPlanarRobot();
  std::unique_ptr<CollisionChecker> checker_ =
      MakeCollisionChecker(robot_, robot_.groups.front(), CollisionModel::kSpheres);
  const std::string lattice_ = "primitives: " PLANBENCH_SOURCE_DIR
                               "/tests/planner_ara/data/planar3.mprim\n"
                               "discretization: {shoulder: 0.3, elbow: 0.3, wrist: 0.3}\n"
                               "short_primitives_within: everywhere\n"
                               "shorten: false\n"
                               "epsilon_initial: 10\n"
                               "epsilon_decrement: 1\n";
};

TEST_F(AraSeveralGoalsTest, BoundsHoldForAllOfThem) {
  // The nearest is behind a post; the way to the other is free, or longer.
  const std::vector<std::vector<Configuration>> sets = {{{-0.6, 0, 0}, {2.4, 0, 0}},
                                                        {{-2.5, 0, 0}, {-0.6, 0, 0}}};
  struct Variant {
    std::string settings;
    Direction direction = Direction::kForward;
  };
  const std::vector<Variant> variants = {{""},
                                         {"", Direction::kBackward},
                                         {"two_way: false\n"},
                                         {"two_way: false\n", Direction::kBackward},
                                         {"tip_guide: 0\ncrowding: 0\n"},
                                         {"cost: uniform\n"},
                                         {"joint_weights: {elbow: 3}\n"}};
  int num_elsewhere = 0;
  for (const Variant& variant : variants) {
    const std::string settings = lattice_ + variant.settings;
    for (const std::vector<Configuration>& goals : sets) {
      SCOPED_TRACE(fmt::format("{}, {}, goals from {}", variant.settings,
                               EnumName(variant.direction), goals.front().front()));
      const double optimum = Optimum(settings, variant.direction, goals);
      ASSERT_LT(optimum, kInfinity);
      PlanRequest request = RequestFor(goals);
      request.direction = variant.direction;
      const PlanResult best = Plan(settings, request);
      ASSERT_EQ(best.status, PlanStatus::kSolved) << best.message;
      EXPECT_EQ(best.epsilon, 1);
      EXPECT_NEAR(best.cost, optimum, 1e-9);
      ASSERT_FALSE(best.progress.empty());
      for (std::size_t i = 0; i < best.progress.size(); ++i) {
        const PlanProgress& progress = best.progress[i];
        EXPECT_GE(progress.epsilon, 1);
        EXPECT_LE(progress.cost, progress.epsilon * optimum + 1e-9);
        if (i == 0) continue;
        EXPECT_LE(progress.cost, best.progress[i - 1].cost);
        EXPECT_LE(progress.epsilon, best.progress[i - 1].epsilon);
      }
      EXPECT_EQ(best.progress.back().epsilon, 1);
      EXPECT_EQ(best.progress.back().cost, best.cost);
      EXPECT_LE(best.counters.at("found_backward"), 1) << "no sum";

      request.anytime = false;
      const PlanResult first = Plan(settings, request);
      ASSERT_EQ(first.status, PlanStatus::kSolved) << first.message;
      EXPECT_LE(first.epsilon, 10 + 1e-9);
      EXPECT_LE(first.cost, first.epsilon * optimum + 1e-9);
      num_elsewhere += first.path.back() != best.path.back() ? 1 : 0;

      request.parameters["epsilon_initial"] = "1.2";
      const PlanResult good = Plan(settings, request);
      EXPECT_LE(good.epsilon, 1.2 + 1e-9);
      EXPECT_LE(good.cost, good.epsilon * optimum + 1e-9);
    }
  }
  EXPECT_GT(num_elsewhere, 0) << "the goals put the bounds to the test";
}

TEST_F(AraSeveralGoalsTest, FirstSolutionsAreThoseOfTheGoalAlone) {
  const Configuration near = {-0.6, 0, 0};
  PlanRequest both = RequestFor({{2.4, 0, 0}, near});
  PlanRequest alone = RequestFor({near});
  both.anytime = alone.anytime = false;
  const PlanResult of_both = Plan(lattice_, both);
  const PlanResult of_one = Plan(lattice_, alone);
  EXPECT_EQ(of_both.path, of_one.path);
  EXPECT_EQ(of_both.counters.at("expansions"), of_one.counters.at("expansions"));
  EXPECT_GE(of_both.epsilon, of_one.epsilon - 1e-9);
}

/// The nearest three goals are behind walls that no configuration crosses; the way to the last
/// leads past a post, which a search without guide finds late.
class WalledInGoalsTest : public AraSeveralGoalsTest {
 protected:
  WalledInGoalsTest() {
    scene_ = WallsScene();
    AddBox(&scene_, "post", {0, 0.9, 0}, {0.1, 0.1, 0.2});
  }

  PlanResult PlanFor(const std::vector<Configuration>& goals, const std::string& more = "") const {
    PlanRequest request = RequestFor(goals);
    request.anytime = false;
    return Plan("primitives: " PLANBENCH_SOURCE_DIR
                "/tests/planner_ara/data/planar3.mprim\n"
                "discretization: {shoulder: 0.08, elbow: 0.08, wrist: 0.08}\n"
                "short_primitives_within: everywhere\n"
                "two_way: false\n"
                "tip_guide: 0\n"
                "crowding: 0\n"
                "refine: false\n" +
                    more,
                request);
  }

  const Configuration free_ = {2.4, 0, 0};
  const std::vector<Configuration> all_ = {{-0.3, 0, 0}, {-0.4, 0, 0}, {-0.5, 0, 0}, free_};
};

TEST_F(WalledInGoalsTest, DoNotHoldUpTheWayToAnother) {
  const PlanResult alone = PlanFor({free_});
  const PlanResult of_all = PlanFor(all_);
  ASSERT_EQ(of_all.status, PlanStatus::kSolved) << of_all.message;
  EXPECT_EQ(of_all.path, alone.path) << "what a turn has interrupted goes on as if it had not";
  // Each of the others has had as many rounds: with the last of them twice the work, and that of
  // the first turn. An edge generated is a step at most.
  const double configurations = alone.counters.at("configurations_checked");
  const double work = configurations + 10 * alone.counters.at("edges_generated");
  EXPECT_GT(configurations, 100'000) << "more than a turn";
  EXPECT_GT(of_all.counters.at("configurations_checked"), 2 * configurations);
  EXPECT_LT(of_all.counters.at("configurations_checked"),
            configurations + 3 * (2 * work + 110'000));
}

TEST_F(WalledInGoalsTest, DoNotTakeItsMemory) {
  const PlanResult alone = PlanFor({free_}, "memory_limit_mb: 1.5\n");
  ASSERT_EQ(alone.status, PlanStatus::kSolved) << alone.message;
  EXPECT_EQ(PlanFor({all_.front()}, "memory_limit_mb: 1.5\n").status, PlanStatus::kMemoryLimit);
  const PlanResult of_all = PlanFor(all_, "memory_limit_mb: 1.5\n");
  ASSERT_EQ(of_all.status, PlanStatus::kSolved) << of_all.message;
  EXPECT_EQ(of_all.path, alone.path);
  // A search that begins anew has twice the work of its last turn: however often that is, little is
  // done again.
  const double work =
      alone.counters.at("configurations_checked") + 10 * alone.counters.at("edges_generated");
  EXPECT_LT(of_all.counters.at("configurations_checked"), 4 * (4 * work + 110'000));
}

TEST_F(AraSeveralGoalsTest, WithoutProofTheOthersAreTriedAllTheSame) {
  PlanRequest request = RequestFor({{-0.6, 0, 0}, {2.4, 0, 0}});
  const PlanResult best = Plan(lattice_ + "wrap_heuristic: false\n", request);
  ASSERT_EQ(best.status, PlanStatus::kSolved) << best.message;
  EXPECT_EQ(best.epsilon, 0);
  EXPECT_EQ(best.path.back(), (Configuration{2.4, 0, 0}));
}

}  // namespace
}  // namespace planbench
