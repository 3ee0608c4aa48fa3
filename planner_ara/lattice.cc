#include "planner_ara/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.h"

namespace planbench {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

// Of their size, as far as positions may be beyond the limits, or round the circle.
double CellsOf(const JointSpace::Joint& joint, double discretization) {
  const double range = joint.upper - joint.lower + 2 * JointSpace::kLimitTolerance;
  return (joint.continuous ? kTwoPi : range) / discretization;
}

}  // namespace

std::string Lattice::WhyNoAxis(const JointSpace::Joint& joint, double discretization) {
  const double cells = CellsOf(joint, discretization);
  if (!(cells <= kMaxCells)) {
    return fmt::format("discretization of {}: {} gives more than {:.0f} cells", joint.name,
                       discretization, kMaxCells);
  }
  if (joint.continuous && std::lround(cells) < 3) {
    return fmt::format("discretization of {}: {} gives fewer than 3 cells", joint.name,
                       discretization);
  }
  return "";
}

Lattice::Lattice(const JointSpace& space, std::span<const double> anchor,
                 std::span<const double> discretization) {
  for (int j = 0; j < space.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const JointSpace::Joint& joint = space.joint(j);
    if (const std::string why = WhyNoAxis(joint, discretization[i]); !why.empty()) {
      throw InputError(why);
    }
    LatticeAxis axis;
    axis.wraps = joint.continuous;
    int below = 0;  // cells on the lower side of the anchor
    int above = 0;
    if (joint.continuous) {
      const int num = static_cast<int>(std::lround(CellsOf(joint, discretization[i])));
      axis.step = kTwoPi / num;
      above = num - 1;
    } else {
      axis.step = discretization[i];
      const double slack = JointSpace::kLimitTolerance / 2;
      below = std::max(0, static_cast<int>((anchor[i] - joint.lower + slack) / axis.step));
      above = std::max(0, static_cast<int>((joint.upper - anchor[i] + slack) / axis.step));
    }
    for (int k = -below; k <= above; ++k) {
      const double value = anchor[i] + k * axis.step;
      axis.values.push_back(joint.continuous && k != 0 ? WrapAngle(value) : value);
    }
    anchor_.push_back(static_cast<Coordinate>(below));
    axes_.push_back(std::move(axis));
  }
}

Lattice::Coordinate Lattice::Nearest(int j, double value) const {
  const LatticeAxis& axis = Axis(j);
  const int anchor = anchor_[static_cast<std::size_t>(j)];
  const double offset = value - axis.values[static_cast<std::size_t>(anchor)];
  const double cells = std::round((axis.wraps ? WrapAngle(offset) : offset) / axis.step);
  const int num = num_cells(j);
  if (axis.wraps) return static_cast<Coordinate>((anchor + static_cast<int>(cells) + num) % num);
  return static_cast<Coordinate>(std::clamp(anchor + cells, 0.0, num - 1.0));
}

std::size_t LatticePoints::SlotOf(std::span<const Lattice::Coordinate> coordinates) const {
  std::uint64_t hash = 0;
  for (const Lattice::Coordinate coordinate : coordinates) {
    hash = (hash ^ coordinate) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32;
  }
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  while (slots_[slot] != kEmpty &&
         !std::equal(coordinates.begin(), coordinates.end(), coordinates_.Record(slots_[slot]))) {
    slot = (slot + 1) & mask;
  }
  return slot;
}

std::uint32_t LatticePoints::FindOrAdd(std::span<const Lattice::Coordinate> coordinates) {
  std::size_t slot = SlotOf(coordinates);
  if (slots_[slot] != kEmpty) return slots_[slot];
  if ((size() + 1) * 3 > slots_.size() * 2) {
    Grow();
    slot = SlotOf(coordinates);
  }
  slots_[slot] = static_cast<std::uint32_t>(size());
  std::copy(coordinates.begin(), coordinates.end(), coordinates_.Append());
  return slots_[slot];
}

void LatticePoints::Grow() {
  slots_.assign(slots_.size() * 2, kEmpty);
  for (std::uint32_t point = 0; point < size(); ++point) slots_[SlotOf(Coordinates(point))] = point;
}

}  // namespace planbench
