#include "benchmark_driver/unasked_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(UnaskedRunsTest, TheFirstForAReasonIsToldAndAllAreCounted) {
  UnaskedRuns runs;
  testing::internal::CaptureStdout();
  runs.Add("run/cans/1/arm/forward/1", "arm", "given up: it died");
  runs.Add("run/cans/2/arm/forward/1", "arm", "given up: it died");
  runs.Add("run/cans/1/leg/forward/1", "leg", "it is another");
  const std::string told = testing::internal::GetCapturedStdout();
  EXPECT_THAT(told, HasSubstr("run/cans/1/arm/forward/1: no answer: given up: it died"));
  EXPECT_THAT(told, Not(HasSubstr("run/cans/2/arm")));
  EXPECT_THAT(told, HasSubstr("run/cans/1/leg/forward/1: no answer: it is another"));
  EXPECT_THAT(runs.Lines({{"arm", "it died"}, {"eye", "it is blind"}}),
              ElementsAre("the planner 'arm': given up: it died (2 runs)",
                          "the planner 'eye': given up: it is blind (0 runs)",
                          "the planner 'leg': it is another (1 run)"));
}

}  // namespace
}  // namespace planbench
