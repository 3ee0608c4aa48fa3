#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/edge_checker.h"
#include "planner_ara/ara_settings.h"
#include "planner_ara/ara_star.h"
#include "planner_ara/arms.h"
#include "planner_ara/goal_distance.h"
#include "planner_ara/guide.h"
#include "planner_ara/lattice.h"
#include "planner_ara/motion_primitives.h"
#include "planner_ara/recalled_paths.h"
#include "planner_ara/tip_distance.h"
#include "planning/goal_box.h"

namespace planbench {

/// AraSettings resolved against a planning group, and the choices that are not the user's.
struct ManipulationGraphOptions {
  std::vector<double> discretization;  ///< n joints, rad or m.
  std::vector<double> weights;         ///< n joints, per rad or m.
  MotionPrimitives primitives;         ///< Those in use.
  double long_moves_beyond = 0;        ///< See AraSettings::long_primitives_beyond.
  double short_moves_within = std::numeric_limits<double>::infinity();
  MoveCost cost = MoveCost::kDistance;
  Evaluation evaluation = Evaluation::kLazy;
  bool refine = true;                ///< See AraSettings::refine.
  bool shorten = true;               ///< See AraSettings::shorten.
  double bridge_after = kInfinity;   ///< See AraSettings::bridge_after.
  bool burs = false;                 ///< See AraSettings::burs.
  bool wrap_heuristic = true;        ///< See AraSettings::wrap_heuristic.
  double crowding = 0;               ///< See AraSettings::crowding.
  std::vector<char> crowded_joints;  ///< n joints: whether the joint counts in a cell of crowding.
  bool arm_by_arm = false;           ///< See AraSettings::arm_by_arm.
};

/// Resolves settings against a group; `primitives` is the file that they name, if they do. Throws
/// InputError, prefixed by `origin`, for joints of the group without a discretisation where others
/// have one and those that no lattice can have (Lattice::WhyNoAxis), unknown crowding joints,
/// settings that leave no primitive or more than kMostPrimitives, primitives that move a continuous
/// joint half a turn or more, and what PrimitivesOfFile refuses.
ManipulationGraphOptions ResolveOptions(const AraSettings& settings, const NamedFile& primitives,
                                        const Robot& robot, const PlanningGroup& group,
                                        const std::string& origin);

/// The graph an ARA* search of a manipulation problem runs on (SearchGraph): the points of a
/// lattice anchored at the start, joined by motion primitives, and the goal as one more state,
/// joined to every lattice point by the straight motion to the nearest point of the goal box (and
/// to its nominal point, if that is another). Of several arms each has an edge to where it stands
/// at the goal, or in the nearest cell.
///
/// Costs and heuristic are in one unit: weighted joint distance, or, with uniform costs, moves: a
/// move costs 1, and the motion to the goal its weighted length, but at least 1. (Weighted lengths
/// are divided by that of the longest primitive if it is more than 1.) Every edge costs at least
/// the length of its motion in that unit, so the joint distance to the goal box is a consistent
/// heuristic (unless it is asked not to wrap).
class ManipulationGraph {
 public:
  static constexpr StateId kGoal = 0;
  static constexpr StateId kStart = 1;

  /// `start` is valid, `options` as ResolveOptions has them. Throws InputError for more primitives
  /// than there are numbers of edges, burs with the collision model voxels, and what Lattice
  /// refuses. The edge checker must outlive this.
  ManipulationGraph(EdgeChecker* edges, std::span<const double> start, const GoalBox& goal,
                    ManipulationGraphOptions options);

  void CandidateEdges(StateId state, std::vector<CandidateEdge>* candidates);
  StateId Target(StateId source, std::uint16_t action);
  /// kUnknown of an edge that was given up (EdgeChecker::StopWhen).
  EdgeVerdict CheckEdge(StateId source, std::uint16_t action);
  /// Gives the states further edges: short moves everywhere, and moves of half the length of the
  /// finest. False, and nothing happens, if they are single cells already, there are no numbers
  /// left for more, or it is not allowed.
  bool Refine();
  /// Gives the states whose edges are asked for from now on `num` further moves and their
  /// opposites: of all joints at once in random directions, of each by up to 1.5 times its largest
  /// move. Nothing happens if there are no numbers left for so many.
  void AddRandomMoves(int num, std::uint64_t seed);
  /// Adds `weight` (rad/m) times the distance of the tip to the guide of the states.
  void GuideByTip(std::unique_ptr<TipDistance> distance, double weight);
  /// By joint a position that the guide does not lead across, but the other way round, if there is
  /// one (FindWalls). The heuristic, which bounds costs, stays as it is.
  void GuideRound(std::span<const std::optional<double>> walls);
  /// Before the search: adds the edges of paths that were found before (RecalledPaths). They are
  /// followed first. The heuristic must wrap.
  void AddPaths(std::span<const Path> paths);
  /// Joint distance to the goal box in the unit of the costs.
  double Heuristic(StateId state) const;
  /// What paths from the start to any goal cost at least. The heuristic must wrap.
  double LeastCostTo(const GoalBox& goal) const;

  const Lattice& lattice() const { return lattice_; }
  /// Configuration of a lattice point (not of kGoal), n joints.
  void ConfigurationOf(StateId state, std::span<double> q) const;
  /// What the straight motions of a path cost.
  double CostOf(const Path& path) const;
  /// The configurations of a path from kStart to kGoal.
  Path Configurations(const std::vector<PathStep>& steps) const;

  /// Lattice points seen.
  std::int64_t num_states() const { return static_cast<std::int64_t>(points_.size()); }
  /// Edges to the goal whose validity was checked.
  std::int64_t num_goal_connections_tried() const { return num_goal_connections_tried_; }
  /// Edges of recalled paths that were found to be free.
  std::int64_t num_recalled_edges() const { return num_recalled_edges_; }
  std::size_t bytes() const {
    const std::size_t turns = turns_ ? turns_->bytes() : 0;
    return points_.bytes() + known_edges_.bytes() + clearances_.bytes() + turns;
  }

 private:
  /// From first_move_ on the number of a move; with kSpine, of the spine in its direction.
  enum Action : std::uint16_t {
    kToNearestGoal = 0,
    kToNominalGoal = 1,
    kToRecalled = 2,  ///< And the one after it: to a waypoint of RecalledPaths::NeighboursOf.
    kArmToGoal = 4,   ///< And those after it, of several arms: one to the goal.
    kSpine = 0x8000
  };

  struct Move {
    std::vector<int> cells;  // by joint
    double length;           // weighted
    double motion_m;         // bound on the motion of the collision geometry
    bool is_long;
  };

  double LengthOf(const std::vector<int>& row) const;
  /// And their opposites. False, and nothing happens, if there are no numbers left for so many.
  bool AddMoves(const std::vector<std::vector<int>>& rows, bool are_long);
  void MakeRoomForKnowledge();
  /// Squared weighted distance to the goal that the heuristic is made of; `turns`: by joint, see
  /// turns_.
  double SquaredGoalDistance(std::span<const Lattice::Coordinate> coordinates,
                             const std::int8_t* turns) const;
  /// The point at target_, a new one with the turns of the move there from `source`.
  std::uint32_t TargetPoint(StateId source, const Move& move, int times);
  static double SquaredDistance(const std::vector<std::vector<double>>& terms,
                                std::span<const Lattice::Coordinate> coordinates);
  void GoalConfiguration(std::uint16_t action, std::span<const double> from,
                         std::span<double> to) const;
  void SelectSource(StateId state);
  int WaypointOf(StateId source, std::uint16_t action);
  bool MoveFrom(StateId source, const Move& move, int times = 1);
  void MoveArmToGoal(StateId source, std::uint16_t action);
  const Move& MoveOf(std::uint16_t action) const;
  double CostOf(double length) const;
  float ClearanceOf(StateId state);
  int SpineLength(StateId source, const Move& move);
  void SelectEdge(StateId source, std::uint16_t action);
  EdgeVerdict Recall(StateId source, std::uint16_t action);
  void Remember(StateId source, std::uint16_t action, EdgeVerdict verdict);

  EdgeChecker* edges_;
  GoalBox goal_;
  ManipulationGraphOptions options_;
  Lattice lattice_;
  LatticePoints points_;
  GoalDistance goal_distance_;
  Arms arms_;
  std::vector<Lattice::Coordinate> goal_cells_;  // The nearest to its nominal point.
  std::uint16_t first_move_ = kArmToGoal;
  std::vector<Move> moves_;
  std::vector<std::vector<int>> finest_moves_;  // that Refine halves, one of each two senses
  double unit_ = 1;                             // cost of a motion of weighted length 1
  bool moves_depend_on_place_ = false;
  // Squared weighted distance by joint and cell, to the goal box and to the start.
  std::vector<std::vector<double>> goal_terms_;
  std::vector<std::vector<double>> start_terms_;
  // As goal_terms_, of the ways that the guide leads.
  std::vector<std::vector<double>> terms_round_walls_;
  ChunkedArray<std::uint64_t> known_edges_;  // by state, two bits an edge
  ChunkedArray<float> clearances_;           // by state, m; 0 where it is not known
  // Without wrapping: by point, how many turns of each joint its first arrival was beyond Value().
  std::optional<ChunkedArray<std::int8_t>> turns_;
  std::optional<Guide> guide_;
  std::optional<RecalledPaths> recalled_;
  std::int64_t num_goal_connections_tried_ = 0;
  std::int64_t num_recalled_edges_ = 0;

  // A state and the waypoints that it is joined to.
  StateId joined_ = kGoal;
  std::array<int, 2> waypoints_{};

  // The state whose edges are at hand.
  StateId source_ = kGoal;
  std::vector<double> from_;
  std::vector<double> to_;
  std::vector<Lattice::Coordinate> target_;
};

}  // namespace planbench
