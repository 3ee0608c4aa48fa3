#include "benchmark_driver/progress_bar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planbench {
namespace {

RunRecordMessage Record(const std::string& planner, PlanStatus status) {
  RunRecordMessage record;
  record.planner = planner;
  record.status = status;
  return record;
}

TEST(ProgressBarTest, CountsRunsAndSuccessesByPlanner) {
  testing::internal::CaptureStderr();
  {
    RunRows runs;
    runs.Add(Record("ara", PlanStatus::kSolved));
    ProgressBar bar(8, runs);
    bar.Add(runs.Add(Record("ara", PlanStatus::kTimedOut)));
    bar.Add(runs.Add(Record("rrtc", PlanStatus::kSolved)));
    RunRecordMessage backward = Record("rrtc", PlanStatus::kInvalidPath);
    backward.request.direction = Direction::kBackward;
    bar.Add(runs.Add(backward));
    bar.Drop();
  }
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::ContainsRegex("\\] 4/7  0:00 .*  ara 1/2  rrtc 1/2\n"));
}

}  // namespace
}  // namespace planbench
