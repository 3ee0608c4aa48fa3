#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/numbers.h"
#include "planning/planner.h"
#include "support/planning_problems.h"
#include "support/scripted_planner.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

class SeveralGoals : public testing::Test {
 protected:
  PlanResult Plan(const ScriptedPlanner::Script& script, const PlanRequest& request,
                  const Scene& scene = EmptyPlanarScene()) {
    ScriptedPlanner planner(robot_, script);
    PlanResult result = planner.Plan(request, scene, nullptr);
    num_searches_ = planner.num_searches;
    return result;
  }

  PlanRequest RequestFor(const std::vector<Configuration>& goals) const {
    PlanRequest request = MakeRequest(robot_, start_, goals.front());
    for (std::size_t i = 1; i < goals.size(); ++i) {
      const PlanRequest other = MakeRequest(robot_, start_, goals[i]);
      request.goal.insert(request.goal.end(), other.goal.begin(), other.goal.end());
    }
    return request;
  }

  const Robot robot_ = LoadPlanarRobot();
  const Configuration start_ = {0.6, 0, 0};
  int num_searches_ = 0;
};

TEST_F(SeveralGoals, TheNearestIsTriedFirst) {
  const std::vector<Configuration> goals = {{0.6, 2, 0}, {0.6, 0, -0.5}, {0, 0, 0}, {0.6, 1, 0}};
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    const bool backward = direction == Direction::kBackward;
    PlanRequest request = RequestFor(goals);
    request.direction = direction;
    std::vector<Configuration> tried;
    const auto all_but_last = [&](SearchQuery& query) {
      tried.push_back(backward ? query.start() : query.goal().nominal);
      EXPECT_EQ(backward ? query.goal().nominal : query.start(), start_);
      SearchResult result = tried.size() < 3 ? Ended(PlanStatus::kExhausted) : StraightLine(query);
      result.counters = {{"states", 10}};
      return result;
    };
    const PlanResult result = Plan(all_but_last, request, PostsScene());
    EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
    // The third is in a post.
    EXPECT_EQ(tried, (std::vector<Configuration>{goals[1], goals[3], goals[0]}));
    EXPECT_EQ(result.path, (Path{start_, goals[0]}));
    EXPECT_EQ(result.counters.at("states"), 30);
  }
}

TEST_F(SeveralGoals, TheOneThatAPathIsGivenToIsTriedFirst) {
  const std::vector<Configuration> goals = {{0.5, 0, 0}, {0.6, 1, 0}, {0.6, 2, 0}};
  PlannerDescription able = ScriptedPlanner::Able();
  able.improve = true;
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    PlanRequest request = RequestFor(goals);
    request.direction = direction;
    request.initial_joint_names = {"shoulder", "elbow", "wrist"};
    request.initial_path = {start_, {0.6, 0, 1}, goals[2]};
    const auto keep_it = [](SearchQuery& query) {
      if (query.initial_path().empty()) return Ended(PlanStatus::kExhausted);
      SearchResult result = StraightLine(query);
      result.path = query.initial_path();
      return result;
    };
    ScriptedPlanner planner(robot_, keep_it, able);
    const PlanResult result = planner.Plan(request, EmptyPlanarScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
    EXPECT_EQ(result.path, request.initial_path);
    EXPECT_EQ(planner.num_searches, 1);
  }
}

TEST_F(SeveralGoals, AreInvalidTogether) {
  const PlanResult result = Plan(StraightLine, RequestFor({{0, 0, 0}, {0, 0, -3}}), PostsScene());
  EXPECT_EQ(result.status, PlanStatus::kGoalInvalid);
  EXPECT_THAT(result.message, MatchesRegex("goal .*; none of the 2 goals is valid"));
  EXPECT_THAT(result.message, HasSubstr("post"));
  EXPECT_EQ(num_searches_, 0);
  EXPECT_EQ(Plan(StraightLine, RequestFor({{-0.6, 0, 0}, start_})).path, Path{start_})
      << "in the second";
}

TEST_F(SeveralGoals, ShareTheTime) {
  PlanRequest request = RequestFor({{0.5, 0, 0}, {0.4, 0, 0}, {0.3, 0, 0}, {0.2, 0, 0}});
  request.time_limit_s = 3600;
  std::vector<double> shares;
  const PlanResult failed = Plan(
      [&](SearchQuery& query) {
        shares.push_back(query.RemainingSeconds());
        return Ended(shares.size() == 2 ? PlanStatus::kTimedOut : PlanStatus::kExhausted);
      },
      request);
  EXPECT_EQ(failed.status, PlanStatus::kTimedOut) << "one of the goals was not searched to the end";
  ASSERT_EQ(shares.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(shares[i], 3600 / static_cast<double>(4 - i), 60) << "nearly no time has passed";
  }
  EXPECT_EQ(Plan([](SearchQuery&) { return Ended(PlanStatus::kExhausted); }, request).status,
            PlanStatus::kExhausted);
  EXPECT_EQ(Plan([](SearchQuery&) { return Ended(PlanStatus::kCancelled); }, request).status,
            PlanStatus::kCancelled);
  EXPECT_EQ(num_searches_, 1);

  request.anytime = true;
  const PlanResult solved = Plan(
      [&](SearchQuery& query) {
        EXPECT_LT(query.RemainingSeconds(), 901);
        query.ReportSolution(2, 1, 1);
        EXPECT_GT(query.RemainingSeconds(), 3000) << "a path to improve";
        return StraightLine(query);
      },
      request);
  EXPECT_EQ(solved.status, PlanStatus::kSolved) << solved.message;
  EXPECT_EQ(num_searches_, 1);
}

TEST_F(SeveralGoals, EqualOnesAreOne) {
  const Configuration goal = {0.5, 0, 0};
  PlanRequest request = RequestFor({goal, {0.4, 0, 0}, goal, goal});
  request.time_limit_s = 3600;
  std::vector<double> shares;
  const auto share = [&](SearchQuery& query) {
    shares.push_back(query.RemainingSeconds());
    return Ended(PlanStatus::kExhausted);
  };
  Plan(share, request);
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_NEAR(shares[0], 1800, 60);
  request.goal.back().tolerance_above = 0.1;
  Plan(share, request);
  EXPECT_EQ(shares.size(), 5u) << "of which one is larger";
  EXPECT_EQ(Plan(StraightLine, RequestFor({{0, 0, 0}, {0, 0, 0}}), PostsScene()).message,
            Plan(StraightLine, RequestFor({{0, 0, 0}}), PostsScene()).message);
}

TEST_F(SeveralGoals, EachHasASeedOfItsOwn) {
  PlanRequest request = RequestFor({{0.3, 0, 0}, {0.5, 0, 0}, {0.4, 0, 0}});
  request.seed = 7;
  std::vector<std::uint64_t> seeds;
  const auto note = [&](SearchQuery& query) {
    seeds.push_back(query.seed());
    return Ended(PlanStatus::kExhausted);
  };
  Plan(note, request);
  EXPECT_EQ(std::set<std::uint64_t>(seeds.begin(), seeds.end()).size(), 3u);
  EXPECT_EQ(seeds.front(), 7u) << "as if the nearest were the only one";
}

TEST_F(SeveralGoals, ATurnEndsThoughItsSearchAsksForNothingButEdges) {
  std::vector<Configuration> goals;
  for (int i = 0; i < 25; ++i) goals.push_back({0.5 - 0.01 * i, 0, 0});
  PlanRequest request = RequestFor(goals);
  request.time_limit_s = 5;  // of which the first turn has 0.2 s
  bool is_first = true;
  Plan(
      [&](SearchQuery& query) {
        if (!std::exchange(is_first, false)) return Ended(PlanStatus::kExhausted);
        EdgeChecker& edges = query.edges();
        while (!edges.Stopped()) edges.IsValidEdge(query.start(), query.goal().nominal);
        EXPECT_FALSE(edges.IsValidEdge(query.start(), query.goal().nominal));
        query.HoldPath();
        EXPECT_TRUE(edges.IsValidEdge(query.start(), query.goal().nominal))
            << "the turn is as long as the request";
        return Ended(PlanStatus::kTimedOut);
      },
      request);
  EXPECT_EQ(num_searches_, 25);
}

TEST_F(SeveralGoals, OneThatTakesAllTheMemoryLeavesTheOthers) {
  const PlanRequest request = RequestFor({{0.5, 0, 0}, {0.4, 0, 0}, {0.3, 0, 0}});
  int num_searches = 0;
  const auto run_out_until = [&](int last, PlanStatus then) {
    num_searches = 0;
    return Plan(
        [&, last, then](SearchQuery& query) {
          if (++num_searches < last) return Ended(PlanStatus::kMemoryLimit);
          return then == PlanStatus::kSolved ? StraightLine(query) : Ended(then);
        },
        request);
  };
  EXPECT_EQ(run_out_until(3, PlanStatus::kSolved).path, (Path{start_, {0.3, 0, 0}}));
  EXPECT_EQ(run_out_until(3, PlanStatus::kExhausted).status, PlanStatus::kMemoryLimit);
  EXPECT_EQ(run_out_until(4, PlanStatus::kExhausted).status, PlanStatus::kMemoryLimit);
  EXPECT_EQ(num_searches_, 3);

  num_searches = 0;
  const PlanResult result = Plan(
      [&](SearchQuery& query) {
        if (++num_searches == 1) return Ended(PlanStatus::kMemoryLimit);
        if (query.TakeKept() != nullptr) return Ended(PlanStatus::kExhausted);
        query.Keep(std::make_shared<int>(), 1);
        SearchResult kept = Ended(PlanStatus::kTimedOut);
        kept.message = "its turn is over";
        return kept;
      },
      request);
  EXPECT_EQ(num_searches, 5);
  EXPECT_EQ(result.status, PlanStatus::kMemoryLimit) << "no goal is left for want of time";
  EXPECT_EQ(result.message, "because");
}

/// A search that ends after so many steps, whatever the turns that they take.
class SteppingSearch {
 public:
  explicit SteppingSearch(int num_steps) : num_steps_(num_steps) {}

  SearchResult operator()(SearchQuery& query, PlanStatus end) {
    auto steps = std::static_pointer_cast<int>(query.TakeKept());
    if (!steps) steps = std::make_shared<int>(0);
    turns.push_back({query.goal().nominal[0], 0});
    while (*steps < num_steps_ && !query.TurnIsOver()) {
      ++*steps;
      ++turns.back().num_steps;
    }
    if (*steps == num_steps_) {
      return end == PlanStatus::kSolved ? StraightLine(query) : Ended(end);
    }
    query.Keep(steps, 100);
    return Ended(PlanStatus::kTimedOut);
  }

  struct Turn {
    double goal;  // its first joint
    int num_steps;
  };
  std::vector<Turn> turns;

 private:
  int num_steps_;
};

TEST_F(SeveralGoals, SearchesThatCanGoOnDoSoInRoundsOfTwiceTheWork) {
  PlanRequest request = RequestFor({{0.5, 0, 0}, {0.4, 0, 0}, {0.3, 0, 0}});
  request.time_limit_s = 3600;
  constexpr int kNumSteps = 25'000;
  SteppingSearch search(kNumSteps);
  const auto last_is_solved = [&](SearchQuery& query) {
    return search(query,
                  query.goal().nominal[0] == 0.3 ? PlanStatus::kSolved : PlanStatus::kExhausted);
  };
  const PlanResult solved = Plan(last_is_solved, request);
  EXPECT_EQ(solved.path, (Path{start_, {0.3, 0, 0}}));
  ASSERT_EQ(search.turns.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(search.turns[i].goal, std::vector<double>({0.5, 0.4, 0.3})[i % 3]);
    EXPECT_EQ(search.turns[i].num_steps,
              i < 3 ? search.turns[0].num_steps : kNumSteps - search.turns[0].num_steps);
  }
  EXPECT_LE(search.turns[3].num_steps, 2 * search.turns[0].num_steps + 1);

  SteppingSearch exhausting(kNumSteps);
  EXPECT_EQ(
      Plan([&](SearchQuery& query) { return exhausting(query, PlanStatus::kExhausted); }, request)
          .status,
      PlanStatus::kExhausted)
      << "though each was left for another once";

  // The only one left goes on to its end.
  SteppingSearch alone(100 * kNumSteps);
  const auto only_first_is_open = [&](SearchQuery& query) {
    return query.goal().nominal[0] == 0.5 ? alone(query, PlanStatus::kSolved)
                                          : Ended(PlanStatus::kExhausted);
  };
  EXPECT_EQ(Plan(only_first_is_open, request).status, PlanStatus::kSolved);
  EXPECT_EQ(alone.turns.size(), 2u);
  alone.turns.clear();
  EXPECT_EQ(Plan(only_first_is_open, RequestFor({{0.5, 0, 0}})).status, PlanStatus::kSolved);
  EXPECT_EQ(alone.turns.size(), 1u);
}

TEST_F(SeveralGoals, KeptSearchesMakeRoomForOthers) {
  int num_searches = 0;
  const auto script = [&](SearchQuery& query) {
    const auto kept = std::static_pointer_cast<int>(query.TakeKept());
    switch (++num_searches) {
      case 1:
        EXPECT_EQ(kept, nullptr);
        EXPECT_EQ(query.KeptBytes(), 0u);
        query.Keep(std::make_shared<int>(1), 100);
        return Ended(PlanStatus::kTimedOut);
      case 2:
        EXPECT_EQ(query.KeptBytes(), 100u);
        query.Keep(std::make_shared<int>(2), 70);
        return Ended(PlanStatus::kTimedOut);
      case 3:
        EXPECT_EQ(query.KeptBytes(), 170u);
        query.DropLastKept();
        EXPECT_EQ(query.KeptBytes(), 100u);
        query.Keep(std::make_shared<int>(3), 50);
        return Ended(PlanStatus::kTimedOut);
      case 4:
        EXPECT_EQ(query.goal().nominal[0], 0.5);
        EXPECT_TRUE(kept && *kept == 1) << "goes on: its turn was next";
        EXPECT_EQ(query.KeptBytes(), 50u) << "one's own does not count";
        return Ended(PlanStatus::kExhausted);
      case 5:
        EXPECT_EQ(query.goal().nominal[0], 0.4);
        EXPECT_EQ(kept, nullptr) << "begins anew";
        return Ended(PlanStatus::kExhausted);
      default:
        EXPECT_TRUE(kept && *kept == 3);
        EXPECT_EQ(query.KeptBytes(), 0u);
        return StraightLine(query);
    }
  };
  const PlanResult result = Plan(script, RequestFor({{0.5, 0, 0}, {0.4, 0, 0}, {0.3, 0, 0}}));
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_EQ(num_searches, 6);
}

/// Proves for goals in the order of their costs, which are 2 a rad of the first joint.
class ProvingPlanner : public Planner {
 public:
  ProvingPlanner(const Robot& robot, ScriptedPlanner::Script script)
      : Planner(robot), script_(std::move(script)) {}
  PlannerDescription Describe() const override { return ScriptedPlanner::Able(); }

  std::vector<double> tried;  // first joint of the goals
  std::vector<double> known;  // costs

 protected:
  SearchResult Search(SearchQuery& query) override {
    tried.push_back(query.goal().nominal[0]);
    known.push_back(query.known_cost());
    return script_(query);
  }
  std::vector<double> LowerBounds(const SearchQuery&, const Configuration& q,
                                  std::span<const GoalBox> ends) override {
    std::vector<double> bounds;
    for (const GoalBox& end : ends) bounds.push_back(2 * std::abs(end.nominal[0] - q[0]));
    return bounds;
  }

 private:
  ScriptedPlanner::Script script_;
};

TEST_F(SeveralGoals, AreSearchedForUntilTheBoundHoldsForAll) {
  // At least 8, 2, 4 and 6. In joint distance the third is nearer than the second.
  PlanRequest request =
      RequestFor({{0.6 - 4, 0, 0}, {0.6 - 1, 2, 0}, {0.6 + 2, 0, 0}, {0.6 - 3, 0, 0}});
  request.anytime = true;
  struct Case {
    double wanted;
    std::vector<double> tried;
    double cost;
    double epsilon;
    std::size_t num_told;
  };
  const std::vector<Case> cases = {
      {0, {-0.4}, 7, 7.0 / 4, 1},
      {1.75, {-0.4}, 7, 7.0 / 4, 1},
      {1.5, {-0.4, 2.6}, 6.5, 6.5 / 6, 2},
      // That the last one's best path costs no less than 6.5 is proof enough.
      {1, {-0.4, 2.6, -2.4}, 6.5, 6.5 / 6.2, 3}};
  for (const Case& each : cases) {
    SCOPED_TRACE(each.wanted);
    ProvingPlanner planner(robot_, [&](SearchQuery& query) {
      const double goal = query.goal().nominal[0];
      SearchResult result = StraightLine(query);
      result.wanted_epsilon = each.wanted;
      result.counters = {{"expansions", 10}};
      result.path_counters = {{"goal", goal}};
      result.cost = goal == 0.6 - 1 ? 7 : goal == 0.6 + 2 ? 6.5 : 9;
      result.lower_bound = std::min(query.known_cost(), goal == 0.6 + 2 ? 6.2 : result.cost);
      query.ReportSolution(result.lower_bound, result.cost, 10);
      return result;
    });
    const PlanResult result = planner.Plan(request, EmptyPlanarScene(), nullptr);
    ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
    ASSERT_EQ(planner.tried.size(), each.tried.size());
    for (std::size_t i = 0; i < each.tried.size(); ++i) {
      EXPECT_NEAR(planner.tried[i], each.tried[i], 1e-9);
      EXPECT_EQ(planner.known[i], i == 0 ? kInfinity : i == 1 ? 7 : 6.5);
    }
    EXPECT_EQ(result.cost, each.cost);
    EXPECT_NEAR(result.epsilon, each.epsilon, 1e-9);
    EXPECT_EQ(result.counters.at("expansions"), 10 * static_cast<double>(each.tried.size()));
    EXPECT_EQ(result.counters.at("goal"), planner.tried[each.cost == 7 ? 0 : 1]) << "no sum";
    for (const PlanProgress& progress : result.progress) {
      EXPECT_GE(progress.epsilon, result.epsilon);
      EXPECT_GE(progress.cost, result.cost);
    }
    ASSERT_EQ(result.progress.size(), each.num_told);
    EXPECT_EQ(result.progress.back().expansions, result.counters.at("expansions"));
    EXPECT_EQ(result.progress.back().cost, result.cost);
    EXPECT_EQ(result.progress.back().epsilon, result.epsilon);
  }
}

TEST_F(SeveralGoals, WhatWasGivenUpForWantOfTimeIsTakenUpWithAPath) {
  PlanRequest request = RequestFor({{0.6 - 1, 0, 0}, {0.6 - 2, 0, 0}, {0.6 - 4, 0, 0}});
  request.anytime = true;
  int num_searches = 0;
  ProvingPlanner planner(robot_, [&](SearchQuery& query) {
    if (++num_searches == 1) return Ended(PlanStatus::kTimedOut);
    SearchResult result = StraightLine(query);
    result.wanted_epsilon = 1;
    result.cost = num_searches == 2 ? 6 : 3;
    result.lower_bound = result.cost;
    return result;
  });
  const PlanResult result = planner.Plan(request, EmptyPlanarScene(), nullptr);
  EXPECT_EQ(num_searches, 3) << "none for the third goal";
  EXPECT_EQ(result.cost, 3);
  EXPECT_EQ(result.epsilon, 1);
  EXPECT_EQ(result.path, (Path{start_, {0.6 - 1, 0, 0}}));
}

TEST_F(SeveralGoals, WhatWasExhaustedIsNotTakenUpWithAPath) {
  int num_searches = 0;
  ProvingPlanner planner(robot_, [&](SearchQuery& query) {
    ++num_searches;
    // Not the second, though what is found by then has timed out.
    if (num_searches < 3) {
      return Ended(num_searches == 1 ? PlanStatus::kTimedOut : PlanStatus::kExhausted);
    }
    SearchResult result = StraightLine(query);
    result.wanted_epsilon = 1;
    result.cost = result.lower_bound = 6;
    return result;
  });
  const PlanResult result = planner.Plan(
      RequestFor({{0.6 - 1, 0, 0}, {0.6 - 2, 0, 0}, {0.6 - 3, 0, 0}}), EmptyPlanarScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
  ASSERT_EQ(num_searches, 4);
  EXPECT_EQ(planner.tried.back(), planner.tried.front());
}

TEST_F(SeveralGoals, WithAPathTheTurnsGoOnWithThoseThatStandAgainstTheBound) {
  // At least 2, 4 and 8.
  PlanRequest request = RequestFor({{0.6 - 1, 0, 0}, {0.6 - 2, 0, 0}, {0.6 - 4, 0, 0}});
  request.anytime = true;
  int num_searches = 0;
  ProvingPlanner planner(robot_, [&](SearchQuery& query) {
    const bool goes_on = query.TakeKept() != nullptr;
    EXPECT_EQ(goes_on, ++num_searches > 2);
    if (!goes_on) query.Keep(std::make_shared<int>(), 1);
    SearchResult result = num_searches == 2 ? Ended(PlanStatus::kTimedOut) : StraightLine(query);
    result.wanted_epsilon = 1;
    result.cost = num_searches == 4 ? 6 : 7;
    result.lower_bound = num_searches == 1 ? 3 : num_searches == 2 ? 5 : result.cost;
    if (num_searches != 2) query.ReportSolution(result.lower_bound, result.cost, 1);
    return result;
  });
  const PlanResult result = planner.Plan(request, EmptyPlanarScene(), nullptr);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
  ASSERT_EQ(planner.tried.size(), 4u) << "two of both, none of the third goal";
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(planner.tried[i], i % 2 == 0 ? -0.4 : -1.4, 1e-9);
  EXPECT_EQ(planner.known, (std::vector<double>{kInfinity, 7, 7, 7}));
  EXPECT_EQ(result.cost, 6);
  EXPECT_EQ(result.epsilon, 1);
  EXPECT_EQ(result.path, (Path{start_, {0.6 - 2, 0, 0}}));
}

TEST_F(SeveralGoals, WhatIsKeptOfGoalsThatNoLongerStandAgainstTheBoundIsDropped) {
  // At least 2, 4 and 6.
  PlanRequest request = RequestFor({{0.6 - 1, 0, 0}, {0.6 - 2, 0, 0}, {0.6 - 3, 0, 0}});
  request.anytime = true;
  int num_searches = 0;
  ProvingPlanner planner(robot_, [&](SearchQuery& query) {
    const std::shared_ptr<void> kept = query.TakeKept();
    if (++num_searches <= 2) {
      query.Keep(std::make_shared<int>(), 100);
      return Ended(PlanStatus::kTimedOut);
    }
    SearchResult result = StraightLine(query);
    result.wanted_epsilon = 1;
    if (num_searches == 3) {
      EXPECT_EQ(query.KeptBytes(), 200u);
      result.cost = 8;
      result.lower_bound = 6;
      query.Keep(std::make_shared<int>(), 100);
    } else {
      EXPECT_EQ(query.KeptBytes(), num_searches == 4 ? 200u : 0u);
      result.cost = result.lower_bound = num_searches == 4 ? 5 : 4.5;
    }
    return result;
  });
  const PlanResult result = planner.Plan(request, EmptyPlanarScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_EQ(num_searches, 5) << "none for the third once there is a path at 5";
}

TEST_F(SeveralGoals, APathInHandOutlivesTheMemoryOfAFurtherSearch) {
  PlanRequest request = RequestFor({{0.6 - 1, 0, 0}, {0.6 - 2, 0, 0}, {0.6 - 2.5, 0, 0}});
  request.anytime = true;
  int num_searches = 0;
  ProvingPlanner planner(robot_, [&](SearchQuery& query) {
    SearchResult result = StraightLine(query);
    result.wanted_epsilon = 1;
    result.cost = result.lower_bound = ++num_searches == 1 ? 6 : 4.5;
    query.ReportSolution(result.lower_bound, result.cost, 1);
    if (num_searches > 1) throw std::bad_alloc();
    return result;
  });
  const PlanResult result = planner.Plan(request, EmptyPlanarScene(), nullptr);
  EXPECT_EQ(num_searches, 2);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_EQ(result.path, (Path{start_, {0.6 - 1, 0, 0}}));
  EXPECT_EQ(result.cost, 6);
  EXPECT_EQ(result.epsilon, 6.0 / 4) << "nothing more is proven of the second";
  ASSERT_EQ(result.progress.size(), 1u);
  EXPECT_EQ(result.progress.back().cost, result.cost);
}

}  // namespace
}  // namespace planbench
