#include "planner_ara/motion_primitives.h"

#include <gtest/gtest.h>

#include "support/expect_input_error.h"
#include "support/shared_data.h"

namespace planbench {
namespace {

using Rows = std::vector<std::vector<int>>;

MotionPrimitives Parse(const std::string& text) {
  return ParseMotionPrimitives(text, "arm.mprim", 2);
}

TEST(MotionPrimitives, LastRowsAreTheShortOnes) {
  const MotionPrimitives primitives =
      Parse("Motion_Primitives(degrees): 3 2 1\n  15 0\n\t0 -15\r\n\n8 8\n\n");
  EXPECT_EQ(primitives.long_moves, (Rows{{15, 0}, {0, -15}}));
  EXPECT_EQ(primitives.short_moves, (Rows{{8, 8}}));
}

TEST(MotionPrimitives, AllOrNoneMayBeShort) {
  EXPECT_EQ(Parse("Motion_Primitives(degrees): 1 2 0\n1 0").long_moves, (Rows{{1, 0}}));
  EXPECT_EQ(Parse("Motion_Primitives(degrees): 1 2 1\n1 0").short_moves, (Rows{{1, 0}}));
}

TEST(MotionPrimitives, RefusesWhatDoesNotHoldTogether) {
  struct Case {
    std::string text;
    std::vector<std::string> message;
  };
  const std::string header = "Motion_Primitives(degrees): ";
  const std::vector<Case> cases = {
      {"", {"arm.mprim:1:", "Motion_Primitives(degrees):"}},
      {"\n8 0\n", {"arm.mprim:2:", "Motion_Primitives(degrees):"}},
      {"Motion_Primitives(radians): 1 2 0\n8 0\n", {"arm.mprim:1:", "expected"}},
      {header + "1 2\n8 0\n", {"arm.mprim:1:", "three numbers", "found 2"}},
      {header + "1 2 0 0\n8 0\n", {"arm.mprim:1:", "found 4"}},
      {header + "one 2 0\n8 0\n", {"arm.mprim:1:", "'one'"}},
      {header + "0 2 0\n", {"arm.mprim:1:", "0 rows"}},
      {header + "-1 2 0\n", {"arm.mprim:1:", "-1 rows"}},
      {header + "99999999 2 0\n", {"arm.mprim:1:", "99999999 rows"}},
      {header + "99999999999 2 0\n", {"arm.mprim:1:", "'99999999999'"}},
      {header + "1 2 2\n8 0\n", {"arm.mprim:1:", "2 short primitives of 1"}},
      {header + "1 2 -1\n8 0\n", {"arm.mprim:1:", "-1 short"}},
      {header + "1 3 0\n8 0 0\n", {"arm.mprim:1:", "3 columns", "2 joints"}},
      {header + "2 2 0\n8 0\n", {"arm.mprim:2:", "2 rows announced, 1 found"}},
      {header + "1 2 0\n8 0\n0 8\n", {"arm.mprim:3:", "after the 1 rows"}},
      {header + "1 2 0\n8\n", {"arm.mprim:2:", "expected 2 numbers, found 1"}},
      {header + "1 2 0\n\n8 0 0\n", {"arm.mprim:3:", "expected 2 numbers, found 3"}},
      {header + "1 2 0\n8 far\n", {"arm.mprim:2:", "'far'"}},
      {header + "1 2 0\n8 1.5\n", {"arm.mprim:2:", "'1.5'"}},
      {header + "2 2 0\n8 0\n0 0\n", {"arm.mprim:3:", "zeros"}},
      {header + "1 2 0\n40000 0\n", {"arm.mprim:2:", "40000"}},
  };
  for (const Case& test : cases) {
    SCOPED_TRACE(test.text);
    ExpectInputError([&] { Parse(test.text); }, test.message);
  }
}

TEST(MotionPrimitives, RefusesAFileThatIsNotThere) {
  ExpectInputError([] { LoadMotionPrimitives("/nowhere/arm.mprim", 2); },
                   {"/nowhere/arm.mprim", "cannot be opened"});
}

TEST(MotionPrimitives, FetchMovesAreThoseOfTheStudy) {
  const MotionPrimitives primitives =
      LoadMotionPrimitives(PLANBENCH_SOURCE_DIR "/robots/fetch/fetch.mprim", 8);
  ASSERT_EQ(primitives.long_moves.size(), 5U);
  ASSERT_EQ(primitives.short_moves.size(), 8U);
  for (std::size_t j = 0; j < 8; ++j) {
    std::vector<int> row(8, 0);
    row[j] = 8;
    EXPECT_EQ(primitives.short_moves[j], row);
    row[j] = 15;
    if (j < 5) {
      EXPECT_EQ(primitives.long_moves[j], row);
    }
  }
}

TEST(MotionPrimitives, ReadsThePublishedFile) {
  PLANBENCH_NEED_SHARED_DATA("paper/fetch.mprim");
  const MotionPrimitives published =
      LoadMotionPrimitives(SharedData("paper/fetch.mprim").string(), 8);
  const MotionPrimitives own =
      LoadMotionPrimitives(PLANBENCH_SOURCE_DIR "/robots/fetch/fetch.mprim", 8);
  EXPECT_EQ(published.long_moves, own.long_moves);
  EXPECT_EQ(published.short_moves, own.short_moves);
}

}  // namespace
}  // namespace planbench
