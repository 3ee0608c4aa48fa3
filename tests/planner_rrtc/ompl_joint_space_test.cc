#include "planner_rrtc/ompl_joint_space.h"

#include <gtest/gtest.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/StateSampler.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "planner_rrtc/joint_sampler.h"

namespace planbench {
namespace {

namespace ob = ompl::base;
constexpr double kPi = std::numbers::pi;

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
  const std::shared_ptr<OmplJointSpace> space_ = std::make_shared<OmplJointSpace>(joints_);
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
  EXPECT_NE(space_->allocState(), first);
}

TEST_F(OmplJointSpaceTest, ProjectsOntoTheFirstJoints) {
  const ob::ProjectionEvaluatorPtr projection = space_->getDefaultProjection();
  ASSERT_EQ(projection->getDimension(), 3u);
  Eigen::VectorXd projected(3);
  projection->project(State({1, 0.5, 0.3, 2}).get(), projected);
  EXPECT_EQ(projected, Eigen::Vector3d(1, 0.5, 0.3));
}

class JointSamplerTest : public OmplJointSpaceTest,
                         public testing::WithParamInterface<SamplerKind> {
 protected:
  std::vector<std::vector<double>> Draw(std::uint64_t seed, int count) {
    JointSampler sampler(space_.get(), joints_, GetParam(), seed, &num_samples_);
    ob::ScopedState<> state(space_);
    std::vector<std::vector<double>> samples;
    for (int i = 0; i < count; ++i) {
      sampler.sampleUniform(state.get());
      EXPECT_TRUE(space_->satisfiesBounds(state.get()));
      samples.emplace_back(OmplPositions(state.get()), OmplPositions(state.get()) + 4);
    }
    return samples;
  }

  std::int64_t num_samples_ = 0;
};

TEST_P(JointSamplerTest, SpreadsItsSamplesEvenlyOverTheLimits) {
  const std::vector<std::vector<double>> samples = Draw(3, 4000);
  EXPECT_EQ(num_samples_, 4000);
  for (int j = 0; j < joints_.size(); ++j) {
    const JointSpace::Joint& joint = joints_.joint(j);
    std::vector<int> counts(8);
    for (const std::vector<double>& q : samples) {
      const double fraction =
          (q[static_cast<std::size_t>(j)] - joint.lower) / (joint.upper - joint.lower);
      ++counts.at(static_cast<std::size_t>(fraction * 8));
    }
    for (const int count : counts) EXPECT_NEAR(count, 500, 100) << joint.name;
  }
}

TEST_P(JointSamplerTest, DependsOnItsSeedOnly) {
  const std::vector<std::vector<double>> once = Draw(5, 10);
  ompl::RNG().uniform01();  // Another generator in between does not matter.
  EXPECT_EQ(Draw(5, 10), once);
  EXPECT_NE(Draw(6, 10), once);
  EXPECT_NE(Draw(5 + (std::uint64_t{1} << 40), 10), once) << "the upper half of a seed counts too";
}

TEST_P(JointSamplerTest, SamplesNearAConfigurationStayNearAndWithinLimits) {
  JointSampler sampler(space_.get(), joints_, GetParam(), 1, &num_samples_);
  const ob::ScopedState<> center = State({3.1, 1.95, 0.2, 0});
  ob::ScopedState<> state(space_);
  for (int i = 0; i < 200; ++i) {
    sampler.sampleUniformNear(state.get(), center.get(), 0.1);
    EXPECT_TRUE(space_->satisfiesBounds(state.get()));
    EXPECT_LE(space_->distance(center.get(), state.get()), 0.1 * 2 + 1e-9);
    sampler.sampleGaussian(state.get(), center.get(), 0.1);
    EXPECT_TRUE(space_->satisfiesBounds(state.get()));
    EXPECT_LE(space_->distance(center.get(), state.get()), 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Samplers, JointSamplerTest,
                         testing::Values(SamplerKind::kUniform, SamplerKind::kHalton),
                         [](const auto& info) { return std::string(EnumName(info.param)); });

TEST_F(OmplJointSpaceTest, HaltonsFirstCoordinateHalvesTheLargestGap) {
  std::int64_t num_samples = 0;
  JointSampler sampler(space_.get(), joints_, SamplerKind::kHalton, 1, &num_samples);
  ob::ScopedState<> state(space_);
  std::set<long> cells;  // of 64 equal ones along the first joint: each is met once in 64 samples
  for (int i = 0; i < 64; ++i) {
    sampler.sampleUniform(state.get());
    cells.insert(std::lround(std::floor((OmplPositions(state.get())[0] + kPi) / (2 * kPi) * 64)));
  }
  EXPECT_GE(cells.size(), 63u);  // the sequence begins at its second point
}

}  // namespace
}  // namespace planbench
