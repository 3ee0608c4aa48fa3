#include "common/utime.h"

#include <gtest/gtest.h>

namespace planbench {
namespace {

TEST(UtimeTest, CountsMicrosecondsBeyondTheYear2262Too) {
  EXPECT_EQ(UtimeOf({1'767'323'045, 678'901'999}), 1'767'323'045'678'901);
  EXPECT_EQ(UtimeOf({12'622'780'800, 0}), 12'622'780'800'000'000);  // 2370
}

TEST(UtimeTest, OfNowIsTheTimeOfDay) {
  const std::int64_t before = std::time(nullptr);
  const std::int64_t now = NowUtime();
  EXPECT_GE(now, before * 1'000'000);
  EXPECT_LT(now, (before + 3600) * 1'000'000);
}

}  // namespace
}  // namespace planbench
