#include "planner_rrtc/ompl_joint_space.h"

#include <gtest/gtest.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/StateSampler.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/numbers.h"

namespace planbench {
namespace {

namespace ob = ompl::base;

class OmplJointSpaceTest : public testing::Test {
 protected:
  OmplJointSpaceTest() { space_->setup(); }

  double Distance(const std::vector<double>& a, const std::vector<double>& b) const {
    return space_->distance(State(a).get(), State(b).get());
  }

  ob::ScopedState<> State(const std::vector<double>& q) const {
    ob::ScopedState<> state(space_);
    std::copy(q.begin(), q.end(), OmplPositions(state.get()));
    return state;
  }

  const JointSpace joints_{{{"turn", true, false, -kPi, kPi, 1},
                            {"bend", false, false, -1, 2, 1},
                            {"slide", false, true, 0, 0.4, 1},
                            {"roll", true, false, -kPi, kPi, 1}}};
  const std::shared_ptr<OmplJointSpace> space_ =
      std::make_shared<OmplJointSpace>(joints_, Metric::kL2);
};

TEST_F(OmplJointSpaceTest, PassesTheSanityChecksOfOmpl) { EXPECT_NO_THROW(space_->sanityChecks()); }

TEST_F(OmplJointSpaceTest, DistancesAndMotionsAreThoseOfTheJointSpace) {
  EXPECT_NEAR(Distance({3, 0, 0, 0}, {-3, 0, 0, 0}), 2 * kPi - 6, 1e-12);
  EXPECT_NEAR(Distance({kPi, 0, 0, 0}, {-kPi, 0, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(Distance({0, -1, 0, 0}, {0, 2, 0.4, 0}), std::hypot(3, 0.4), 1e-12);
  const ob::StateSamplerPtr sampler = space_->allocDefaultStateSampler();
  ob::ScopedState<> a(space_);
  ob::ScopedState<> b(space_);
  ob::ScopedState<> between(space_);
  for (int i = 0; i < 1000; ++i) {
    sampler->sampleUniform(a.get());
    sampler->sampleUniform(b.get());
    const std::span<const double> from(OmplPositions(a.get()), 4);
    const std::span<const double> to(OmplPositions(b.get()), 4);
    EXPECT_NEAR(space_->distance(a.get(), b.get()), joints_.Distance(from, to), 1e-12);
    EXPECT_LE(space_->distance(a.get(), b.get()), space_->getMaximumExtent());
    for (const double t : {0.0, 0.3, 1.0}) {
      space_->interpolate(a.get(), b.get(), t, between.get());
      std::vector<double> expected(4);
      joints_.Interpolate(from, to, t, expected);
      for (std::size_t j = 0; j < 4; ++j) {
        EXPECT_NEAR(OmplPositions(between.get())[j], expected[j], 1e-12);
      }
    }
  }
}

TEST_F(OmplJointSpaceTest, TheSumOfDistancesIsTheOtherMetric) {
  const auto sums = std::make_shared<OmplJointSpace>(joints_, Metric::kSum);
  EXPECT_NO_THROW(sums->sanityChecks());
  ob::ScopedState<> a(sums);
  ob::ScopedState<> b(sums);
  sums->SetPositions(a.get(), {3, 0, 0.1, 0});
  sums->SetPositions(b.get(), {-3, 1, 0.3, 1});
  EXPECT_NEAR(sums->distance(a.get(), b.get()), 2 * kPi - 6 + 1 + 0.2 + 1, 1e-12);
  EXPECT_NEAR(sums->getMaximumExtent(), 2 * kPi + 3 + 0.4 + 2 * kPi, 1e-12);
  EXPECT_NEAR(space_->getMaximumExtent(), std::hypot(kPi, 3, std::hypot(0.4, kPi)), 1e-12);
}

TEST_F(OmplJointSpaceTest, InterpolatesTheShortWay) {
  ob::ScopedState<> middle(space_);
  space_->interpolate(State({3, 0, 0.1, 0}).get(), State({-2.9, 1, 0.3, 0}).get(), 0.5,
                      middle.get());
  const double* q = OmplPositions(middle.get());
  EXPECT_NEAR(q[0], 3 + (2 * kPi - 5.9) / 2 - 2 * kPi, 1e-12);
  EXPECT_NEAR(q[1], 0.5, 1e-12);
  EXPECT_NEAR(q[2], 0.2, 1e-12);
}

TEST_F(OmplJointSpaceTest, InterpolatesInPlace) {
  ob::ScopedState<> state = State({3, 0, 0.1, 1});
  space_->interpolate(state.get(), State({-2.9, 1, 0.3, 1}).get(), 0.5, state.get());
  EXPECT_NEAR(OmplPositions(state.get())[1], 0.5, 1e-12);
}

TEST_F(OmplJointSpaceTest, BoundsWrapAndClamp) {
  ob::ScopedState<> state = State({4, 3, -1, 0});
  EXPECT_FALSE(space_->satisfiesBounds(state.get()));
  space_->enforceBounds(state.get());
  EXPECT_TRUE(space_->satisfiesBounds(state.get()));
  const double* q = OmplPositions(state.get());
  EXPECT_NEAR(q[0], 4 - 2 * kPi, 1e-12);
  EXPECT_EQ(q[1], 2);
  EXPECT_EQ(q[2], 0);
}

TEST_F(OmplJointSpaceTest, FreedStatesAreUsedAgainAndStatesInUseAreNot) {
  ob::State* first = space_->allocState();
  ob::State* second = space_->allocState();
  EXPECT_NE(first, second);
  space_->freeState(first);
  EXPECT_EQ(space_->allocState(), first);
  ob::State* third = space_->allocState();
  EXPECT_NE(third, first);
  for (ob::State* state : {first, second, third}) space_->freeState(state);
}

TEST_F(OmplJointSpaceTest, ProjectsOntoTheFirstJoints) {
  const ob::ProjectionEvaluatorPtr projection = space_->getDefaultProjection();
  ASSERT_EQ(projection->getDimension(), 3u);
  Eigen::VectorXd projected(3);
  projection->project(State({1, 0.5, 0.3, 2}).get(), projected);
  EXPECT_EQ(projected, Eigen::Vector3d(1, 0.5, 0.3));
}

class OmplSamplerTest : public OmplJointSpaceTest, public testing::WithParamInterface<SamplerKind> {
 protected:
  std::vector<double> DrawFirst(const ob::StateSamplerPtr& sampler) {
    ob::ScopedState<> state(space_);
    sampler->sampleUniform(state.get());
    return {OmplPositions(state.get()), OmplPositions(state.get()) + 4};
  }
};

TEST_P(OmplSamplerTest, SeedsCountUpAndSamplesAreCounted) {
  space_->SeedSamplers(GetParam(), 5);
  const std::vector<double> first = DrawFirst(space_->allocStateSampler());
  const std::vector<double> second = DrawFirst(space_->allocStateSampler());
  EXPECT_EQ(space_->num_samples(), 2);
  space_->SeedSamplers(GetParam(), 6);
  EXPECT_EQ(space_->num_samples(), 0);
  EXPECT_EQ(DrawFirst(space_->allocStateSampler()), second);
  space_->SeedSamplers(GetParam(), 5);
  ompl::RNG().uniform01();  // Another generator in between does not matter.
  EXPECT_EQ(DrawFirst(space_->allocStateSampler()), first);
}

TEST_P(OmplSamplerTest, SamplesNearAConfigurationStayNearAndWithinLimits) {
  space_->SeedSamplers(GetParam(), 1);
  const ob::StateSamplerPtr sampler = space_->allocStateSampler();
  const ob::ScopedState<> center = State({3.1, 1.95, 0.2, 0});
  ob::ScopedState<> state(space_);
  for (int i = 0; i < 200; ++i) {
    sampler->sampleUniformNear(state.get(), center.get(), 0.1);
    EXPECT_TRUE(space_->satisfiesBounds(state.get()));
    EXPECT_LE(space_->distance(center.get(), state.get()), 0.1 * 2 + 1e-9);
    sampler->sampleGaussian(state.get(), center.get(), 0.1);
    EXPECT_TRUE(space_->satisfiesBounds(state.get()));
    EXPECT_LE(space_->distance(center.get(), state.get()), 2);
  }
}

TEST_P(OmplSamplerTest, SamplesNearAConfigurationDoNotGatherAtTheLimits) {
  space_->SeedSamplers(GetParam(), 1);
  const ob::StateSamplerPtr sampler = space_->allocStateSampler();
  const ob::ScopedState<> center = State({3, 1.5, 0.3, 0});
  ob::ScopedState<> state(space_);
  constexpr int kSamples = 1000;
  std::vector<double> sums(4);
  for (int i = 0; i < kSamples; ++i) {
    sampler->sampleUniformNear(state.get(), center.get(), 1);
    const double* q = OmplPositions(state.get());
    EXPECT_NE(q[1], 2);
    EXPECT_NE(q[2], 0);
    EXPECT_NE(q[2], 0.4);
    for (int j = 0; j < 4; ++j) {
      sums[static_cast<std::size_t>(j)] +=
          joints_.Difference(j, OmplPositions(center.get())[j], q[j]);
    }
  }
  // From 1 below to what the limits leave above.
  EXPECT_NEAR(sums[0] / kSamples, 0, 0.1);
  EXPECT_NEAR(sums[1] / kSamples, -0.25, 0.1);
  EXPECT_NEAR(sums[2] / kSamples, -0.1, 0.03);

  // Further than there is anything: anywhere, and no number is lost.
  for (int i = 0; i < 100; ++i) {
    sampler->sampleUniformNear(state.get(), center.get(), 1e308);
    EXPECT_TRUE(space_->satisfiesBounds(state.get()));
  }
}

INSTANTIATE_TEST_SUITE_P(Samplers, OmplSamplerTest,
                         testing::Values(SamplerKind::kUniform, SamplerKind::kHalton),
                         [](const auto& info) { return std::string(EnumName(info.param)); });

}  // namespace
}  // namespace planbench
