#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// The occupied cells of an OctoMap as boxes that touch and do not overlap, as few as joining cells
/// along x, then y, then z makes them. `data` is an octomap_msgs/Octomap's: the tree without a file
/// header, in OctoMap's binary form (occupied or free) or its full form (occupied where the
/// probability is 0.5 or more). Throws InputError if `id` is not "OcTree", the resolution (edge of
/// the smallest cell, m) is not positive, or the data is cut off, too long, or no tree.
std::vector<PlacedShape> OctomapBoxes(std::span<const std::uint8_t> data, bool binary,
                                      const std::string& id, double resolution);

}  // namespace planbench
