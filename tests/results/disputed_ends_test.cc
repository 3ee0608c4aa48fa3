#include "results/disputed_ends.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

/// Of problems 1, 2, ...
Outcomes Ended(const std::vector<Outcome::Kind>& kinds) {
  Outcomes outcomes;
  for (const Outcome::Kind kind : kinds) {
    const int problem = static_cast<int>(outcomes.by_problem.size()) + 1;
    outcomes.by_problem[problem].emplace_back().kind = kind;
  }
  return outcomes;
}

TEST(DisputedEndsTest, WhoCallsEndsInvalidThatAPathHasIsNamed) {
  using enum Outcome::Kind;
  const Outcomes claims = Ended({kUnsolvable, kUnsolvable, kUnsolvable, kFailure, kForward});
  const Outcomes paths = Ended({kFailure, kBackward, kForward, kForward, kUnsolvable});
  EXPECT_THAT(
      DescribeDisputedEnds({{"box", {{"A", 0, "spheres", &claims}, {"B", 0, "spheres", &paths}}}}),
      ElementsAre(Pair("A",
                       "A: called start or goal invalid on 2 problems of which a path is confirmed "
                       "by the same collision model (box 2 the first)."),
                  Pair("B",
                       "B: called start or goal invalid on 1 problem of which a path is confirmed "
                       "by the same collision model (box 5).")));
}

TEST(DisputedEndsTest, WhatIsJudgedOtherwiseDisputesNothing) {
  using enum Outcome::Kind;
  const Outcomes claims = Ended({kUnsolvable}), paths = Ended({kForward});
  const std::pair<JudgedOutcomes, JudgedOutcomes> apart[] = {
      {{"A", 0, "meshes", &claims}, {"B", 0, "spheres", &paths}},
      {{"A", 0, "spheres", &claims}, {"B", 1, "spheres", &paths}},
      {{"A", 0, "voxels", &claims}, {"B", 0, "voxels", &paths}},
      {{"A", 0, "", &claims}, {"B", 0, "", &paths}}};
  for (const auto& [a, b] : apart) {
    EXPECT_THAT(DescribeDisputedEnds({{"box", {a, b}}}), IsEmpty()) << a.collision_model;
    EXPECT_THAT(DescribeDisputedEnds({{"box", {a}}, {"table", {b}}}), IsEmpty());
  }
}

TEST(DisputedEndsTest, WhoIsGivenAPathHasTheOthersWordOnEndsAndAPathOfItsOwn) {
  using enum Outcome::Kind;
  const Outcomes claims = Ended({kUnsolvable}), paths = Ended({kForward});
  const auto disputed = [](const JudgedOutcomes& a, const JudgedOutcomes& b) {
    return DescribeDisputedEnds({{"box", {a, b}}});
  };
  EXPECT_THAT(disputed({"A", 0, "spheres", &claims, true}, {"B", 0, "spheres", &paths}), IsEmpty());
  EXPECT_THAT(disputed({"A", 0, "spheres", &claims}, {"B", 0, "spheres", &paths, true}),
              ElementsAre(Pair("A", testing::_)));
}

}  // namespace
}  // namespace planbench
