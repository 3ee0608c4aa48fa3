#pragma once

#include <cstdint>

#include "robot_model/robot_folder.h"

namespace planbench {

/// Configurations drawn for a pair of links, and descents on its distance: from those of these that
/// are nearest, and from random ones.
inline constexpr int kDescentDraws = 256;
inline constexpr int kNearestDescents = 8;
inline constexpr int kRandomDescents = 16;
inline constexpr int kDescents = kNearestDescents + kRandomDescents;

/// Whether configurations were found in which spheres of two links touch, or all but do (1 mm): by
/// drawing the joints between them, and by descents on the distance of the two, joint after joint,
/// within the limits. Planar and floating joints are at the identity. The same seed searches the
/// same; what is found is so, that nothing is found is no proof.
bool FindContact(const Robot& robot, int link_a, int link_b, std::uint64_t seed);

}  // namespace planbench
