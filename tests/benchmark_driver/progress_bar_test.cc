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
    ProgressBar bar(8, {Record("ara", PlanStatus::kSolved)});
    bar.Add(Record("ara", PlanStatus::kTimedOut));
    bar.Add(Record("rrtc", PlanStatus::kSolved));
    RunRecordMessage backward = Record("rrtc", PlanStatus::kInvalidPath);
    backward.request.direction = Direction::kBackward;
    bar.Add(backward);
  }
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("] 4/8  ara forward 1/2  rrtc backward 0/1  rrtc forward 1/1  "));
}

}  // namespace
}  // namespace planbench
