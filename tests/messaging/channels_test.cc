#include "messaging/channels.h"

#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

TEST(ChannelsTest, CarryThePlannersNameInUpperCase) {
  const PlannerChannels channels("ara-Fine_2");
  EXPECT_EQ(channels.request, "PLAN_REQUEST_ARA_FINE_2");
  EXPECT_EQ(channels.ack, "PLAN_ACK_ARA_FINE_2");
  EXPECT_EQ(channels.progress, "PLAN_PROGRESS_ARA_FINE_2");
  EXPECT_EQ(channels.result, "PLAN_RESULT_ARA_FINE_2");
  EXPECT_EQ(channels.cancel, "PLAN_CANCEL_ARA_FINE_2");
}

TEST(ChannelsTest, LongestNameFitsLcmsChannelLength) {
  const PlannerChannels channels(std::string(40, 'x'));
  for (const std::string& name :
       {channels.request, channels.ack, channels.progress, channels.result, channels.cancel}) {
    EXPECT_LE(name.size(), 63u);
  }
}

TEST(ChannelsTest, RefuseNamesThatCannotBeChannels) {
  for (const std::string& name :
       {std::string(), std::string(41, 'x'), std::string("a b"), std::string("a.b"),
        std::string("a/b"), std::string("\xc3\xa9")}) {
    ExpectInputError([&] { RequireNodeName(name); }, {"'" + name + "'", "40"});
    ExpectInputError([&] { PlannerChannels{name}; }, {"'" + name + "'"});
  }
}

}  // namespace
}  // namespace planbench
