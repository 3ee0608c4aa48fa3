#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/enum_names.h"
#include "common/yaml.h"
#include "planner_ara/epsilon_schedule.h"

namespace planbench {

/// What a move between lattice points costs.
enum class MoveCost {
  kDistance,  ///< The weighted length of its motion.
  kUniform,   ///< 1, whatever its length; the motion to the goal its weighted length, at least 1.
};
template <>
struct EnumNames<MoveCost> {
  static constexpr auto kNames = std::to_array<std::string_view>({"distance", "uniform"});
};

enum class Evaluation { kLazy, kEager };
template <>
struct EnumNames<Evaluation> {
  static constexpr auto kNames = std::to_array<std::string_view>({"lazy", "eager"});
};

/// Settings of the ARA* planner, one field a key of `ara.yaml` unless said otherwise. Weights,
/// `crowding`, `tip_guide` and the epsilons are from 1e-6 to 1e6 where they are not 0.
struct AraSettings {
  /// Size of a lattice cell by joint, rad or m, > 0; every joint of the group must have one.
  /// Absent: DefaultCell.
  std::map<std::string, double> discretization;
  /// Bounded joints have a whole number of cells between their limits: the nearest to the
  /// discretization that gives one.
  bool fit_cells = false;
  /// Weight of a joint in distances, per rad or m, > 0; 1 for joints that are not named.
  std::map<std::string, double> joint_weights;
  /// The file of motion primitives (PrimitivesOfFile); relative paths start at the robot
  /// folder. Absent: DefaultPrimitives.
  std::filesystem::path primitives;
  bool use_long_primitives = true;
  bool use_short_primitives = true;
  /// Long primitives are used in states at least this far (weighted joint distance) from both start
  /// and goal.
  double long_primitives_beyond = 0;
  /// Short primitives are used in states at most this far from start or goal; `everywhere`:
  /// infinity.
  double short_primitives_within = 0.2;
  /// Searches from start and goal in turn within one request; else from the start alone (the goal,
  /// if the request's direction is backward).
  bool two_way = true;
  /// Two-way: how many configurations the two searches have checked in the mean (an expansion
  /// counts as 10) before a third one tries to join them (TwoWaySearch); > 0, `never`: infinity.
  double bridge_after = 100'000;
  /// How much states in crowded places are put off until there is a first path: a state's heuristic
  /// counts 1 + crowding (log2(1 + n) + n / 5) times in the order of the search, n the number of
  /// states expanded before in its source's cell; >= 0. Does not touch the reported bound, which is
  /// computed.
  double crowding = 0.05;
  /// The joints whose positions make up a cell of crowding, its sides the longest move of each.
  /// Empty: the joints with at least half the longest reach of their arm, and prismatic ones.
  std::vector<std::string> crowding_joints;
  /// Until there is a first path, what the distance of the tip link round the obstacles
  /// (TipDistance) adds to the heuristic in the order of the search, rad/m; >= 0. Does not touch
  /// the reported bound.
  double tip_guide = 3;
  /// Whether a group with several tips is searched arm by arm (Guide): each arm has the move to
  /// where it stands at the goal, and one moves after the other where that will do.
  bool arm_by_arm = true;
  MoveCost cost = MoveCost::kDistance;
  /// When the edges out of a state are checked: as its neighbours' turn comes, or all as it is
  /// expanded.
  Evaluation evaluation = Evaluation::kLazy;
  /// Whether states have spines of burs of free configuration space (Lacevic, Osmankovic and
  /// Ademovic 2016) beside their moves: each move repeated in a row as often as the clearance
  /// proves it free, and at least twice. Neither such spines nor the moves within them are checked.
  /// Requests for the collision model voxels, whose distances prove no motion free, are refused.
  bool burs = false;
  /// Whether a search whose moves lead nowhere any more goes on with finer ones: short moves
  /// everywhere and halves of the long ones, then halves of those, down to single cells.
  bool refine = true;
  /// Whether a path whose bound does not suffice is shortened (ShortcutPath) before the search goes
  /// on. Its cost is then that of the shortened one, and so is the bound.
  bool shorten = true;
  /// Whether the heuristic takes continuous joints the short way round. If not, a state is as far
  /// round as the motion that reached it first, the heuristic is no lower bound of the cost, and no
  /// bound is reported.
  bool wrap_heuristic = true;
  /// Where edges are sampled (EdgeCheck::kFixed), stands for the reach of the joints in the bound
  /// on the motion between samples: m per rad or m, > 0; empty, or one for every joint of the
  /// group.
  std::map<std::string, double> edge_weights;
  /// File of paths that were found before (PathLibrary), absolute or from the robot folder; empty:
  /// none.
  std::string experience;
  int recall = 1;                 ///< Of it, how many a request uses at most.
  EpsilonSchedule epsilon;        ///< Keys epsilon_initial, epsilon_decrement, epsilon_final.
  double memory_limit_mb = 2048;  ///< MiB that graph and search may take; > 0.

  /// Replaces the values that `node` names (a map or nothing); of discretization and joint_weights,
  /// those of the joints it names. Throws InputError naming file, line and key for unknown keys,
  /// those without a value, wrong types and values out of range.
  void Apply(const YamlNode& node);
  /// Throws InputError, prefixed by `origin`, unless the settings hold together.
  void Validate(const std::string& origin) const;
  /// "ARA*" and what makes it another search than the published one: "ARA* (two-way, guided)".
  std::string VariantName() const;
  /// Every setting as text, by key.
  std::map<std::string, std::string> AsText() const;
};

}  // namespace planbench
