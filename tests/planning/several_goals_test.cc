#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

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
  for (const PlanStatus last : {PlanStatus::kCancelled, PlanStatus::kMemoryLimit}) {
    EXPECT_EQ(Plan([&](SearchQuery&) { return Ended(last); }, request).status, last);
    EXPECT_EQ(num_searches_, 1);
  }

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

}  // namespace
}  // namespace planbench
