#pragma once

#include <cstdint>
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

/// Configurations within the joints' limits, [-pi, pi) for continuous joints, that depend on `seed`
/// only.
class JointSampler {
 public:
  JointSampler(const JointSpace& joints, SamplerKind kind, std::uint64_t seed);

  /// Writes the next one to q (n values).
  void Sample(double* q);
  /// For whoever draws more than whole configurations.
  std::mt19937_64* generator() { return &generator_; }

 private:
  SamplerKind kind_;
  std::vector<double> lower_;
  std::vector<double> extent_;
  std::mt19937_64 generator_;
  // Of Halton's sequence:
  std::uint64_t index_ = 0;
  std::vector<std::uint64_t> bases_;
  std::vector<double> shifts_;
};

}  // namespace planbench
