#include <gtest/gtest.h>

#include "report/page.h"

namespace planbench {
namespace {

TEST(PageSizeTest, ViewsHaveTheRoomThatTheRestLeaves) {
  const Json small = {{"rows", ""}};
  const Json large = {{"rows", std::string(10'000'000, 'x')}};
  const std::size_t room = RoomForViews(large);
  EXPECT_EQ(RoomForViews(small), room + 10'000'000);
  EXPECT_EQ(RoomForViews({{"rows", std::string(kMostPageBytes, 'x')}}), 0u);

  EmbeddedViews views;
  views.by_attempt[0] = std::string(room - 2, 'y');  // in quotes
  const std::size_t page_size = ReportPage(large, views).size();
  EXPECT_LE(page_size, kMostPageBytes);
  EXPECT_GT(page_size, kMostPageBytes - 100) << "three.js counts";
}

}  // namespace
}  // namespace planbench
