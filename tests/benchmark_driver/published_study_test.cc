#include "benchmark_driver/published_study.h"

#include <gtest/gtest.h>

#include <set>

namespace planbench {
namespace {

TEST(PublishedStudyTest, EveryProblemOfTheStudyIsAccountedForOnce) {
  std::set<std::pair<std::string_view, std::string_view>> keys;
  for (const PublishedFigures& row : PublishedStudy()) {
    EXPECT_TRUE(keys.emplace(row.problem_set, row.algorithm).second) << row.problem_set;
    EXPECT_EQ(row.solved_forward + row.solved_backward.value_or(0) + row.failed +
                  row.unsolvable.value_or(0),
              row.num_problems)
        << row.problem_set << " " << row.algorithm;
    EXPECT_GT(row.median_from_s, 0);
    EXPECT_LE(row.median_from_s, row.median_to_s);
    EXPECT_EQ(FindPublished(row.problem_set, row.algorithm), &row);
  }
  EXPECT_EQ(keys.size(), 6u);
}

TEST(PublishedStudyTest, OtherSetsAndAlgorithmsHaveNone) {
  EXPECT_EQ(FindPublished("shelf_demo", "ARA*"), nullptr);
  EXPECT_EQ(FindPublished("shelf_zero_test", "PRM"), nullptr);
  EXPECT_EQ(FindPublished("shelf_zero_test", ""), nullptr);
}

}  // namespace
}  // namespace planbench
