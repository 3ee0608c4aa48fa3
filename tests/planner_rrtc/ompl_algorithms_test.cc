#include "planner_rrtc/ompl_algorithms.h"

#include <gtest/gtest.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <memory>
#include <string>

namespace planbench {
namespace {

namespace ob = ompl::base;

/// No motion is free; counts how many it was asked for.
class NothingFree final : public ob::MotionValidator {
 public:
  using ob::MotionValidator::MotionValidator;

  bool checkMotion(const ob::State* /*s1*/, const ob::State* /*s2*/) const override {
    ++num_asked;
    return false;
  }
  bool checkMotion(const ob::State* s1, const ob::State* s2,
                   std::pair<ob::State*, double>& /*last_valid*/) const override {
    return checkMotion(s1, s2);
  }

  mutable int num_asked = 0;
};

/// As the edge checker has it once the limit has come: no edge is free any more, and each that is
/// asked for all the same costs a search of the roadmap.
TEST(OmplAlgorithms, LazyRoadmapsTryNoPathOnceTheyAreToEnd) {
  const auto space = std::make_shared<ob::RealVectorStateSpace>(2);
  space->setBounds(0, 1);
  for (const std::string name : {"LazyPRM", "LazyPRMstar"}) {
    for (int most = 1; most <= 10; ++most) {
      const auto si = std::make_shared<ob::SpaceInformation>(space);
      const auto motions = std::make_shared<NothingFree>(si);
      si->setMotionValidator(motions);
      si->setStateValidityChecker([](const ob::State*) { return true; });
      si->setup();
      ob::ScopedState<> start(space), goal(space);
      start = 0.1;
      goal = 0.9;
      const auto problem = std::make_shared<ob::ProblemDefinition>(si);
      problem->setStartAndGoalStates(start, goal);
      problem->setOptimizationObjective(std::make_shared<ob::PathLengthOptimizationObjective>(si));
      const ob::PlannerPtr planner = FindOmplAlgorithm(name)->make(si);
      planner->setProblemDefinition(problem);
      planner->setup();
      planner->solve(ob::PlannerTerminationCondition([&] { return motions->num_asked >= most; }));
      EXPECT_EQ(motions->num_asked, most) << name;
    }
  }
}

}  // namespace
}  // namespace planbench
