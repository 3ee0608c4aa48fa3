#include "benchmark_driver/progress_bar.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planbench {
namespace {

RunRecordMessage Record(const std::string& planner, PlanStatus status) {
  RunRecordMessage record;
  record.planner = planner;
  record.status = status;
  record.roundtrip_time_s = 1;
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

TEST(ProgressBarTest, RunsThatWereNotAskedForAreNoAttempts) {
  testing::internal::CaptureStderr();
  {
    RunRows runs;
    RunRecordMessage not_asked = Record("ara", PlanStatus::kNoAnswer);
    not_asked.roundtrip_time_s = 0;
    runs.Add(not_asked);
    ProgressBar bar(2, runs);
    bar.Add(runs.Add(Record("ara", PlanStatus::kSolved)));
  }
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::ContainsRegex("\\] 2/2 .* ara 1/1\n"));
}

TEST(ProgressBarTest, ARunThatIsToBeRepeatedCountsWhenItHasBeen) {
  testing::internal::CaptureStderr();
  {
    RunRows runs;
    RunRecordMessage record = Record("ara", PlanStatus::kTimedOut);
    record.request_id = fmt::format("{}", 1);  // GCC 12 warns falsely of literals
    runs.Add(record, false, true);
    ProgressBar bar(3, runs);
    record.request_id = fmt::format("{}", 2);
    bar.Add(runs.Add(record, false, true));
    record.status = PlanStatus::kSolved;
    record.result.result.counters["repeats"] = 1;
    bar.Add(runs.Add(record));
    EXPECT_EQ(runs.size(), 2u);
  }
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::ContainsRegex("\\] 1/3  0:00 .*  ara 1/1\n"));
}

}  // namespace
}  // namespace planbench
