#include "robot_model/voxel_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace planbench {

std::array<int, 3> NumVoxels(const VoxelSettings& settings) {
  if (!std::isfinite(settings.resolution_m) || settings.resolution_m <= 0) {
    throw InputError(
        fmt::format("resolution_m: {} is not greater than zero and finite", settings.resolution_m));
  }
  std::array<int, 3> size = {};
  double total = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = settings.lower[axis];
    const double upper = settings.upper[axis];
    if (!std::isfinite(lower) || !std::isfinite(upper) || lower >= upper) {
      throw InputError(
          fmt::format("lower {} is not below upper {} along {}", lower, upper, "xyz"[axis]));
    }
    // A box of a whole number of cells, as decimal fractions have it, gets no further one.
    const double cells = std::ceil((upper - lower) / settings.resolution_m - 1e-6);
    if (cells > kMaxVoxelsAlongAxis) {
      throw InputError(fmt::format("{:.0f} cells along {}, at most {} are possible", cells,
                                   "xyz"[axis], kMaxVoxelsAlongAxis));
    }
    size[static_cast<std::size_t>(axis)] = std::max(1, static_cast<int>(cells));
    total *= size[static_cast<std::size_t>(axis)];
  }
  if (total > static_cast<double>(kMaxVoxels)) {
    throw InputError(fmt::format("{:.0f} cells, at most {} are possible", total, kMaxVoxels));
  }
  return size;
}

}  // namespace planbench
