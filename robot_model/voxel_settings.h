#pragma once

#include <Eigen/Core>
#include <array>

namespace planbench {

/// The grid of the voxels model: a box of cubic cells in the base frame W, the first of which
/// starts at `lower`.
struct VoxelSettings {
  double resolution_m = 0.02;  ///< Edge of a cell.
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();  ///< Covered by the cells, which may go beyond.
  bool walls = false;  ///< Whether the space outside of the grid counts as occupied.
  /// Whether only cells that the surface of an object meets are occupied, not those inside.
  bool hollow = false;
};

/// A grid of more cells than this, or of more along one axis, is refused.
inline constexpr long long kMaxVoxels = 64'000'000;
inline constexpr int kMaxVoxelsAlongAxis = 2'048;

/// Number of cells along x, y and z. Throws InputError for a resolution that is not positive, a
/// lower corner that is not below the upper one, values that are not finite, too many cells.
std::array<int, 3> NumVoxels(const VoxelSettings& settings);

}  // namespace planbench
