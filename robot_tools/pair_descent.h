#pragma once

#include <cstdint>

#include "robot_model/robot_folder.h"

namespace planbench {

/// Links are found to touch where a search brings them this near to each other, m. What it misses
/// of their least distance is rarely more, and to check a pair that only comes near costs little; a
/// pair that is not checked is never seen to collide.
inline constexpr double kContactGap = 5e-3;

/// Whether configurations were found in which spheres of two links touch, or all but do
/// (kContactGap): by descents on their distance, joint after joint, within the limits, from random
/// positions of the joints between them. Planar and floating joints are at the identity. The same
/// seed searches the same; what is found is so, that nothing is found is no proof.
bool FindContact(const Robot& robot, int link_a, int link_b, std::uint64_t seed);

}  // namespace planbench
