#include "robot_model/edge_check.h"

namespace planbench {

std::string_view EdgeCheckName(EdgeCheck method) {
  return method == EdgeCheck::kFixed ? "fixed" : "certified";
}

std::optional<EdgeCheck> ParseEdgeCheck(std::string_view name) {
  for (const EdgeCheck method : {EdgeCheck::kFixed, EdgeCheck::kCertified}) {
    if (name == EdgeCheckName(method)) return method;
  }
  return std::nullopt;
}

}  // namespace planbench
