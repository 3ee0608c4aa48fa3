#include "planner_rrtc/joint_sampler.h"

#include <algorithm>
#include <cmath>

#include "common/random.h"

namespace planbench {
namespace {

std::vector<std::uint64_t> FirstPrimes(std::size_t count) {
  std::vector<std::uint64_t> primes;
  for (std::uint64_t candidate = 2; primes.size() < count; ++candidate) {
    const bool is_prime = std::none_of(primes.begin(), primes.end(),
                                       [&](std::uint64_t prime) { return candidate % prime == 0; });
    if (is_prime) primes.push_back(candidate);
  }
  return primes;
}

/// The digits of `index` in `base`, mirrored at the point.
double RadicalInverse(std::uint64_t index, std::uint64_t base) {
  double inverse = 0;
  const double step = 1.0 / static_cast<double>(base);
  for (double weight = step; index > 0; index /= base, weight *= step) {
    inverse += weight * static_cast<double>(index % base);
  }
  return inverse;
}

}  // namespace

JointSampler::JointSampler(const JointSpace& joints, SamplerKind kind, std::uint64_t seed)
    : kind_(kind), generator_(seed) {
  for (const JointSpace::Joint& joint : joints.joints()) {
    lower_.push_back(joint.lower);
    extent_.push_back(joint.upper - joint.lower);
  }
  if (kind == SamplerKind::kHalton) {
    bases_ = FirstPrimes(lower_.size());
    for (std::size_t j = 0; j < lower_.size(); ++j) shifts_.push_back(UniformFraction(&generator_));
  }
}

void JointSampler::Sample(double* q) {
  if (kind_ == SamplerKind::kUniform) {
    for (std::size_t j = 0; j < lower_.size(); ++j) {
      q[j] = lower_[j] + extent_[j] * UniformFraction(&generator_);
    }
    return;
  }
  ++index_;
  for (std::size_t j = 0; j < lower_.size(); ++j) {
    const double shifted = RadicalInverse(index_, bases_[j]) + shifts_[j];
    q[j] = lower_[j] + extent_[j] * (shifted - std::floor(shifted));
  }
}

}  // namespace planbench
