#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "collision/voxels/voxel_grid.h"
#include "robot_model/group_kinematics.h"
#include "scene/scene.h"

namespace planbench {

/// The cells of a grid that no object of a scene meets: passages for the tips of a group. It spans
/// the tips at start and goal and 0.5 m around.
class TipGrid {
 public:
  /// `base_positions`: full positions, at which joints outside the group are held. Nothing is
  /// marked yet. Scene, model and group must outlive this.
  TipGrid(const Scene& scene, const RobotModel& model, const PlanningGroup& group,
          std::span<const double> base_positions, std::span<const double> start,
          std::span<const double> goal);

  /// Marks the objects, the first time. Throws InputError for those that VoxelGrid refuses.
  void Mark();

  double resolution() const { return grid_.resolution(); }  ///< m
  /// Cells along x, y and z; cell (i, j, k) has the index i + nx (j + ny k).
  const std::array<int, 3>& size() const { return grid_.size(); }
  std::size_t num_cells() const { return grid_.cells().size(); }
  std::size_t words_a_row() const { return words_; }
  /// The word that a cell has its bit in, and the bit.
  std::pair<std::size_t, std::uint64_t> BitOf(std::size_t cell) const {
    const auto nx = static_cast<std::size_t>(size()[0]);
    return {cell / nx * words_ + cell % nx / 64, std::uint64_t{1} << cell % nx % 64};
  }
  /// A bit a cell, so many words a row of cells along x; empty: not marked yet. No way leads along
  /// the border, so that every passage has all its neighbours.
  const std::vector<std::uint64_t>& passages() const { return passages_; }
  /// By tip, the cell that the origin of its link is in at q, or the nearest one.
  const std::vector<std::size_t>& CellsOf(std::span<const double> q);

 private:
  GroupKinematics kinematics_;
  std::vector<int> tips_;  // link indices
  const Scene* scene_;
  VoxelGrid grid_;
  std::size_t words_ = 0;
  std::vector<std::uint64_t> passages_;
  std::vector<std::size_t> cells_;
};

/// How far the origins of a group's tip links are from where they are at the goal, as the crow
/// would fly round the obstacles: breadth-first search over a TipGrid, diagonal steps counting as
/// one (the workspace heuristic of Cohen, Chitta and Likhachev, "Search-based planning for
/// manipulation with motion primitives", ICRA 2010). A guide: it bounds no cost.
class TipDistance {
 public:
  TipDistance(std::shared_ptr<TipGrid> grid, std::span<const double> goal);

  /// Distances at q by tip, m; beyond the grid those of its nearest cells, in a cell that the goal
  /// cannot be reached from more than the longest of all. The first call marks the grid, and throws
  /// as that.
  std::span<const double> operator()(std::span<const double> q);

 private:
  // The search from where one tip is at the goal, which goes no further than it has been asked for.
  struct Wave {
    int layer = 0;                     // Steps to the front.
    bool spent = false;                // Nothing is left to spread to.
    std::vector<std::uint64_t> front;  // As TipGrid::passages.
    std::vector<std::uint64_t> seen;
    std::vector<std::uint64_t> next;  // Scratch, all zero between layers.
    // Scratch: the front and the rows beside it, with a plane that is zero below and above.
    std::vector<std::uint64_t> beside;
    std::array<int, 2> first, last;  // Rows (j, k) that bound the front.
    // The steps to cells that have been seen, a binary digit each: that of 2^i of all cells.
    std::vector<std::vector<std::uint64_t>> digits;
  };
  Wave StartAt(std::size_t cell) const;
  void Spread(Wave* wave) const;
  int StepsTo(std::size_t cell, Wave* wave) const;

  std::shared_ptr<TipGrid> grid_;
  std::vector<double> goal_;
  std::vector<Wave> waves_;  // By tip; none before the first call.
  std::vector<double> distances_;
};

}  // namespace planbench
