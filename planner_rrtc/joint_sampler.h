#pragma once

#include <ompl/base/StateSampler.h>

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "common/enum_names.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// How configurations are drawn from the whole space.
enum class SamplerKind {
  kUniform,  ///< Independent and uniform.
  /// Halton's sequence over the first n primes (Halton, "Algorithm 247: Radical-inverse
  /// quasi-random point sequence", 1964), each coordinate shifted by a number drawn from the seed
  /// (Cranley and Patterson, 1976): points spread more evenly than random ones.
  kHalton,
};
template <>
struct EnumNames<SamplerKind> {
  static constexpr auto kNames = std::to_array<std::string_view>({"uniform", "halton"});
};

/// Sampler of an OmplJointSpace over the joints' limits, [-pi, pi) for continuous joints, that
/// depends on `seed` only and not on OMPL's process-wide seed. Adds the number of its samples of
/// the whole space to *num_samples.
class JointSampler final : public ompl::base::StateSampler {
 public:
  JointSampler(const ompl::base::StateSpace* space, const JointSpace& joints, SamplerKind kind,
               std::uint64_t seed, std::int64_t* num_samples);

  void sampleUniform(ompl::base::State* state) override;
  void sampleUniformNear(ompl::base::State* state, const ompl::base::State* near,
                         double distance) override;
  void sampleGaussian(ompl::base::State* state, const ompl::base::State* mean,
                      double std_dev) override;

 private:
  double Uniform01() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

  SamplerKind kind_;
  std::vector<double> lower_;
  std::vector<double> extent_;
  std::mt19937_64 generator_;
  std::int64_t* num_samples_;
  // Of Halton's sequence:
  std::uint64_t index_ = 0;
  std::vector<std::uint64_t> bases_;
  std::vector<double> shifts_;
};

}  // namespace planbench
