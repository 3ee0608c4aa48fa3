#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "planner_ara/chunked_array.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// The lattice of a joint space anchored at one configuration: its points are the anchor plus
/// integer multiples of one discretisation a joint. A point's configuration is thus a function of
/// its coordinates alone, never of the order in which a search came upon it. Bounded joints have
/// the cells that lie within their limits; a continuous joint has N = round(2 pi / d) cells round
/// the circle, so that its effective discretisation is 2 pi / N.
class Lattice {
 public:
  /// Coordinate of one joint: the index of a cell, in [0, num_cells(j)).
  using Coordinate = std::uint16_t;
  static constexpr double kMaxCells = 65535;

  /// Why a joint has no lattice axis of cells of this size (rad or m): it would have more than
  /// kMaxCells, or, a continuous one, fewer than 3. Empty if it has.
  static std::string WhyNoAxis(const JointSpace::Joint& joint, double discretization);

  /// `anchor`: n joints, within limits. `discretization`: n joints, rad or m, > 0. Throws
  /// InputError as WhyNoAxis says.
  Lattice(const JointSpace& space, std::span<const double> anchor,
          std::span<const double> discretization);

  int num_joints() const { return static_cast<int>(axes_.size()); }
  int num_cells(int j) const { return static_cast<int>(Axis(j).values.size()); }
  /// Distance of neighbouring cells of joint j, rad or m.
  double step(int j) const { return Axis(j).step; }
  /// Position of joint j in cell k: rad or m; in [-pi, pi) for continuous joints, except that the
  /// anchor's own cell holds the anchor's position unchanged.
  double Value(int j, Coordinate k) const { return Axis(j).values[k]; }
  /// Value() by cell.
  std::span<const double> values(int j) const { return Axis(j).values; }
  /// Coordinates of the anchor.
  const std::vector<Coordinate>& anchor() const { return anchor_; }

  /// The cell of joint j whose position is nearest to `value`.
  Coordinate Nearest(int j, double value) const;

  /// Moves coordinate k of joint j by `cells`; false if that leaves the joint's limits.
  bool Move(int j, Coordinate k, int cells, Coordinate* moved) const {
    const LatticeAxis& axis = Axis(j);
    const int num = static_cast<int>(axis.values.size());
    int target = k + cells;
    if (axis.wraps) {
      target %= num;
      if (target < 0) target += num;
    } else if (target < 0 || target >= num) {
      return false;
    }
    *moved = static_cast<Coordinate>(target);
    return true;
  }

 private:
  struct LatticeAxis {
    double step = 0;
    bool wraps = false;
    std::vector<double> values;  // by cell
  };
  const LatticeAxis& Axis(int j) const { return axes_[static_cast<std::size_t>(j)]; }

  std::vector<LatticeAxis> axes_;
  std::vector<Coordinate> anchor_;
};

/// The points of a lattice that a search has seen, numbered in the order they were first asked for.
/// Open addressing over coordinates that are stored once, in chunks.
class LatticePoints {
 public:
  explicit LatticePoints(int num_joints)
      : coordinates_(static_cast<std::size_t>(num_joints)),
        num_joints_(static_cast<std::size_t>(num_joints)),
        slots_(kInitialSlots, kEmpty) {}

  std::size_t size() const { return coordinates_.size(); }
  /// The number of the point of these coordinates, a new one if it has not been seen.
  std::uint32_t FindOrAdd(std::span<const Lattice::Coordinate> coordinates);
  std::span<const Lattice::Coordinate> Coordinates(std::uint32_t point) const {
    return {coordinates_.Record(point), num_joints_};
  }
  std::size_t bytes() const {
    return coordinates_.bytes() + slots_.capacity() * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::size_t kInitialSlots = 1 << 12;
  static constexpr std::uint32_t kEmpty = 0xffffffff;

  std::size_t SlotOf(std::span<const Lattice::Coordinate> coordinates) const;
  void Grow();

  ChunkedArray<Lattice::Coordinate> coordinates_;
  std::size_t num_joints_;
  std::vector<std::uint32_t> slots_;  // a power of two of them, at most two thirds full
};

}  // namespace planbench
