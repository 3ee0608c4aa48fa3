#include "planner_ara/tip_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace planbench {
namespace {

// Of 0.05, 0.07 and 0.1 m the one with the lowest times; a finer grid takes longer to fill than the
// search it would save.
constexpr double kCell = 0.07;   // m
constexpr double kMargin = 0.5;  // m
constexpr double kMostCellsAlongAxis = 200;

VoxelSettings GridAround(GroupKinematics* kinematics, const std::vector<int>& tips,
                         std::span<const double> start, std::span<const double> goal) {
  Eigen::AlignedBox3d box;
  for (const std::span<const double> q : {start, goal}) {
    kinematics->Update(q);
    for (const int tip : tips) box.extend(kinematics->X_BL(tip).translation());
  }
  VoxelSettings settings;
  settings.lower = box.min().array() - kMargin;
  settings.upper = box.max().array() + kMargin;
  settings.resolution_m =
      std::max(kCell, (box.sizes().maxCoeff() + 2 * kMargin) / kMostCellsAlongAxis);
  return settings;
}

}  // namespace

TipGrid::TipGrid(const Scene& scene, const RobotModel& model, const PlanningGroup& group,
                 std::span<const double> base_positions, std::span<const double> start,
                 std::span<const double> goal)
    : kinematics_(model, group, base_positions),
      tips_(group.tips()),
      scene_(&scene),
      grid_(GridAround(&kinematics_, tips_, start, goal)),
      cells_(tips_.size()) {}

void TipGrid::Mark() {
  if (!passages_.empty()) return;
  grid_.Mark(*scene_);
  const auto [nx, ny, nz] = grid_.size();
  words_ = static_cast<std::size_t>(nx + 63) / 64;
  passages_.assign(words_ * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz), 0);
  for (int k = 1; k < nz - 1; ++k) {
    for (int j = 1; j < ny - 1; ++j) {
      const std::size_t row = static_cast<std::size_t>(k * ny + j) * words_;
      for (int i = 1; i < nx - 1; ++i) {
        const auto x = static_cast<std::size_t>(i);
        const std::uint64_t free = grid_.cells()[grid_.Index(i, j, k)] == 0 ? 1 : 0;
        passages_[row + x / 64] |= free << x % 64;
      }
    }
  }
}

const std::vector<std::size_t>& TipGrid::CellsOf(std::span<const double> q) {
  kinematics_.Update(q);
  for (std::size_t t = 0; t < tips_.size(); ++t) {
    const Eigen::Vector3d p = kinematics_.X_BL(tips_[t]).translation();
    std::array<int, 3> cell;
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = std::floor((p[axis] - grid_.origin()[axis]) / grid_.resolution());
      const auto a = static_cast<std::size_t>(axis);
      cell[a] = static_cast<int>(std::clamp(steps, 1.0, grid_.size()[a] - 2.0));
    }
    cells_[t] = grid_.Index(cell[0], cell[1], cell[2]);
  }
  return cells_;
}

TipDistance::TipDistance(std::shared_ptr<TipGrid> grid, std::span<const double> goal)
    : grid_(std::move(grid)), goal_(goal.begin(), goal.end()) {}

TipDistance::Wave TipDistance::StartAt(std::size_t cell) const {
  const auto nx = static_cast<std::size_t>(grid_->size()[0]);
  const auto ny = static_cast<std::size_t>(grid_->size()[1]);
  Wave wave;
  for (auto* bits : {&wave.front, &wave.seen, &wave.next})
    bits->assign(grid_->passages().size(), 0);
  wave.beside.assign(grid_->words_a_row() * ny * static_cast<std::size_t>(grid_->size()[2] + 2), 0);
  const auto [word, bit] = grid_->BitOf(cell);
  wave.front[word] = wave.seen[word] = bit;
  const std::size_t row = cell / nx;
  wave.first = wave.last = {static_cast<int>(row % ny), static_cast<int>(row / ny)};
  return wave;
}

// By one step, whole words of cells at once: first to the rows beside each, then to the planes
// above and below, then along the rows. Cells that are no passage have a distance, too, but the way
// ends in them. Nothing of the front is on the border of the grid.
void TipDistance::Spread(Wave* wave) const {
  const auto words = static_cast<std::ptrdiff_t>(grid_->words_a_row());
  const auto [nx, ny, nz] = grid_->size();
  const std::ptrdiff_t plane = ny * words;
  const std::ptrdiff_t begin = (wave->first[0] - 1) * words;
  const std::ptrdiff_t end = (wave->last[0] + 2) * words;
  for (int k = std::max(1, wave->first[1] - 2); k <= std::min(nz - 2, wave->last[1] + 2); ++k) {
    const std::uint64_t* front = wave->front.data() + k * plane;
    std::uint64_t* beside = wave->beside.data() + (k + 1) * plane;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      beside[i] = front[i - words] | front[i] | front[i + words];
    }
  }

  std::array<int, 2> first = {ny, nz};
  std::array<int, 2> last = {-1, -1};
  const auto steps = static_cast<unsigned>(wave->layer + 1);
  if (wave->digits.size() < static_cast<std::size_t>(std::bit_width(steps))) {
    wave->digits.emplace_back(wave->seen.size(), 0);
  }
  for (int k = wave->first[1] - 1; k <= wave->last[1] + 1; ++k) {
    const std::uint64_t* below = wave->beside.data() + k * plane;
    const auto near = [&](std::ptrdiff_t i) {
      return below[i] | below[i + plane] | below[i + 2 * plane];
    };
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      std::uint64_t reached = near(i);
      reached |= reached << 1 | reached >> 1;
      if (words > 1) {
        if (i % words > 0) reached |= near(i - 1) >> 63;
        if (i % words + 1 < words) reached |= near(i + 1) << 63;
      }
      const auto word = static_cast<std::size_t>(k * plane + i);
      reached &= ~wave->seen[word];
      if (reached == 0) continue;
      wave->seen[word] |= reached;
      for (unsigned bits = steps; bits != 0; bits &= bits - 1) {
        wave->digits[static_cast<std::size_t>(std::countr_zero(bits))][word] |= reached;
      }
      const std::uint64_t passed = reached & grid_->passages()[word];
      if (passed == 0) continue;
      wave->next[word] = passed;
      const int j = static_cast<int>(i / words);
      first = {std::min(first[0], j), std::min(first[1], k)};
      last = {std::max(last[0], j), std::max(last[1], k)};
    }
  }
  for (int k = wave->first[1]; k <= wave->last[1]; ++k) {
    std::fill(wave->front.begin() + k * plane + begin, wave->front.begin() + k * plane + end, 0);
  }
  wave->front.swap(wave->next);
  wave->first = first;
  wave->last = last;
  wave->spent = last[0] < 0;
  if (!wave->spent) ++wave->layer;
}

int TipDistance::StepsTo(std::size_t cell, Wave* wave) const {
  const auto [word, bit] = grid_->BitOf(cell);
  const auto has = [&, word = word, bit = bit](const std::vector<std::uint64_t>& bits) {
    return (bits[word] & bit) != 0;
  };
  while (!has(wave->seen) && !wave->spent) Spread(wave);
  if (!has(wave->seen)) return wave->layer + 1;
  int steps = 0;
  for (std::size_t i = 0; i < wave->digits.size(); ++i) steps += has(wave->digits[i]) ? 1 << i : 0;
  return steps;
}

std::span<const double> TipDistance::operator()(std::span<const double> q) {
  if (waves_.empty()) {
    grid_->Mark();
    for (const std::size_t cell : grid_->CellsOf(goal_)) waves_.push_back(StartAt(cell));
  }
  const std::vector<std::size_t>& cells = grid_->CellsOf(q);
  distances_.resize(waves_.size());
  for (std::size_t t = 0; t < waves_.size(); ++t) {
    distances_[t] = StepsTo(cells[t], &waves_[t]) * grid_->resolution();
  }
  return distances_;
}

}  // namespace planbench
