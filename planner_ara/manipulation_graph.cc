#include "planner_ara/manipulation_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/error.h"

namespace planbench {

ManipulationGraphOptions ResolveOptions(const AraSettings& settings, const JointSpace& space,
                                        const std::string& primitives_file,
                                        const std::string& origin) {
  ManipulationGraphOptions options;
  for (const JointSpace::Joint& joint : space.joints()) {
    const auto cell = settings.discretization.find(joint.name);
    if (cell == settings.discretization.end()) {
      throw InputError(fmt::format("{}: discretization: joint {} has none", origin, joint.name));
    }
    options.discretization.push_back(cell->second);
    const auto weight = settings.joint_weights.find(joint.name);
    options.weights.push_back(weight == settings.joint_weights.end() ? 1 : weight->second);
  }
  options.primitives = LoadMotionPrimitives(primitives_file, space.size());
  if (!settings.use_long_primitives) options.primitives.long_moves.clear();
  if (!settings.use_short_primitives) options.primitives.short_moves.clear();
  options.long_moves_beyond = settings.long_primitives_beyond;
  options.short_moves_within = settings.short_primitives_within;
  options.cost = settings.cost;
  return options;
}

ManipulationGraph::ManipulationGraph(EdgeChecker* edges, std::span<const double> start,
                                     const GoalBox& goal, ManipulationGraphOptions options)
    : edges_(edges),
      goal_(goal),
      options_(std::move(options)),
      lattice_(edges->space(), start, options_.discretization),
      points_(edges->space().size()),
      goal_distance_(edges->space(), goal_, options_.weights),
      from_(start.size()),
      to_(start.size()),
      target_(start.size()) {
  AddMoves(options_.primitives.long_moves, true);
  AddMoves(options_.primitives.short_moves, false);
  double longest = 0;
  for (const Move& move : moves_) longest = std::max(longest, move.cost);
  if (options_.cost == MoveCost::kUniform && longest > 0) {
    unit_ = 1 / longest;
    for (Move& move : moves_) move.cost = 1;
  }
  moves_depend_on_place_ =
      options_.long_moves_beyond > 0 || std::isfinite(options_.short_moves_within);

  const JointSpace& space = edges_->space();
  for (int j = 0; j < space.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    std::vector<double>& to_goal = goal_terms_.emplace_back();
    std::vector<double>& to_start = start_terms_.emplace_back();
    for (int k = 0; k < lattice_.num_cells(j); ++k) {
      const double value = lattice_.Value(j, static_cast<Lattice::Coordinate>(k));
      const double from_start = options_.weights[i] * space.Difference(j, start[i], value);
      to_goal.push_back(goal_distance_.SquaredTerm(j, value));
      to_start.push_back(from_start * from_start);
    }
  }
  known_words_ = (2 * (kFirstMove + moves_.size()) + 63) / 64;
  known_edges_ = ChunkedArray<std::uint64_t>(known_words_);
  points_.FindOrAdd(lattice_.anchor());
}

void ManipulationGraph::AddMoves(const std::vector<std::vector<int>>& rows, bool are_long) {
  const JointSpace& space = edges_->space();
  for (const std::vector<int>& row : rows) {
    double sum = 0;
    for (int j = 0; j < space.size(); ++j) {
      const auto i = static_cast<std::size_t>(j);
      const double motion = row[i] * lattice_.step(j);
      if (space.joint(j).continuous && std::abs(motion) >= std::numbers::pi) {
        throw InputError(fmt::format(
            "motion primitive moves the continuous joint {} by {} cells, half a turn or more",
            space.joint(j).name, row[i]));
      }
      const double weighted = options_.weights[i] * motion;
      sum += weighted * weighted;
    }
    std::vector<int> opposite = row;
    for (int& cells : opposite) cells = -cells;
    moves_.push_back({row, std::sqrt(sum), are_long});
    moves_.push_back({std::move(opposite), std::sqrt(sum), are_long});
  }
}

double ManipulationGraph::SquaredDistance(const std::vector<std::vector<double>>& terms,
                                          std::span<const Lattice::Coordinate> coordinates) {
  double sum = 0;
  for (std::size_t j = 0; j < coordinates.size(); ++j) sum += terms[j][coordinates[j]];
  return sum;
}

double ManipulationGraph::Heuristic(StateId state) const {
  return state == kGoal
             ? 0
             : unit_ * std::sqrt(SquaredDistance(goal_terms_, points_.Coordinates(state - 1)));
}

void ManipulationGraph::ConfigurationOf(StateId state, std::span<double> q) const {
  const std::span<const Lattice::Coordinate> coordinates = points_.Coordinates(state - 1);
  for (std::size_t j = 0; j < coordinates.size(); ++j) {
    q[j] = lattice_.Value(static_cast<int>(j), coordinates[j]);
  }
}

void ManipulationGraph::SelectSource(StateId state) {
  if (state == source_) return;
  source_ = state;
  ConfigurationOf(state, from_);
}

// Sets target_ to where the move leads; false if that is outside the limits.
bool ManipulationGraph::MoveFrom(StateId source, const Move& move) {
  const std::span<const Lattice::Coordinate> coordinates = points_.Coordinates(source - 1);
  for (std::size_t j = 0; j < coordinates.size(); ++j) {
    if (!lattice_.Move(static_cast<int>(j), coordinates[j], move.cells[j], &target_[j])) {
      return false;
    }
  }
  return true;
}

void ManipulationGraph::CandidateEdges(StateId state, std::vector<CandidateEdge>* candidates) {
  candidates->push_back({Heuristic(state), 0, kToNearestGoal});
  if (goal_distance_.has_extent()) {
    SelectSource(state);
    const double distance =
        WeightedDistance(edges_->space(), options_.weights, from_, goal_.nominal);
    candidates->push_back({unit_ * distance, 0, kToNominalGoal});
  }

  bool use_long = true;
  bool use_short = true;
  if (moves_depend_on_place_) {
    const std::span<const Lattice::Coordinate> here = points_.Coordinates(state - 1);
    const double distance = std::sqrt(
        std::min(SquaredDistance(goal_terms_, here), SquaredDistance(start_terms_, here)));
    use_long = distance >= options_.long_moves_beyond;
    use_short = distance <= options_.short_moves_within;
  }
  for (std::size_t m = 0; m < moves_.size(); ++m) {
    const Move& move = moves_[m];
    if (!(move.is_long ? use_long : use_short) || !MoveFrom(state, move)) continue;
    candidates->push_back({move.cost, unit_ * std::sqrt(SquaredDistance(goal_terms_, target_)),
                           static_cast<std::uint16_t>(kFirstMove + m)});
  }
}

StateId ManipulationGraph::Target(StateId source, std::uint16_t action) {
  if (action < kFirstMove) return kGoal;
  MoveFrom(source, moves_[action - kFirstMove]);
  return points_.FindOrAdd(target_) + 1;
}

bool ManipulationGraph::IsValidEdge(StateId source, std::uint16_t action) {
  if (!options_.remember_edges) return Check(source, action);
  int shift = 0;
  std::uint64_t* word = KnowledgeWord(source, action, &shift);
  const auto known = static_cast<Knowledge>(*word >> shift & 3);
  if (known != Knowledge::kUnknown) return known == Knowledge::kFree;
  const bool valid = Check(source, action);
  *word |= static_cast<std::uint64_t>(valid ? Knowledge::kFree : Knowledge::kBlocked) << shift;
  return valid;
}

bool ManipulationGraph::Check(StateId source, std::uint16_t action) {
  SelectSource(source);
  if (action < kFirstMove) {
    ++num_goal_connections_tried_;
    GoalConfiguration(action, from_, to_);
  } else {
    MoveFrom(source, moves_[action - kFirstMove]);
    for (std::size_t j = 0; j < to_.size(); ++j) {
      to_[j] = lattice_.Value(static_cast<int>(j), target_[j]);
    }
  }
  return edges_->IsValidEdge(from_, to_, /*from_is_free=*/true);
}

void ManipulationGraph::GoalConfiguration(std::uint16_t action, std::span<const double> from,
                                          std::span<double> to) const {
  if (action == kToNearestGoal) {
    goal_distance_.Nearest(from, to);
  } else {
    std::copy(goal_.nominal.begin(), goal_.nominal.end(), to.begin());
  }
}

std::uint64_t* ManipulationGraph::KnowledgeWord(StateId state, std::uint16_t action, int* shift) {
  while (known_edges_.size() <= state) known_edges_.Append();
  const std::size_t bit = 2 * static_cast<std::size_t>(action);
  *shift = static_cast<int>(bit % 64);
  return known_edges_.Record(state) + bit / 64;
}

Path ManipulationGraph::Configurations(const std::vector<PathStep>& steps) const {
  Path path;
  for (const PathStep& step : steps) {
    Configuration q(from_.size());
    if (step.state == kGoal) {
      GoalConfiguration(step.action, path.back(), q);
    } else {
      ConfigurationOf(step.state, q);
    }
    path.push_back(std::move(q));
  }
  return path;
}

}  // namespace planbench
