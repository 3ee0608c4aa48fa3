#include "results/shards.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/reproduce.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ShardsTest, AreReadAndJoined) {
  EXPECT_THAT(ParseShards(""), IsEmpty());
  EXPECT_THAT(ParseShards("2/3"), ElementsAre("2/3"));
  EXPECT_THAT(ParseShards("2/3, 1/3, 2/3"), ElementsAre("1/3", "2/3"));
  EXPECT_EQ(JoinShards({"2/3", "1/3"}), "1/3, 2/3");
  EXPECT_EQ(JoinShards({}), "");
  EXPECT_THAT(ShardsOf({}), IsEmpty());
  EXPECT_THAT(ShardsOf({{"shard", "1/2"}}), ElementsAre("1/2"));
}

TEST(ShardsTest, OfAnyCountTheOthersAreMissing) {
  EXPECT_THAT(MissingShards({"2/3"}), ElementsAre("1/3", "3/3"));
  EXPECT_THAT(MissingShards({"1/2", "2/2", "3/3"}), ElementsAre("1/3", "2/3"));
  EXPECT_THAT(MissingShards({}), IsEmpty());
}

TEST(ShardsTest, OnlyASessionOfSeveralWaitsForOthers) {
  EXPECT_THAT(AwaitedShards({{"shard", ""}}), IsEmpty());
  EXPECT_THAT(AwaitedShards({{"shard", "1/3"}}), IsEmpty());
  EXPECT_THAT(AwaitedShards({{"shard", "1/3"}, {kMergedParts, "{}"}}), ElementsAre("2/3", "3/3"));
  EXPECT_THAT(AwaitedShards({{"shard", "1/3, 2/3"}}), ElementsAre("3/3"));
  EXPECT_THAT(AwaitedShards({{"shard", "1/2, 2/2"}}), IsEmpty());
}

}  // namespace
}  // namespace planbench
