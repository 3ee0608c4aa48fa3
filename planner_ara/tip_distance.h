#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/voxels/voxel_grid.h"
#include "robot_model/group_kinematics.h"
#include "scene/scene.h"

namespace planbench {

/// How far the origin of a group's tip link is from where it is at the goal, as the crow would fly
/// round the obstacles: breadth-first search over the cells of a grid that no object of the scene
/// meets, diagonal steps counting as one (the workspace heuristic of Cohen, Chitta and Likhachev,
/// "Search-based planning for manipulation with motion primitives", ICRA 2010). A guide: it bounds
/// no cost.
class TipDistance {
 public:
  /// `base_positions`: full positions, at which joints outside the group are held. The grid spans
  /// the tips at `start` and `goal` and 0.5 m around. Throws InputError for objects that VoxelGrid
  /// refuses. Model and group must outlive this.
  TipDistance(const Scene& scene, const RobotModel& model, const PlanningGroup& group,
              std::span<const double> base_positions, std::span<const double> start,
              std::span<const double> goal);

  /// Distance at q, m; beyond the grid that of its nearest cell, in a cell that the goal cannot be
  /// reached from more than the longest of all.
  double operator()(std::span<const double> q);

 private:
  static constexpr int kUnseen = -1;

  std::size_t CellOf(std::span<const double> q);
  void SpreadTo(std::size_t cell);

  GroupKinematics kinematics_;
  VoxelGrid grid_;
  // By cell.
  std::vector<std::uint8_t> is_passage_;
  std::vector<int> steps_;
  // The search, which goes no further than it has been asked for.
  std::vector<std::ptrdiff_t> offsets_;  // of the neighbours
  std::vector<std::size_t> queue_;
  std::size_t next_ = 0;
};

}  // namespace planbench
