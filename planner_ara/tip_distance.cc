#include "planner_ara/tip_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace planbench {
namespace {

// Of 0.05, 0.07 and 0.1 m the one with the lowest times; a finer grid takes longer to fill than the
// search it would save.
constexpr double kCell = 0.07;   // m
constexpr double kMargin = 0.5;  // m
constexpr double kMostCellsAlongAxis = 200;

VoxelSettings GridAround(GroupKinematics* kinematics, std::span<const double> start,
                         std::span<const double> goal) {
  const int tip = kinematics->group().tip_link;
  kinematics->Update(start);
  const Eigen::Vector3d p_start = kinematics->X_BL(tip).translation();
  kinematics->Update(goal);
  const Eigen::Vector3d p_goal = kinematics->X_BL(tip).translation();
  VoxelSettings settings;
  settings.lower = p_start.cwiseMin(p_goal).array() - kMargin;
  settings.upper = p_start.cwiseMax(p_goal).array() + kMargin;
  settings.resolution_m =
      std::max(kCell, (settings.upper - settings.lower).maxCoeff() / kMostCellsAlongAxis);
  return settings;
}

}  // namespace

TipDistance::TipDistance(const Scene& scene, const RobotModel& model, const PlanningGroup& group,
                         std::span<const double> base_positions, std::span<const double> start,
                         std::span<const double> goal)
    : kinematics_(model, group, base_positions), grid_(GridAround(&kinematics_, start, goal)) {
  grid_.Mark(scene);
  is_passage_ = grid_.cells();
  const auto [nx, ny, nz] = grid_.size();
  for (std::uint8_t& cell : is_passage_) cell = cell == 0 ? 1 : 0;
  // No way leads along the border, so that every cell of a way has all its neighbours.
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const bool on_face = k == 0 || k == nz - 1 || j == 0 || j == ny - 1;
      for (int i = 0; i < nx; i += on_face ? 1 : nx - 1) is_passage_[grid_.Index(i, j, k)] = 0;
    }
  }
  for (int dk = -1; dk <= 1; ++dk) {
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) offsets_.push_back((dk * ny + dj) * nx + di);
    }
  }
  steps_.assign(is_passage_.size(), kUnseen);
  const std::size_t goal_cell = CellOf(goal);
  steps_[goal_cell] = 0;
  queue_.push_back(goal_cell);
}

// Cells that are no passage have a distance, too, but the way ends in them.
void TipDistance::SpreadTo(std::size_t cell) {
  while (steps_[cell] == kUnseen && next_ < queue_.size()) {
    const std::size_t from = queue_[next_++];
    for (const std::ptrdiff_t offset : offsets_) {
      const std::size_t neighbour = from + static_cast<std::size_t>(offset);
      if (steps_[neighbour] != kUnseen) continue;
      steps_[neighbour] = steps_[from] + 1;
      if (is_passage_[neighbour] != 0) queue_.push_back(neighbour);
    }
  }
}

std::size_t TipDistance::CellOf(std::span<const double> q) {
  kinematics_.Update(q);
  const Eigen::Vector3d p = kinematics_.X_BL(kinematics_.group().tip_link).translation();
  std::array<int, 3> cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double steps = std::floor((p[axis] - grid_.origin()[axis]) / grid_.resolution());
    const auto a = static_cast<std::size_t>(axis);
    cell[a] = static_cast<int>(std::clamp(steps, 1.0, grid_.size()[a] - 2.0));
  }
  return grid_.Index(cell[0], cell[1], cell[2]);
}

double TipDistance::operator()(std::span<const double> q) {
  const std::size_t cell = CellOf(q);
  SpreadTo(cell);
  const int steps = steps_[cell] != kUnseen ? steps_[cell] : steps_[queue_.back()] + 1;
  return steps * grid_.resolution();
}

}  // namespace planbench
