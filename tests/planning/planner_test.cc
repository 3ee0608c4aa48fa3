#include "planning/planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

#include "common/error.h"
#include "tests/planning/scripted_planner_test.h"

namespace planbench {
namespace {

using testing::HasSubstr;

SearchResult Solved(Path path) {
  SearchResult result;
  result.status = PlanStatus::kSolved;
  result.path = std::move(path);
  return result;
}

/// Through a point that both ends are free of.
SearchResult ByWayOf(SearchQuery& query) {
  return Solved({query.start(), {0.5, 2.0, 1.0}, query.goal().nominal});
}

using PlannerTest = ScriptedPlannerTest;

TEST_F(PlannerTest, ForwardSearchesFromStartToGoal) {
  const PlanResult result = Plan(
      [&](SearchQuery& query) {
        EXPECT_EQ(query.start(), start_);
        EXPECT_EQ(query.goal().nominal, goal_);
        EXPECT_NEAR(query.goal().lower[1], -0.1, 1e-12);
        EXPECT_EQ(query.seed(), 1u);
        EXPECT_FALSE(query.anytime());
        return ByWayOf(query);
      },
      Request(0.1));
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_EQ(result.path, (Path{start_, {0.5, 2.0, 1.0}, goal_}));
  EXPECT_EQ(result.simplified_path, (Path{start_, goal_}));
}

TEST_F(PlannerTest, BackwardSearchesFromTheNominalGoalToTheStartPoint) {
  PlanRequest request = Request(0.1);
  request.direction = Direction::kBackward;
  const PlanResult result = Plan(
      [&](SearchQuery& query) {
        EXPECT_EQ(query.start(), goal_);
        EXPECT_EQ(query.goal().nominal, start_);
        EXPECT_EQ(query.goal().lower, start_);
        EXPECT_EQ(query.goal().upper, start_);
        return ByWayOf(query);
      },
      request);
  EXPECT_EQ(result.path, (Path{start_, {0.5, 2.0, 1.0}, goal_}));
}

TEST_F(PlannerTest, AnInitialPathRunsFromWhereTheSearchBegins) {
  const Path path = {start_, {0.5, 2.0, 1.0}, {-0.55, 0.05, 0}};
  PlannerDescription able = ScriptedPlanner::Able();
  able.improve = true;
  ScriptedPlanner planner(
      robot_,
      [](SearchQuery& query) {
        EXPECT_EQ(query.initial_path().front(), query.start());
        EXPECT_TRUE(query.goal().Contains(query.space(), query.initial_path().back()));
        return Solved(query.initial_path());
      },
      able);
  PlanRequest request = Request(0.1);
  request.initial_joint_names = {"wrist", "shoulder", "elbow"};
  for (const Configuration& q : path) request.initial_path.push_back({q[2], q[0], q[1]});
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    request.direction = direction;
    const PlanResult result = planner.Plan(request, EmptyPlanarScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
    EXPECT_EQ(result.path, path);
  }
}

TEST_F(PlannerTest, EndsGetTheirExactValues) {
  PlanRequest request = Request();
  request.start.positions[0] += 2 * M_PI;
  const Configuration start = request.start.positions;
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    request.direction = direction;
    const PlanResult result = Plan(
        [](SearchQuery& query) {
          Path path = {query.start(), query.goal().nominal};
          for (Configuration& q : path) query.space().Wrap(q);
          return Solved(path);
        },
        request);
    EXPECT_EQ(result.path, (Path{start, goal_}));
  }
}

TEST_F(PlannerTest, SimplificationIsTimedApartAndOnlyWhenAskedFor) {
  PlanRequest request = Request();
  request.simplify = false;
  const PlanResult plain = Plan(ByWayOf, request);
  EXPECT_TRUE(plain.simplified_path.empty());
  EXPECT_EQ(plain.phases.simplification_s, 0);
  const PlanResult simplified = Plan(ByWayOf, Request());
  EXPECT_GT(simplified.phases.simplification_s, 0);
  EXPECT_EQ(simplified.counters, plain.counters) << "simplification is no part of the counts";
}

TEST_F(PlannerTest, SimplificationDoesNotDependOnTheSeed) {
  const Path around_post = {start_,          {0.9, 0.5, 0.3},  {0.7, 1.3, 1.0},
                            {0.6, 2.0, 1.5}, {-0.3, 2.1, 1.2}, {-1.0, 2.0, 1.5},
                            {-1.1, 1.0, 0},  {-0.9, 0.2, 0.2}, goal_};
  PlanRequest request = Request();
  const auto simplified = [&](std::uint64_t seed) {
    request.seed = seed;
    return Plan([&](SearchQuery&) { return Solved(around_post); }, request, PostsScene())
        .simplified_path;
  };
  const Path one = simplified(1);
  EXPECT_GT(one.size(), 2u);
  EXPECT_NE(one, around_post);
  for (const std::uint64_t seed : {2, 3, 4}) EXPECT_EQ(simplified(seed), one);
}

TEST_F(PlannerTest, ThePeakIsTheRequestsOwn) {
  const auto with_memory = [](std::size_t mib) {
    return [mib](SearchQuery& query) {
      std::vector<char> block(mib << 20, 1);
      // Keeps the optimiser from leaving the block out.
      asm volatile("" : : "g"(block.data()) : "memory");
      return StraightLine(query);
    };
  };
  const double small = Plan(with_memory(1), Request()).peak_memory_mb;
  const double large = Plan(with_memory(200), Request()).peak_memory_mb;
  EXPECT_GT(large, small + 150);
  const double small_again = Plan(with_memory(1), Request()).peak_memory_mb;
  if (small_again > large - 1) GTEST_SKIP() << "the kernel does not let the peak be reset";
  EXPECT_LT(small_again, small + 50);
}

TEST_F(PlannerTest, AnytimeIsForPlannersThatAre) {
  ScriptedPlanner planner(robot_, [](SearchQuery& query) {
    EXPECT_FALSE(query.anytime());
    return StraightLine(query);
  });
  planner.description.anytime = false;
  PlanRequest request = Request();
  request.anytime = true;
  EXPECT_EQ(planner.Plan(request, EmptyPlanarScene(), nullptr).status, PlanStatus::kSolved);
}

TEST_F(PlannerTest, NothingIsCompiledInARequestThatWasBefore) {
  const std::vector<CollisionModel> models = {CollisionModel::kSpheres, CollisionModel::kVoxels};
  ScriptedPlanner planner(robot_, StraightLine);
  planner.description.collision_models = models;
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(planner.WarmUp().empty());
    EXPECT_EQ(planner.num_compilations(), 2);
  }
  PlanRequest request = Request();
  const auto plan = [&](const Scene& scene) {
    for (const CollisionModel model : models) {
      request.collision_model = model;
      EXPECT_EQ(planner.Plan(request, scene, nullptr).status, PlanStatus::kSolved);
    }
    return planner.num_compilations();
  };
  EXPECT_EQ(plan(EmptyPlanarScene()), 2) << "what was compiled at warming up serves";
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "far", {3, 0, 0}, {0.1, 0.1, 0.1});
  EXPECT_EQ(plan(scene), 2) << "objects come with every request";
  request.start.names.push_back("lift");
  request.start.positions.push_back(0.3);
  EXPECT_EQ(plan(scene), 4) << "a joint is held elsewhere";
  EXPECT_EQ(plan(scene), 4);
  scene.attached = {{"hand", {"mug", Eigen::Isometry3d::Identity(), {}}, {"forearm"}}};
  scene.attached.front().object.shapes = {{Cylinder{0.02, 0.05}}};
  EXPECT_EQ(plan(scene), 6) << "something is held";
  EXPECT_EQ(plan(scene), 6);
}

TEST_F(PlannerTest, ModelsThatCannotBeUsedAreNamedWithTheReason) {
  Robot bare = LoadPlanarRobot();
  bare.spheres.clear();
  ScriptedPlanner planner(bare, StraightLine);
  const std::map<CollisionModel, std::string> unusable = planner.WarmUp();
  ASSERT_TRUE(unusable.contains(CollisionModel::kSpheres));
  EXPECT_THAT(unusable.at(CollisionModel::kSpheres), HasSubstr("spheres"));
}

TEST_F(PlannerTest, ModelsThatNobodyWillAskForAreNotCompiled) {
  ScriptedPlanner planner(robot_, StraightLine);
  planner.description.collision_models = {CollisionModel::kSpheres, CollisionModel::kVoxels};
  const std::map<CollisionModel, std::string> unusable =
      planner.WarmUp({CollisionModel::kMeshes, CollisionModel::kVoxels});
  EXPECT_EQ(planner.num_compilations(), 1);
  ASSERT_EQ(unusable.size(), 1u);
  EXPECT_THAT(unusable.at(CollisionModel::kSpheres), HasSubstr("--collision-models"));
}

TEST_F(PlannerTest, VerdictsOfTheSearchPassThrough) {
  for (const PlanStatus status : {PlanStatus::kTimedOut, PlanStatus::kExhausted,
                                  PlanStatus::kCancelled, PlanStatus::kMemoryLimit}) {
    const PlanResult result = Plan([&](SearchQuery&) { return Ended(status); }, Request());
    EXPECT_EQ(result.status, status);
    EXPECT_EQ(result.message, "because");
    EXPECT_TRUE(result.path.empty());
    EXPECT_TRUE(result.simplified_path.empty());
  }
}

TEST_F(PlannerTest, AStartInTheGoalNeedsNoSearch) {
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    PlanRequest request = MakeRequest(robot_, start_, {0.65 - 2 * M_PI, 0, 0.05}, 0.1);
    request.direction = direction;
    const PlanResult result = Plan(StraightLine, request);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
    EXPECT_EQ(result.path, Path{start_});
    EXPECT_EQ(num_searches_, 0);
  }
}

TEST_F(PlannerTest, StartsAndGoalsOutsideTheLimitsAreNamed) {
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    PlanRequest request = MakeRequest(robot_, {0.6, 2.7, 0}, goal_);
    request.direction = direction;
    const PlanResult start = Plan(StraightLine, request);
    EXPECT_EQ(start.status, PlanStatus::kStartInvalid);
    EXPECT_THAT(start.message, HasSubstr("elbow"));
    EXPECT_THAT(start.message, HasSubstr("2.7"));
    EXPECT_THAT(start.message, HasSubstr("-2.6, 2.6"));

    request = MakeRequest(robot_, start_, {0, 0, -3}, 0.1);
    request.direction = direction;
    const PlanResult goal = Plan(StraightLine, request);
    EXPECT_EQ(goal.status, PlanStatus::kGoalInvalid);
    EXPECT_THAT(goal.message, HasSubstr("wrist"));
    EXPECT_THAT(goal.message, HasSubstr("-3"));
    EXPECT_EQ(num_searches_, 0);
  }
}

TEST_F(PlannerTest, StartsAndGoalsInCollisionAreNamed) {
  const PlanResult start = Plan(StraightLine, MakeRequest(robot_, {0, 0, 0}, goal_), PostsScene());
  EXPECT_EQ(start.status, PlanStatus::kStartInvalid);
  EXPECT_THAT(start.message, HasSubstr("post_ahead"));
  const PlanResult goal =
      Plan(StraightLine, MakeRequest(robot_, start_, {M_PI, 0, 0}), PostsScene());
  EXPECT_EQ(goal.status, PlanStatus::kGoalInvalid);
  EXPECT_THAT(goal.message, HasSubstr("post_behind"));
  EXPECT_EQ(num_searches_, 0);
}

TEST_F(PlannerTest, BothEndsInvalidIsAnInvalidStart) {
  const PlanResult result =
      Plan(StraightLine, MakeRequest(robot_, {0, 0, 0}, {M_PI, 0, 0}), PostsScene());
  EXPECT_EQ(result.status, PlanStatus::kStartInvalid);
}

TEST_F(PlannerTest, HeldJointsAreTakenFromTheStart) {
  PlanRequest request = MakeRequest(robot_, {0, 0, 0}, goal_);
  request.start.names.push_back("lift");
  request.start.positions.push_back(0.5);  // Over the post.
  EXPECT_EQ(Plan(StraightLine, request, PostsScene()).status, PlanStatus::kSolved);
  request.start.positions.back() = 0;
  EXPECT_EQ(Plan(StraightLine, request, PostsScene()).status, PlanStatus::kStartInvalid);
}

TEST_F(PlannerTest, ASceneDoesNotOutliveItsRequest) {
  ScriptedPlanner planner(robot_, StraightLine);
  const PlanRequest request = MakeRequest(robot_, {0, 0, 0}, goal_);
  EXPECT_EQ(planner.Plan(request, PostsScene(), nullptr).status, PlanStatus::kStartInvalid);
  EXPECT_EQ(planner.Plan(request, EmptyPlanarScene(), nullptr).status, PlanStatus::kSolved);
  EXPECT_EQ(planner.Plan(request, PostsScene(), nullptr).status, PlanStatus::kStartInvalid);
}

TEST_F(PlannerTest, TheEdgeResolutionIsTheRequestsOrTheRobots) {
  PlanRequest request = Request();
  for (const auto asked : {std::optional<double>(), std::optional(0.004)}) {
    request.edge_resolution_m = asked;
    Plan(
        [&](SearchQuery& query) {
          EXPECT_EQ(query.edges().edge_resolution(), asked.value_or(0.02));
          return StraightLine(query);
        },
        request);
    EXPECT_EQ(num_searches_, 1);
  }
}

TEST_F(PlannerTest, BadRequestsAreRefusedWithTheReason) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    std::string what;
    std::function<void(PlanRequest*)> spoil;
    std::string part;
  };
  const std::vector<Case> cases = {
      {"no time", [](PlanRequest* r) { r->time_limit_s = 0; }, "time_limit_s"},
      {"negative time", [](PlanRequest* r) { r->time_limit_s = -1; }, "time_limit_s"},
      {"time NaN", [](PlanRequest* r) { r->time_limit_s = kNan; }, "time_limit_s"},
      {"negative step", [](PlanRequest* r) { r->edge_resolution_m = -0.1; }, "edge_resolution_m"},
      {"step NaN", [](PlanRequest* r) { r->edge_resolution_m = double{kNan}; },
       "edge_resolution_m"},
      {"coarse step", [](PlanRequest* r) { r->edge_resolution_m = 1.1; }, "from 1e-06 to 1"},
      {"fine step", [](PlanRequest* r) { r->edge_resolution_m = 1e-320; }, "edge_resolution_m"},
      {"infinite step", [](PlanRequest* r) { r->edge_resolution_m = INFINITY; },
       "edge_resolution_m"},
      {"group", [](PlanRequest* r) { r->group = "leg"; }, "leg"},
      {"start joint", [](PlanRequest* r) { r->start.names[0] = "knee"; }, "knee"},
      {"start NaN", [](PlanRequest* r) { r->start.positions[0] = kNan; }, "shoulder"},
      {"no start", [](PlanRequest* r) { r->start = {}; }, "shoulder"},
      {"no goal", [](PlanRequest* r) { r->goal.clear(); }, "shoulder"},
      {"goal twice", [](PlanRequest* r) { r->goal[1] = r->goal[0]; }, "shoulder"},
      {"tolerance", [](PlanRequest* r) { r->goal[2].tolerance_above = -1; }, "wrist"},
  };
  for (const Case& bad : cases) {
    SCOPED_TRACE(bad.what);
    PlanRequest request = Request();
    bad.spoil(&request);
    const PlanResult result = Plan(StraightLine, request);
    EXPECT_EQ(result.status, PlanStatus::kInvalidRequest);
    EXPECT_THAT(result.message, HasSubstr(bad.part));
    EXPECT_EQ(result.message.find('\n'), std::string::npos);
    EXPECT_EQ(num_searches_, 0);
  }
}

TEST_F(PlannerTest, BackwardIsForPlannersThatCan) {
  ScriptedPlanner planner(robot_, StraightLine);
  planner.description.backward = false;
  PlanRequest request = Request();
  request.direction = Direction::kBackward;
  const PlanResult result = planner.Plan(request, EmptyPlanarScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kInvalidRequest);
  EXPECT_THAT(result.message, HasSubstr("backward"));
}

TEST_F(PlannerTest, BadParametersAreABadRequest) {
  PlanRequest request = Request();
  request.parameters["colour"] = "green";
  const PlanResult result = Plan(
      [](SearchQuery& query) -> SearchResult {
        throw InputError("no parameter " + query.parameters().begin()->first);
      },
      request);
  EXPECT_EQ(result.status, PlanStatus::kInvalidRequest);
  EXPECT_EQ(result.message, "no parameter colour");
}

TEST_F(PlannerTest, RunningOutOfMemoryIsAStatus) {
  const PlanResult result =
      Plan([](SearchQuery&) -> SearchResult { throw std::bad_alloc(); }, Request());
  EXPECT_EQ(result.status, PlanStatus::kMemoryLimit);
  EXPECT_GT(result.planning_time_s, 0);
}

TEST_F(PlannerTest, APathThatAResultCannotHoldIsAStatus) {
  std::size_t num_waypoints = kMostResultWaypoints;
  const auto search = [&](SearchQuery& query) {
    Path path(num_waypoints, query.start());
    path.back() = query.goal().nominal;
    return Solved(std::move(path));
  };
  PlanRequest request = Request();
  request.simplify = false;
  request.time_limit_s = 3600;
  EXPECT_EQ(Plan(search, request).path.size(), kMostResultWaypoints);
  ++num_waypoints;
  request.simplify = true;
  const PlanResult result = Plan(search, request);
  EXPECT_EQ(result.status, PlanStatus::kMemoryLimit);
  EXPECT_EQ(result.message, "path of 15001 waypoints; a result holds at most 15000");
  EXPECT_TRUE(result.path.empty());
  EXPECT_TRUE(result.simplified_path.empty());
  EXPECT_GT(result.planning_time_s, 0);
}

TEST_F(PlannerTest, OtherExceptionsAreNotSwallowed) {
  EXPECT_THROW(
      Plan([](SearchQuery&) -> SearchResult { throw std::logic_error("a mistake"); }, Request()),
      std::logic_error);
}

using PlannerDeathTest = PlannerTest;

TEST_F(PlannerDeathTest, SearchesAreHeldToTheirContract) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  struct Case {
    ScriptedPlanner::Script script;
    std::string message;
  };
  const std::vector<Case> cases = {
      {[](SearchQuery&) { return Solved({}); }, "without a path"},
      {[](SearchQuery& query) { return Solved({query.goal().nominal}); }, "begin at the start"},
      {[](SearchQuery& query) { return Solved({query.start()}); }, "end in the goal"},
      {[](SearchQuery& query) {
         return Solved({query.start(), {}, query.goal().nominal});
       },
       "wrong size"},
      {[](SearchQuery&) { return Ended(PlanStatus::kStartInvalid); }, "START_INVALID"},
  };
  for (const Case& broken : cases) {
    EXPECT_DEATH(Plan(broken.script, Request()), "scripted: broken invariant: .*" + broken.message);
  }
}

}  // namespace
}  // namespace planbench
