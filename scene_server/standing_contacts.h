#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision/collision_checker.h"

namespace planbench {

/// Random configurations that standing contacts are looked for in.
inline constexpr int kStandingDraws = 100;

/// Pairs of links that touch in every configuration of the checker's group, as far as
/// `kStandingDraws` random ones tell; none if one of them is free. Objects do not count: pairs that
/// `allowed` lets touch do not, either. Leaves the checker with another scene.
std::vector<std::pair<std::string, std::string>> FindStandingContacts(
    CollisionChecker* checker, const AllowedCollisionMatrix& allowed,
    std::span<const double> base_positions);

}  // namespace planbench
