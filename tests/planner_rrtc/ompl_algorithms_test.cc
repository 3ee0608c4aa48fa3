#include "planner_rrtc/ompl_algorithms.h"

#include <gtest/gtest.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <cmath>
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

/// The unit square. Counts its states that have not been freed.
class CountingSquare final : public ob::RealVectorStateSpace {
 public:
  CountingSquare() : ob::RealVectorStateSpace(2) { setBounds(0, 1); }

  ob::State* allocState() const override {
    ++num_states;
    return ob::RealVectorStateSpace::allocState();
  }
  void freeState(ob::State* state) const override {
    --num_states;
    ob::RealVectorStateSpace::freeState(state);
  }

  mutable int num_states = 0;
};

/// Asks OMPL's algorithm for a path across a square. Nothing of the planner is left afterwards.
void CrossSquare(const std::string& algorithm, const ob::SpaceInformationPtr& si,
                 const ob::PlannerTerminationConditionFn& stop) {
  ob::ScopedState<> start(si), goal(si);
  start = 0.1;
  goal = 0.9;
  const auto problem = std::make_shared<ob::ProblemDefinition>(si);
  problem->setStartAndGoalStates(start, goal);
  problem->setOptimizationObjective(std::make_shared<ob::PathLengthOptimizationObjective>(si));
  const ob::PlannerPtr planner = FindOmplAlgorithm(algorithm)->make(si);
  planner->setProblemDefinition(problem);
  planner->setup();
  planner->solve(ob::PlannerTerminationCondition(stop));
}

/// As the edge checker has it once the limit has come: no edge is free any more, and each that is
/// asked for all the same costs a search of the roadmap.
TEST(OmplAlgorithms, LazyRoadmapsTryNoPathOnceTheyAreToEnd) {
  for (const std::string name : {"LazyPRM", "LazyPRMstar"}) {
    for (int most = 1; most <= 10; ++most) {
      const auto si = std::make_shared<ob::SpaceInformation>(std::make_shared<CountingSquare>());
      const auto motions = std::make_shared<NothingFree>(si);
      si->setMotionValidator(motions);
      si->setStateValidityChecker([](const ob::State*) { return true; });
      si->setup();
      CrossSquare(name, si, [&] { return motions->num_asked >= most; });
      EXPECT_EQ(motions->num_asked, most) << name;
    }
  }
}

/// Whether they take states out of the roadmap, as those within a wall, or not.
TEST(OmplAlgorithms, LazyRoadmapsLeaveNoStatesBehind) {
  for (const std::string name : {"LazyPRM", "LazyPRMstar"}) {
    const auto space = std::make_shared<CountingSquare>();
    const auto si = std::make_shared<ob::SpaceInformation>(space);
    si->setStateValidityChecker([](const ob::State* state) {
      return std::abs(state->as<CountingSquare::StateType>()->values[0] - 0.5) > 0.1;
    });
    si->setup();
    for (int request = 0; request < 3; ++request) {
      int num_looks = 0;
      int most_states = 0;
      CrossSquare(name, si, [&] {
        most_states = std::max(most_states, space->num_states);
        return ++num_looks > 500;
      });
      EXPECT_GT(most_states, 10) << name;
      EXPECT_EQ(space->num_states, 0) << name;
    }
  }
}

}  // namespace
}  // namespace planbench
