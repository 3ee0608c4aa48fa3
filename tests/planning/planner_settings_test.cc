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

}  // namespace
}  // namespace planbench
