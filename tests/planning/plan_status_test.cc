#include "planning/plan_status.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "planning/planner.h"

namespace planbench {
namespace {

TEST(PlanStatusTest, NamesReadBack) {
  std::set<std::string_view> names;
  for (int i = 0; i < kNumPlanStatuses; ++i) {
    const auto status = static_cast<PlanStatus>(i);
    names.insert(PlanStatusName(status));
    EXPECT_EQ(ParsePlanStatus(PlanStatusName(status)), status);
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kNumPlanStatuses));
  EXPECT_EQ(PlanStatusName(PlanStatus::kSolved), "SOLVED");
  EXPECT_EQ(PlanStatusName(PlanStatus::kMemoryLimit), "MEMORY_LIMIT");
}

TEST(PlanStatusTest, OtherNamesAreNone) {
  for (const std::string_view name : {"", "solved", "SOLVED ", "ABORTED"}) {
    EXPECT_EQ(ParsePlanStatus(name), std::nullopt) << name;
  }
}

TEST(DirectionTest, NamesReadBack) {
  EXPECT_EQ(DirectionName(Direction::kForward), "forward");
  EXPECT_EQ(DirectionName(Direction::kBackward), "backward");
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    EXPECT_EQ(ParseDirection(DirectionName(direction)), direction);
  }
  EXPECT_EQ(ParseDirection("both"), std::nullopt);
  EXPECT_EQ(ParseDirection(""), std::nullopt);
}

TEST(PlannerClassTest, Names) {
  EXPECT_EQ(PlannerClassName(PlannerClass::kSampleThenSearch), "sample-then-search");
  EXPECT_EQ(PlannerClassName(PlannerClass::kSamplingGuided), "sampling-guided");
  EXPECT_EQ(PlannerClassName(PlannerClass::kSearchAndSample), "search-and-sample");
  EXPECT_EQ(PlannerClassName(PlannerClass::kTrajectoryOptimisation), "trajectory-optimisation");
}

}  // namespace
}  // namespace planbench
