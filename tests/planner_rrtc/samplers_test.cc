#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "common/numbers.h"
#include "planner_rrtc/joint_sampler.h"
#include "planning/goal_sampler.h"

namespace planbench {
namespace {

const JointSpace& Joints() {
  static const JointSpace joints({{"turn", true, false, -kPi, kPi, 1},
                                  {"bend", false, false, -1, 2, 1},
                                  {"slide", false, true, 0, 0.4, 1}});
  return joints;
}

class JointSamplerTest : public testing::TestWithParam<SamplerKind> {
 protected:
  std::vector<Configuration> Draw(std::uint64_t seed, int count) {
    JointSampler sampler(Joints(), GetParam(), seed);
    std::vector<Configuration> samples;
    for (int i = 0; i < count; ++i) {
      sampler.Sample(samples.emplace_back(3).data());
      EXPECT_TRUE(Joints().WithinLimits(samples.back()));
    }
    return samples;
  }
};

TEST_P(JointSamplerTest, SpreadsItsSamplesEvenlyOverTheLimits) {
  const std::vector<Configuration> samples = Draw(3, 4000);
  for (std::size_t j = 0; j < 3; ++j) {
    const JointSpace::Joint& joint = Joints().joints()[j];
    std::vector<int> counts(8);
    for (const Configuration& q : samples) {
      const double fraction = (q[j] - joint.lower) / (joint.upper - joint.lower);
      ++counts.at(static_cast<std::size_t>(fraction * 8));
    }
    for (const int count : counts) EXPECT_NEAR(count, 500, 100) << joint.name;
  }
}

TEST_P(JointSamplerTest, DependsOnItsSeedOnly) {
  const std::vector<Configuration> once = Draw(5, 10);
  EXPECT_EQ(Draw(5, 10), once);
  EXPECT_NE(Draw(6, 10), once);
  EXPECT_NE(Draw(5 + (std::uint64_t{1} << 40), 10), once) << "the upper half of a seed counts too";
}

INSTANTIATE_TEST_SUITE_P(Samplers, JointSamplerTest,
                         testing::Values(SamplerKind::kUniform, SamplerKind::kHalton),
                         [](const auto& info) { return std::string(EnumName(info.param)); });

TEST(HaltonSamplerTest, FirstCoordinateHalvesTheLargestGap) {
  JointSampler sampler(Joints(), SamplerKind::kHalton, 1);
  std::set<long> cells;  // of 64 equal ones along the first joint: each is met once in 64 samples
  Configuration q(3);
  for (int i = 0; i < 64; ++i) {
    sampler.Sample(q.data());
    cells.insert(std::lround(std::floor((q[0] + kPi) / (2 * kPi) * 64)));
  }
  EXPECT_GE(cells.size(), 63u);  // the sequence begins at its second point
}

TEST(GoalSamplerTest, TheNominalPointComesFirstThenTheBoxIsFilled) {
  // Wider than a turn, about the joint's seam.
  const GoalBox box{{3.1, 0.5, 0.2}, {3.1 - 9, 0.4, 0.2}, {3.1 + 9, 0.5, 0.2}};
  GoalSampler sampler(Joints(), box, 1);
  EXPECT_EQ(sampler.Sample(), box.nominal);
  EXPECT_GT(sampler.max_samples(), 1);
  std::set<double> bends;
  for (int i = 0; i < 200; ++i) {
    const Configuration q = sampler.Sample();
    EXPECT_TRUE(box.Contains(Joints(), q));
    EXPECT_TRUE(Joints().WithinLimits(q));
    bends.insert(q[1]);
  }
  EXPECT_EQ(bends.size(), 200u);
  EXPECT_LT(*bends.begin(), 0.41);
  EXPECT_GT(*bends.rbegin(), 0.49);
}

TEST(GoalSamplerTest, APointIsWorthOneSample) {
  const Configuration q = {1, 1, 0.1};
  const GoalBox point{q, q, q};
  EXPECT_EQ(GoalSampler(Joints(), point, 1).max_samples(), 1);
}

}  // namespace
}  // namespace planbench
