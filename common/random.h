#pragma once

#include <random>

namespace planbench {

/// A number in [0, 1) with 53 random bits. Unlike the distributions of the standard library it is
/// the same with every compiler, so that what is drawn with a seed can be drawn again elsewhere.
inline double UniformFraction(std::mt19937_64* random) {
  return static_cast<double>((*random)() >> 11) * 0x1p-53;
}

}  // namespace planbench
