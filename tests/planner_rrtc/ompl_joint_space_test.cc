#include "planner_rrtc/ompl_joint_space.h"

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/StateSpace.h>

#include <numbers>
#include <vector>

namespace planbench {
namespace {

namespace ob = ompl::base;
constexpr double kPi = std::numbers::pi;

class OmplJointSpaceTest : public testing::Test {
 protected:
  OmplJointSpaceTest() : space_(MakeOmplJointSpace(joints_)) { space_->setup(); }

  double Distance(const std::vector<double>& a, const std::vector<double>& b) const {
    return space_->distance(State(a).get(), State(b).get());
  }

  ob::ScopedState<> State(const std::vector<double>& q) const {
    ob::ScopedState<> state(space_);
    std::copy(q.begin(), q.end(), OmplPositions(state.get(), q.size()).begin());
    return state;
  }

  const JointSpace joints_{{{"turn", true, false, -kPi, kPi, 1},
                            {"bend", false, false, -1, 2, 1},
                            {"slide", false, true, 0, 0.4, 1}}};
  const ob::StateSpacePtr space_;
};

TEST_F(OmplJointSpaceTest, PassesTheSanityChecksOfOmpl) { EXPECT_NO_THROW(space_->sanityChecks()); }

TEST_F(OmplJointSpaceTest, DistancesAreThoseOfTheJointSpace) {
  EXPECT_NEAR(Distance({3, 0, 0}, {-3, 0, 0}), 2 * kPi - 6, 1e-12);
  EXPECT_NEAR(Distance({kPi, 0, 0}, {-kPi, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(Distance({0, -1, 0}, {0, 2, 0.4}), std::hypot(3, 0.4), 1e-12);
  const ob::StateSamplerPtr sampler = MakeOmplSampler(space_.get(), joints_, 1, nullptr);
  ob::ScopedState<> a(space_);
  ob::ScopedState<> b(space_);
  for (int i = 0; i < 1000; ++i) {
    sampler->sampleUniform(a.get());
    sampler->sampleUniform(b.get());
    EXPECT_NEAR(space_->distance(a.get(), b.get()),
                joints_.Distance(OmplPositions(a.get(), 3), OmplPositions(b.get(), 3)), 1e-12);
    EXPECT_LE(space_->distance(a.get(), b.get()), space_->getMaximumExtent());
  }
}

TEST_F(OmplJointSpaceTest, InterpolatesTheShortWay) {
  ob::ScopedState<> middle(space_);
  space_->interpolate(State({3, 0, 0.1}).get(), State({-2.9, 1, 0.3}).get(), 0.5, middle.get());
  const std::span<const double> q = OmplPositions(middle.get(), 3);
  EXPECT_NEAR(q[0], 3 + (2 * kPi - 5.9) / 2 - 2 * kPi, 1e-12);
  EXPECT_NEAR(q[1], 0.5, 1e-12);
  EXPECT_NEAR(q[2], 0.2, 1e-12);
}

TEST_F(OmplJointSpaceTest, BoundsWrapAndClamp) {
  ob::ScopedState<> state = State({4, 3, -1});
  EXPECT_FALSE(space_->satisfiesBounds(state.get()));
  space_->enforceBounds(state.get());
  EXPECT_TRUE(space_->satisfiesBounds(state.get()));
  const std::span<const double> q = OmplPositions(state.get(), 3);
  EXPECT_NEAR(q[0], 4 - 2 * kPi, 1e-12);
  EXPECT_EQ(q[1], 2);
  EXPECT_EQ(q[2], 0);
}

TEST_F(OmplJointSpaceTest, SamplesCoverTheLimits) {
  std::int64_t num_samples = 0;
  const ob::StateSamplerPtr sampler = MakeOmplSampler(space_.get(), joints_, 3, &num_samples);
  ob::ScopedState<> state(space_);
  std::vector<double> lowest(3, 1e9);
  std::vector<double> highest(3, -1e9);
  for (int i = 0; i < 2000; ++i) {
    sampler->sampleUniform(state.get());
    ASSERT_TRUE(space_->satisfiesBounds(state.get()));
    const std::span<const double> q = OmplPositions(state.get(), 3);
    for (std::size_t k = 0; k < 3; ++k) {
      lowest[k] = std::min(lowest[k], q[k]);
      highest[k] = std::max(highest[k], q[k]);
    }
  }
  EXPECT_EQ(num_samples, 2000);
  for (int j = 0; j < 3; ++j) {
    const auto k = static_cast<std::size_t>(j);
    const double range = joints_.joint(j).upper - joints_.joint(j).lower;
    EXPECT_LT(lowest[k], joints_.joint(j).lower + 0.02 * range);
    EXPECT_GT(highest[k], joints_.joint(j).upper - 0.02 * range);
  }
}

TEST_F(OmplJointSpaceTest, SamplersDependOnTheirSeedOnly) {
  const auto draw = [this](std::uint64_t seed) {
    const ob::StateSamplerPtr sampler = MakeOmplSampler(space_.get(), joints_, seed, nullptr);
    std::vector<double> all;
    ob::ScopedState<> state(space_);
    for (int i = 0; i < 10; ++i) {
      sampler->sampleUniform(state.get());
      const std::span<const double> q = OmplPositions(state.get(), 3);
      all.insert(all.end(), q.begin(), q.end());
    }
    return all;
  };
  const std::vector<double> once = draw(5);
  ompl::RNG().uniform01();  // Another generator in between does not matter.
  EXPECT_EQ(draw(5), once);
  EXPECT_NE(draw(6), once);
  EXPECT_NE(draw(5 + (std::uint64_t{1} << 40)), once) << "the upper half of a seed counts too";
}

}  // namespace
}  // namespace planbench
