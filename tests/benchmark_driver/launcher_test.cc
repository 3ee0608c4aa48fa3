#include "benchmark_driver/launcher.h"

#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

DriverOptions WithPlanners(std::vector<std::string> planners) {
  DriverOptions options;
  options.planners = std::move(planners);
  return options;
}

class RequireKnownPlannersTest : public testing::Test {
 protected:
  RequireKnownPlannersTest() {
    for (const char* program : {"planner_rrtc", "planner_ara", "logger"})
      programs_.Write(program, "");
  }
  void Require(const DriverOptions& options) { RequireKnownPlanners(options, programs_.path()); }

 private:
  TemporaryFolder programs_;
};

TEST_F(RequireKnownPlannersTest, OwnPlannersAndCommandsAreKnown) {
  DriverOptions options = WithPlanners({"ara", "rrtc", "mine"});
  options.planner_commands = {{"mine", "./mine"}};
  options.planner_settings = {{"ara", "epsilon=1"}};
  EXPECT_NO_THROW(Require(options));
}

TEST_F(RequireKnownPlannersTest, UnknownPlannerIsNamedWithThoseKnown) {
  ExpectInputError(
      [&] {
        Require(WithPlanners({"ara", "prm"}));
      },
      {"--planners", "'prm'", "ara, rrtc", "--planner-command prm="});
}

TEST_F(RequireKnownPlannersTest, CommandsAndSettingsMustBeOfChosenPlanners) {
  DriverOptions options = WithPlanners({"ara"});
  options.planner_commands = {{"mine", "./mine"}};
  ExpectInputError([&] { Require(options); }, {"--planner-command", "'mine'"});
  options = WithPlanners({"ara"});
  options.planner_settings = {{"rrtc", "range=1"}};
  ExpectInputError([&] { Require(options); }, {"--set", "'rrtc'"});
  options = WithPlanners({"mine"});
  options.planner_commands = {{"mine", "./mine"}};
  options.planner_settings = {{"mine", "range=1"}};
  ExpectInputError([&] { Require(options); }, {"--set", "'mine'"});
}

}  // namespace
}  // namespace planbench
