#pragma once

#include <algorithm>

namespace planbench {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
inline constexpr bool kSlowBuild = true;
#else
inline constexpr bool kSlowBuild = false;
#endif

/// How many of `num` random trials a test makes: all, or a tenth, one at least, under sanitizers
/// and without optimisation, where each takes ten times as long.
constexpr int Trials(int num) { return kSlowBuild ? std::max(1, num / 10) : num; }

}  // namespace planbench
