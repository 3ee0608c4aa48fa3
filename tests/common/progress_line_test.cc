#include "common/progress_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What is on stderr after `done` of `total` pieces of work, `earlier` of them done before.
std::string Shown(int total, int earlier, int done) {
  testing::internal::CaptureStderr();
  {
    ProgressLine line(total, earlier);
    if (done > earlier) line.Show(done, "shelf");
  }
  return testing::internal::GetCapturedStderr();
}

TEST(ProgressLineTest, ShowsBarCountAndText) {
  EXPECT_THAT(Shown(8, 0, 4),
              HasSubstr("[##########..........] 4/8  0:00 (about 0:00 left)  shelf"));
  EXPECT_THAT(Shown(1, 0, 1), HasSubstr("[####################] 1/1"));
  EXPECT_THAT(Shown(0, 0, 0), HasSubstr("0/0"));
  EXPECT_EQ(Shown(8, 0, 4).back(), '\n');
}

TEST(ProgressLineTest, EstimatesWhatIsLeftByWhatItHasSeen) {
  EXPECT_THAT(Shown(8, 3, 4), HasSubstr("left)"));
  EXPECT_THAT(Shown(8, 4, 4), Not(HasSubstr("left)")));  // nothing seen
  EXPECT_THAT(Shown(8, 4, 8), Not(HasSubstr("left)")));  // nothing left
}

}  // namespace
}  // namespace planbench
