#include "benchmark_driver/progress_bar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planbench {
namespace {

using testing::HasSubstr;

RunRecordMessage Record(const std::string& planner, PlanStatus status) {
  RunRecordMessage record;
  record.planner = planner;
  record.status = status;
  return record;
}

TEST(ProgressBarTest, CountsRunsAndSuccessesByPlannerAndDirection) {
  testing::internal::CaptureStderr();
  {
    ProgressBar bar(8);
    bar.AddEarlier(Record("ara", PlanStatus::kSolved));
    bar.Add(Record("ara", PlanStatus::kTimedOut));
    bar.Add(Record("rrtc", PlanStatus::kSolved));
    RunRecordMessage backward = Record("rrtc", PlanStatus::kInvalidPath);
    backward.request.direction = Direction::kBackward;
    bar.Add(backward);
  }
  const std::string shown = testing::internal::GetCapturedStderr();
  EXPECT_THAT(shown, HasSubstr("[##########..........] 4/8"));
  EXPECT_THAT(shown, HasSubstr("ara forward 1/2"));
  EXPECT_THAT(shown, HasSubstr("rrtc forward 1/1"));
  EXPECT_THAT(shown, HasSubstr("rrtc backward 0/1"));
  EXPECT_THAT(shown, HasSubstr("left)"));
  EXPECT_EQ(shown.back(), '\n');
}

TEST(ProgressBarTest, ShowsTheEnd) {
  testing::internal::CaptureStderr();
  {
    ProgressBar bar(1);
    bar.Add(Record("ara", PlanStatus::kSolved));
  }
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("[####################] 1/1"));
  testing::internal::CaptureStderr();
  { const ProgressBar nothing_to_do(0); }
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("0/0"));
}

}  // namespace
}  // namespace planbench
