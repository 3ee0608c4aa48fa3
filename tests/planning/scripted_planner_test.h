#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "support/planning_problems.h"
#include "support/scripted_planner.h"

namespace planbench {

/// The planar robot from one side to the other, by a planner whose search is the test's.
class ScriptedPlannerTest : public testing::Test {
 protected:
  PlanResult Plan(ScriptedPlanner::Script script, const PlanRequest& request,
                  const Scene& scene = EmptyPlanarScene(), PlanControl* control = nullptr) {
    ScriptedPlanner planner(robot_, std::move(script));
    PlanResult result = planner.Plan(request, scene, control);
    num_searches_ = planner.num_searches;
    return result;
  }
  PlanRequest Request(double tolerance = 0) const {
    return MakeRequest(robot_, start_, goal_, tolerance);
  }

  const Robot robot_ = LoadPlanarRobot();
  const Configuration start_ = {0.6, 0, 0};
  const Configuration goal_ = {-0.6, 0, 0};
  int num_searches_ = 0;
};

}  // namespace planbench
