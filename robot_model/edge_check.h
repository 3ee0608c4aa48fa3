#pragma once

#include "common/enum_names.h"

namespace planbench {

/// What the resolution of sampled edges can be, m: finer ones divide edges into more parts than can
/// be checked, with coarser ones hardly anything is checked.
inline constexpr double kFinestEdgeResolution = 1e-6;
inline constexpr double kCoarsestEdgeResolution = 1;

/// How an edge is found valid; collision/edge_checker.h says what each promises.
enum class EdgeCheck {
  kFixed,      ///< At samples a fixed resolution apart; between them it may collide.
  kCertified,  ///< Proven free all along.
};
template <>
struct EnumNames<EdgeCheck> {
  static constexpr auto kNames = std::to_array<std::string_view>({"fixed", "certified"});
};

}  // namespace planbench
