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

std::vector<int> TipsOf(const PlanningGroup& group) {
  std::vector<int> tips{group.tip_link};
  tips.insert(tips.end(), group.more_tips.begin(), group.more_tips.end());
  return tips;
}

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
      tips_(TipsOf(group)),
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
  const auto [word, bit] = grid_->BitOf(cell);
  wave.front[word] = wave.seen[word] = bit;
  const std::size_t row = cell / nx;
  wave.first = wave.last = {static_cast<int>(row % ny), static_cast<int>(row / ny)};
  return wave;
}

// By one step, whole words of cells at once. Cells that are no passage have a distance, too, but
// the way ends in them.
void TipDistance::Spread(Wave* wave) const {
  const std::size_t words = grid_->words_a_row();
  const auto [nx, ny, nz] = grid_->size();
  std::array<int, 2> first = {ny, nz};
  std::array<int, 2> last = {-1, -1};
  std::vector<std::uint64_t> near(words);
  const auto steps = static_cast<unsigned>(wave->layer + 1);
  if (wave->digits.size() < static_cast<std::size_t>(std::bit_width(steps))) {
    wave->digits.emplace_back(wave->seen.size(), 0);
  }
  for (int k = wave->first[1] - 1; k <= wave->last[1] + 1; ++k) {
    for (int j = wave->first[0] - 1; j <= wave->last[0] + 1; ++j) {
      std::fill(near.begin(), near.end(), 0);
      for (int b = std::max(k - 1, wave->first[1]); b <= std::min(k + 1, wave->last[1]); ++b) {
        for (int a = std::max(j - 1, wave->first[0]); a <= std::min(j + 1, wave->last[0]); ++a) {
          const std::size_t row = static_cast<std::size_t>(b * ny + a) * words;
          for (std::size_t w = 0; w < words; ++w) near[w] |= wave->front[row + w];
        }
      }
      const std::size_t row = static_cast<std::size_t>(k * ny + j) * words;
      for (std::size_t w = 0; w < words; ++w) {
        const std::uint64_t below = w > 0 ? near[w - 1] >> 63 : 0;
        const std::uint64_t above = w + 1 < words ? near[w + 1] << 63 : 0;
        const std::uint64_t reached =
            (near[w] | near[w] << 1 | near[w] >> 1 | below | above) & ~wave->seen[row + w];
        if (reached == 0) continue;
        wave->seen[row + w] |= reached;
        for (unsigned bits = steps; bits != 0; bits &= bits - 1) {
          wave->digits[static_cast<std::size_t>(std::countr_zero(bits))][row + w] |= reached;
        }
        const std::uint64_t passed = reached & grid_->passages()[row + w];
        if (passed == 0) continue;
        wave->next[row + w] = passed;
        first = {std::min(first[0], j), std::min(first[1], k)};
        last = {std::max(last[0], j), std::max(last[1], k)};
      }
    }
  }
  for (int k = wave->first[1]; k <= wave->last[1]; ++k) {
    for (int j = wave->first[0]; j <= wave->last[0]; ++j) {
      std::fill_n(wave->front.begin() +
                      static_cast<std::ptrdiff_t>(k * ny + j) * static_cast<std::ptrdiff_t>(words),
                  words, 0);
    }
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
