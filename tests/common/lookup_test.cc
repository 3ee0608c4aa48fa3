#include "common/lookup.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace planbench {
namespace {

TEST(LookupTest, GivesWhatAMapHolds) {
  const std::map<std::string, int> numbers = {{"one", 1}};
  EXPECT_EQ(Lookup(numbers, "one"), 1);
  EXPECT_FALSE(Lookup(numbers, "two"));
}

}  // namespace
}  // namespace planbench
