#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "planner_ara/arms.h"
#include "planner_ara/lattice.h"
#include "planner_ara/tip_distance.h"

namespace planbench {

/// What leads a search on a lattice to its first path beside the joint distance to the goal: the
/// tips' way round the obstacles, how crowded the source's place is, and, of several arms, that one
/// moves after the other. It bounds no cost.
///
/// The guide of a state is c (h + d): h the joint distance to the goal, d the weighted distance of
/// the tip of the state's source, c = 1 + crowding (log2(1 + n) + n / 5), n how many states were
/// expanded before in the source's place, a cell of the joints that count in it. It is told where h
/// leads against a wall, and measures the joints by other terms from then on.
///
/// Of several arms it is the sum of that over the arms, and over the joints that they share. Those
/// that wait where the search began or have arrived at the goal are no part of the place, and have
/// c = 1. Where more than one arm is under way, the sum counts 0.2 times more for each further one:
/// without that a search tries all positions of the one arm with all of the other.
class Guide {
 public:
  /// `goal_terms`: by joint and cell the squared distance to the goal, of which `unit` times the
  /// root is a cost. `goal_cells`: n joints. `place_cells`: n joints, how many cells make one of
  /// its place; 0 for joints that do not count in it. What is given by pointer must outlive this.
  Guide(const Lattice* lattice, const std::vector<std::vector<double>>* goal_terms,
        const std::vector<Lattice::Coordinate>* goal_cells, Arms arms, double unit, double crowding,
        std::vector<int> place_cells);

  /// `weight`: rad/m.
  void ByTip(std::unique_ptr<TipDistance> distance, double weight);
  bool by_tip() const { return tip_distance_ != nullptr; }
  /// As `goal_terms` are given, instead of those and of the heuristic; no place is crowded any
  /// more.
  void MeasureBy(const std::vector<std::vector<double>>* terms);

  /// A state is expanded; q is its configuration, or empty if the tips shall not matter.
  void SelectSource(std::span<const Lattice::Coordinate> source, std::span<const double> q);
  /// The guide of a state that an edge leads to; `heuristic`: its distance to the goal as a cost.
  float operator()(std::span<const Lattice::Coordinate> target, double heuristic);

 private:
  // An arm, or, behind several arms, what they share.
  struct Part {
    // Of the source.
    double crowd = 1;
    double detour = 0;
    // Of the point located last. A single arm is under way wherever it is.
    double squared = 0;  // distance to the goal
    bool has_left = true;
    bool has_arrived = false;
    bool under_way() const { return has_left && !has_arrived; }
  };

  void Locate(std::span<const Lattice::Coordinate> point);
  Part& PartOf(std::size_t joint) {
    return parts_[static_cast<std::size_t>(arms_.of_joint[joint])];
  }
  double CountVisit(std::span<const Lattice::Coordinate> source);

  const Lattice* lattice_;
  const std::vector<std::vector<double>>* goal_terms_;
  bool has_own_terms_ = false;  // that the heuristic is not made of
  const std::vector<Lattice::Coordinate>* goal_cells_;
  Arms arms_;
  double unit_;
  double crowding_;
  std::vector<int> place_cells_;
  std::vector<Part> parts_;
  std::vector<std::uint16_t> visits_;  // by hash of the place
  std::unique_ptr<TipDistance> tip_distance_;
  double tip_weight_ = 0;
};

}  // namespace planbench
