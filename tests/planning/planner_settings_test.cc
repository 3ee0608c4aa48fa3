#include "planning/planner_settings.h"

#include "tests/support/expect_input_error.h"
#include "tests/support/planning_problems.h"

namespace planbench {
namespace {

TEST(PlannerSettings, MessagesSayWhereAnOverrideWasWritten) {
  const YamlNode settings =
      LoadPlannerSettings(LoadPlanarRobot(), "none", "", {"range=far", "ompl.bias=x", "step=y"},
                          {"range=a.yaml:4: c.set.range", "ompl.bias=a.yaml:5: c.set.ompl.bias"});
  ExpectInputError([&] { settings.At("range").Double(); },
                   {"a.yaml:4: c.set.range: expected a number, found 'far'"});
  ExpectInputError([&] { settings.At("ompl").At("bias").Double(); },
                   {"a.yaml:5: c.set.ompl.bias: expected a number, found 'x'"});
  ExpectInputError([&] { settings.At("step").Double(); }, {"--set step: expected a number"});
}

TEST(PlannerSettings, AFileThatCannotBeReadIsToldWithTheLineThatNamesIt) {
  Robot robot = LoadPlanarRobot();
  const YamlNode planners = YamlNode::Parse("\nara: nowhere.yaml", "robot.yaml");
  robot.planner_settings.emplace("ara", planners.At("ara"));
  ExpectInputError(
      [&] { LoadPlannerSettings(robot, "ara", "", {}); },
      {"robot.yaml:2: ara: " + robot.folder.string() + "/nowhere.yaml: cannot be opened"});
}

}  // namespace
}  // namespace planbench
