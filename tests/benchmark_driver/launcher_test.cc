#include "benchmark_driver/launcher.h"

#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

DriverOptions WithPlanners(std::vector<std::string> planners) {
  DriverOptions options;
  options.planners = std::move(planners);
  return options;
}

TEST(RequireKnownPlannersTest, OwnPlannersAndCommandsAreKnown) {
  DriverOptions options = WithPlanners({"ara", "rrtc", "mine"});
  options.planner_commands = {{"mine", "./mine"}};
  options.planner_settings = {{"ara", "epsilon=1"}};
  EXPECT_NO_THROW(RequireKnownPlanners(options));
}

TEST(RequireKnownPlannersTest, UnknownPlannerIsNamedWithThoseKnown) {
  ExpectInputError(
      [] {
        RequireKnownPlanners(WithPlanners({"ara", "prm"}));
      },
      {"--planners", "'prm'", "ara, rrtc", "--planner-command prm="});
}

TEST(RequireKnownPlannersTest, CommandsAndSettingsMustBeOfChosenPlanners) {
  DriverOptions options = WithPlanners({"ara"});
  options.planner_commands = {{"mine", "./mine"}};
  ExpectInputError([&] { RequireKnownPlanners(options); }, {"--planner-command", "'mine'"});
  options = WithPlanners({"ara"});
  options.planner_settings = {{"rrtc", "range=1"}};
  ExpectInputError([&] { RequireKnownPlanners(options); }, {"--set", "'rrtc'"});
  options = WithPlanners({"mine"});
  options.planner_commands = {{"mine", "./mine"}};
  options.planner_settings = {{"mine", "range=1"}};
  ExpectInputError([&] { RequireKnownPlanners(options); }, {"--set", "'mine'"});
}

}  // namespace
}  // namespace planbench
