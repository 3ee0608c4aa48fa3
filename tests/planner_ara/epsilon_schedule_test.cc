#include "planner_ara/epsilon_schedule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

namespace planbench {
namespace {

std::vector<double> Values(const EpsilonSchedule& schedule) {
  std::vector<double> values{schedule.initial};
  while (const std::optional<double> next = schedule.Next(values.back(), values.back())) {
    values.push_back(*next);
  }
  return values;
}

TEST(EpsilonSchedule, StepsDownToTheFinalValue) {
  EXPECT_EQ(Values({5, 2, 1}), (std::vector<double>{5, 3, 1}));
  EXPECT_EQ(Values({4, 2, 1}), (std::vector<double>{4, 2, 1}));
  EXPECT_EQ(Values({2, 10, 1.5}), (std::vector<double>{2, 1.5}));
  EXPECT_EQ(Values({1, 1, 1}), (std::vector<double>{1}));
}

TEST(EpsilonSchedule, SmallStepsAreNotLostToRounding) {
  const std::vector<double> values = Values({3, 0.1, 1});
  ASSERT_EQ(values.size(), 21U);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], 3 - 0.1 * static_cast<double>(i), 1e-12);
  }
}

TEST(EpsilonSchedule, NoStepIsTakenTwiceHoweverManyThereAre) {
  for (const EpsilonSchedule& schedule :
       {EpsilonSchedule{100, 1e-6, 1}, EpsilonSchedule{1e6, 1e-3, 1},
        EpsilonSchedule{1e6, 1e-6, 1}}) {
    for (double epsilon = schedule.initial; epsilon > 1; epsilon *= 0.999) {
      const double step = std::round((schedule.initial - epsilon) / schedule.decrement);
      const double value = schedule.initial - step * schedule.decrement;
      const std::optional<double> next = schedule.Next(value, value);
      if (!next) break;
      EXPECT_LT(*next, value);
    }
  }
  EXPECT_LT(EpsilonSchedule({100, 1e-6, 1}).Next(83.839999, 83.839999), 83.839999);
}

TEST(EpsilonSchedule, SkipsWhatTheBoundHasOvertaken) {
  const EpsilonSchedule schedule{10, 1, 1};
  EXPECT_EQ(schedule.Next(10, 4.5), 4);
  EXPECT_EQ(schedule.Next(10, 4), 3);
  EXPECT_EQ(schedule.Next(3, 8), 2);
  EXPECT_EQ(schedule.Next(3, 1.2), 1);
}

TEST(EpsilonSchedule, EndsWhenTheBoundIsGoodEnough) {
  const EpsilonSchedule schedule{10, 1, 2};
  EXPECT_EQ(schedule.Next(10, 2), std::nullopt);
  EXPECT_EQ(schedule.Next(10, 1.5), std::nullopt);
  EXPECT_EQ(schedule.Next(2, 2), std::nullopt);
}

}  // namespace
}  // namespace planbench
