#pragma once

#include <optional>
#include <string_view>

namespace planbench {

/// How an edge is found valid; collision/edge_checker.h says what each promises.
enum class EdgeCheck {
  kFixed,      ///< At samples a fixed resolution apart; between them it may collide.
  kCertified,  ///< Proven free all along.
};

/// "fixed", "certified".
std::string_view EdgeCheckName(EdgeCheck method);
std::optional<EdgeCheck> ParseEdgeCheck(std::string_view name);

}  // namespace planbench
