#include "planner_rrtc/rrt_connect.h"

#include <gtest/gtest.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Exception.h>

#include "planner_rrtc/joint_sampler.h"
#include "support/planning_problems.h"

namespace planbench {
namespace {

namespace ob = ompl::base;

/// RrtConnect as a planner of OMPL, without Planner around it.
class RrtConnectTest : public testing::Test {
 protected:
  RrtConnectTest() {
    checker_->SetScene(PostsScene(), robot_.model.DefaultPositions());
    states_->set_edges(&edges_);
    motions_->set_edges(&edges_);
    si_->setStateValidityChecker(states_);
    si_->setMotionValidator(motions_);
    space_->setStateSamplerAllocator([this](const ob::StateSpace* space) {
      return std::make_shared<JointSampler>(space, joints_, SamplerKind::kUniform, 1,
                                            &num_samples_);
    });
    si_->setup();
  }

  ob::ProblemDefinitionPtr Problem(const Configuration& start, const Configuration& goal) {
    auto problem = std::make_shared<ob::ProblemDefinition>(si_);
    ob::State* state = space_->allocState();
    space_->SetPositions(state, start);
    problem->addStartState(state);
    space_->SetPositions(state, goal);
    problem->setGoalState(state);
    space_->freeState(state);
    return problem;
  }

  Path Solve(RrtConnect* planner, const ob::ProblemDefinitionPtr& problem) {
    planner->clear();
    planner->setProblemDefinition(problem);
    if (!planner->isSetup()) planner->setup();
    EXPECT_TRUE(planner->solve(ob::plannerNonTerminatingCondition()));
    Path path;
    const auto* found = problem->getSolutionPath()->as<ompl::geometric::PathGeometric>();
    for (std::size_t i = 0; i < found->getStateCount(); ++i) {
      const double* q = OmplPositions(found->getState(static_cast<unsigned int>(i)));
      path.emplace_back(q, q + joints_.size());
    }
    return path;
  }

  const Robot robot_ = LoadPlanarRobot();
  const JointSpace& joints_ = robot_.groups.front().space;
  const std::unique_ptr<CollisionChecker> checker_ =
      MakeCollisionChecker(robot_, robot_.groups.front(), CollisionModel::kSpheres);
  EdgeChecker edges_{checker_.get(), 0.02};
  const std::shared_ptr<OmplJointSpace> space_ = std::make_shared<OmplJointSpace>(joints_);
  const ob::SpaceInformationPtr si_ = std::make_shared<ob::SpaceInformation>(space_);
  const std::shared_ptr<EdgeStateValidity> states_ = std::make_shared<EdgeStateValidity>(si_);
  const std::shared_ptr<EdgeMotionValidator> motions_ = std::make_shared<EdgeMotionValidator>(si_);
  std::int64_t num_samples_ = 0;
};

TEST_F(RrtConnectTest, MotionsAreValidAndWithinTheRange) {
  for (const Extension extension : {Extension::kStep, Extension::kConnect}) {
    RrtConnect planner(si_, {.range = 0.3, .extension = extension});
    const Path path = Solve(&planner, Problem({0.6, 0, 0}, {-0.6, 0, 0}));
    EXPECT_EQ(path.front(), (Configuration{0.6, 0, 0}));
    EXPECT_EQ(path.back(), (Configuration{-0.6, 0, 0}));
    for (std::size_t i = 1; i < path.size(); ++i) {
      EXPECT_LE(joints_.Distance(path[i - 1], path[i]), 0.3 + 1e-6);
      EXPECT_TRUE(edges_.IsValidEdge(path[i - 1], path[i]));
    }
  }
}

TEST_F(RrtConnectTest, AClearedPlannerIsAsNew) {
  RrtConnect planner(si_, {});
  const auto solve = [&] { return Solve(&planner, Problem({0.6, 0, 0}, {-0.6, 0, 0})); };
  const Path first = solve();
  const std::int64_t iterations = planner.counters().iterations;
  Solve(&planner, Problem({1.5, 0.5, 0.5}, {-1.5, 0.5, -0.5}));
  EXPECT_EQ(solve(), first);
  EXPECT_EQ(planner.counters().iterations, iterations);
}

TEST_F(RrtConnectTest, ADynamicDomainTurnsSamplesAway) {
  // Stretched between two posts: most motions out of either end collide.
  RrtConnect planner(si_, {.range = 0.5, .extension = Extension::kStep, .domain_radius = 0.6});
  Solve(&planner, Problem({0.25, 0, 0}, {-0.25, 0, 0}));
  EXPECT_GT(planner.counters().out_of_domain, 0);
  EXPECT_LT(planner.counters().out_of_domain, planner.counters().iterations);
}

TEST_F(RrtConnectTest, InvalidEndsAreToldApart) {
  RrtConnect planner(si_, {});
  const auto status = [&](const Configuration& start, const Configuration& goal) {
    planner.clear();
    planner.setProblemDefinition(Problem(start, goal));
    if (!planner.isSetup()) planner.setup();
    return planner.solve(ob::plannerNonTerminatingCondition());
  };
  const Configuration free = {0.6, 0, 0};
  const Configuration blocked = {0, 0, 0};
  EXPECT_EQ(status(blocked, free), ob::PlannerStatus::INVALID_START);
  EXPECT_EQ(status(free, blocked), ob::PlannerStatus::INVALID_GOAL);
}

TEST_F(RrtConnectTest, StopsWhenToldAndGoesOnAfterwards) {
  RrtConnect planner(si_, {.range = 0.3});
  const ob::ProblemDefinitionPtr problem = Problem({0.6, 0, 0}, {-0.6, 0, 0});
  planner.setProblemDefinition(problem);
  planner.setup();
  int looks = 0;
  const ob::PlannerTerminationCondition after_one([&looks] { return ++looks > 1; });
  EXPECT_EQ(planner.solve(after_one), ob::PlannerStatus::TIMEOUT);
  EXPECT_FALSE(problem->hasSolution());
  EXPECT_TRUE(planner.solve(ob::plannerNonTerminatingCondition()));
  EXPECT_TRUE(problem->hasExactSolution());
}

TEST_F(RrtConnectTest, RefusesOtherSpacesAndValidators) {
  const auto plain =
      std::make_shared<ob::SpaceInformation>(std::make_shared<ob::RealVectorStateSpace>(2));
  EXPECT_THROW(RrtConnect(plain, {}), ompl::Exception);
  const auto si = std::make_shared<ob::SpaceInformation>(space_);
  si->setStateValidityChecker(states_);
  RrtConnect planner(si, {});
  EXPECT_THROW(planner.setup(), ompl::Exception);
}

}  // namespace
}  // namespace planbench
