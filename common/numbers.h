#pragma once

#include <limits>
#include <numbers>

namespace planbench {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kMsPerS = 1e3;

}  // namespace planbench
