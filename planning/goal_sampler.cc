#include "planning/goal_sampler.h"

#include <algorithm>
#include <numbers>

#include "common/random.h"

namespace planbench {
namespace {

// Some of OMPL's planners take all there are before they begin.
constexpr int kSamplesOfABox = 50;

}  // namespace

GoalSampler::GoalSampler(const JointSpace& joints, const GoalBox& box, std::uint64_t seed)
    : joints_(joints),
      box_(box),
      max_samples_(box.lower == box.upper ? 1 : kSamplesOfABox),
      generator_(seed) {}

Configuration GoalSampler::Sample() {
  Configuration q = box_.nominal;
  if (nominal_sampled_) {
    for (int j = 0; j < joints_.size(); ++j) {
      const auto k = static_cast<std::size_t>(j);
      double below = box_.lower[k] - q[k];
      double above = box_.upper[k] - q[k];
      if (joints_.joint(j).continuous) {
        // One turn at most; short of half a turn, so that the short way from the nominal point is
        // the sample's.
        constexpr double kHalfTurn = std::numbers::pi - 1e-9;
        below = std::max(below, -kHalfTurn);
        above = std::min(above, kHalfTurn);
      }
      q[k] += below + UniformFraction(&generator_) * (above - below);
    }
  }
  nominal_sampled_ = true;
  joints_.Wrap(q);
  return q;
}

}  // namespace planbench
