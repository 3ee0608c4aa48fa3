#include <gtest/gtest.h>

#include <optional>

#include "scene/scene.h"

namespace planbench {
namespace {

TEST(AllowedCollisionMatrix, EntriesHoldInBothOrders) {
  AllowedCollisionMatrix matrix;
  matrix.SetEntry("b", "a", true);
  EXPECT_TRUE(matrix.Allowed("a", "b"));
  EXPECT_TRUE(matrix.Allowed("b", "a"));
  EXPECT_FALSE(matrix.Allowed("a", "c"));
  matrix.SetEntry("a", "b", false);
  EXPECT_FALSE(matrix.Allowed("b", "a"));
  EXPECT_EQ(matrix.entries().size(), 1);
}

TEST(AllowedCollisionMatrix, TellsEntriesFromWhatFollowsWithoutOne) {
  AllowedCollisionMatrix matrix;
  matrix.SetEntry("b", "a", false);
  matrix.SetDefaultEntry("c", true);
  EXPECT_EQ(matrix.Entry("a", "b"), std::optional(false));
  EXPECT_EQ(matrix.Entry("a", "c"), std::nullopt);
  EXPECT_EQ(matrix.Simplified(), matrix) << "links that a joint connects are then checked";
  matrix.SetEntry("a", "c", true);
  EXPECT_EQ(matrix.Entry("c", "a"), std::optional(true));
  EXPECT_EQ(matrix.Simplified().Entry("c", "a"), std::nullopt);
}

TEST(AllowedCollisionMatrix, DefaultsDecideWhereNoEntryDoes) {
  AllowedCollisionMatrix matrix;
  matrix.SetDefaultEntry("yes", true);
  matrix.SetDefaultEntry("also", true);
  matrix.SetDefaultEntry("no", false);
  EXPECT_TRUE(matrix.Allowed("yes", "also"));
  EXPECT_TRUE(matrix.Allowed("yes", "other"));
  EXPECT_TRUE(matrix.Allowed("other", "yes"));
  EXPECT_FALSE(matrix.Allowed("no", "other"));
  EXPECT_FALSE(matrix.Allowed("yes", "no"));
  EXPECT_FALSE(matrix.Allowed("other", "another"));
  matrix.SetEntry("yes", "no", true);
  EXPECT_TRUE(matrix.Allowed("no", "yes"));
}

TEST(AllowedCollisionMatrix, SimplifiedAllowsTheSamePairs) {
  AllowedCollisionMatrix matrix;
  matrix.SetDefaultEntry("d", true);
  const std::string names[] = {"a", "b", "c", "d"};
  bool allowed = false;
  for (const std::string& a : names) {
    for (const std::string& b : names) {
      matrix.SetEntry(a, b, allowed);
      allowed = !allowed;
    }
  }
  const AllowedCollisionMatrix simplified = matrix.Simplified();
  EXPECT_LT(simplified.entries().size(), matrix.entries().size());
  for (const std::string& a : names) {
    for (const std::string& b : names) {
      if (a == b) continue;
      EXPECT_EQ(simplified.Allowed(a, b), matrix.Allowed(a, b)) << a << " " << b;
    }
  }
  EXPECT_EQ(simplified.Simplified(), simplified);
}

}  // namespace
}  // namespace planbench
