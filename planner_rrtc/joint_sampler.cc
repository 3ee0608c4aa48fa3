#include "planner_rrtc/joint_sampler.h"

#include <ompl/base/StateSpace.h>

#include <algorithm>
#include <cmath>

#include "planner_rrtc/ompl_joint_space.h"

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

JointSampler::JointSampler(const ompl::base::StateSpace* space, const JointSpace& joints,
                           SamplerKind kind, std::uint64_t seed, std::int64_t* num_samples)
    : ompl::base::StateSampler(space), kind_(kind), generator_(seed), num_samples_(num_samples) {
  for (const JointSpace::Joint& joint : joints.joints()) {
    lower_.push_back(joint.lower);
    extent_.push_back(joint.upper - joint.lower);
  }
  if (kind == SamplerKind::kHalton) {
    bases_ = FirstPrimes(lower_.size());
    for (std::size_t j = 0; j < lower_.size(); ++j) shifts_.push_back(Uniform01());
  }
}

void JointSampler::sampleUniform(ompl::base::State* state) {
  ++*num_samples_;
  double* q = OmplPositions(state);
  if (kind_ == SamplerKind::kUniform) {
    for (std::size_t j = 0; j < lower_.size(); ++j) q[j] = lower_[j] + extent_[j] * Uniform01();
    return;
  }
  ++index_;
  for (std::size_t j = 0; j < lower_.size(); ++j) {
    const double shifted = RadicalInverse(index_, bases_[j]) + shifts_[j];
    q[j] = lower_[j] + extent_[j] * (shifted - std::floor(shifted));
  }
}

void JointSampler::sampleUniformNear(ompl::base::State* state, const ompl::base::State* near,
                                     double distance) {
  double* q = OmplPositions(state);
  const double* center = OmplPositions(near);
  for (std::size_t j = 0; j < lower_.size(); ++j) {
    q[j] = center[j] + distance * (2 * Uniform01() - 1);
  }
  space_->enforceBounds(state);
}

void JointSampler::sampleGaussian(ompl::base::State* state, const ompl::base::State* mean,
                                  double std_dev) {
  double* q = OmplPositions(state);
  const double* center = OmplPositions(mean);
  std::normal_distribution<double> normal(0, std_dev);
  for (std::size_t j = 0; j < lower_.size(); ++j) q[j] = center[j] + normal(generator_);
  space_->enforceBounds(state);
}

}  // namespace planbench
