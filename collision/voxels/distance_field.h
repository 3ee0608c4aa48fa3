#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/voxels/voxel_grid.h"

namespace planbench {

/// How far every cell of a grid is from the nearest occupied one, m, centre to centre; 0 in an
/// occupied cell, infinity if none is occupied.
struct DistanceField {
  std::array<float, 3> origin = {0, 0, 0};  ///< Corner of cell (0, 0, 0) in W, m.
  float resolution = 1;                     ///< Edge of a cell, m.
  std::array<int, 3> size = {0, 0, 0};      ///< Cells along x, y, z.
  float outside = 0;          ///< The value outside of the grid: 0 with walls, else infinity.
  std::vector<float> values;  ///< By cell, x fastest.
};

/// Computes the distance fields of scenes on one grid; keeps its memory from one to the next.
///
/// A cell is occupied if an object of the scene meets it (VoxelGrid::Mark); what lies outside of
/// the grid altogether is not seen. With walls, all cells outside of the grid count as occupied.
///
/// The transform is exact, in whole numbers, and linear in the number of cells: one pass along each
/// axis. Near to obstacles the second and third look for the nearest cell on many lines at once;
/// where that would take long they sweep over the lower envelope of the parabolas of each line
/// (Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions", Theory of Computing
/// 2012), built without divisions as in Maurer, Qi and Raghavan, "A linear time algorithm for
/// computing exact Euclidean distance transforms of binary images in arbitrary dimensions", PAMI
/// 2003.
class DistanceFieldBuilder {
 public:
  /// Throws InputError for what NumVoxels refuses.
  explicit DistanceFieldBuilder(const VoxelSettings& settings);

  /// Throws InputError for an object that RequireSolid refuses.
  const DistanceField& Rebuild(const Scene& scene);
  /// Of any occupancy: one value a cell, x fastest, not 0 if occupied.
  const DistanceField& Transform(const std::vector<std::uint8_t>& cells);
  const DistanceField& field() const { return field_; }

 private:
  VoxelGrid grid_;
  bool walls_;
  DistanceField field_;
};

}  // namespace planbench
