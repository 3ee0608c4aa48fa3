#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "problem_generator/problem_spec.h"

namespace planbench {

/// The random numbers of one attempt at one problem: the same for equal arguments, on every
/// machine, whatever was drawn for other problems.
class RandomStream {
 public:
  RandomStream(const std::string& set, std::uint64_t seed, int problem, int attempt);

  /// Uniform in the range.
  double Draw(const Range& range);
  Eigen::Vector3d Draw(const Range3& ranges);
  /// True with that probability.
  bool Chance(double probability);
  /// Uniform in 0 .. size - 1.
  std::size_t Index(std::size_t size);
  /// An index, as likely as its weight.
  std::size_t Weighted(const std::vector<double>& weights);

  std::mt19937_64* engine() { return &engine_; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace planbench
