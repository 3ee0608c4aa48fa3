#include "planner_ara/manipulation_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <random>
#include <set>
#include <utility>

#include "common/error.h"
#include "common/random.h"
#include "planner_ara/default_primitives.h"

namespace planbench {
namespace {

// No spine is longer, in motion of the collision geometry, m.
constexpr double kLongestSpine = 0.5;
// What a move counts at least, m: those of a joint that moves no geometry would have no end.
constexpr double kLeastMotion = 1e-3;
// Of the largest move of a joint, its part in a random one at most.
constexpr double kRandomReach = 1.5;

// Refuses moves that a graph has no room for and those of half a turn, which could be either way.
void RequireUsable(const MotionPrimitives& primitives, const JointSpace& space,
                   std::span<const double> discretization, const std::string& origin) {
  if (primitives.size() == 0) throw InputError(origin + ": no motion primitive is in use");
  if (primitives.size() > kMostPrimitives) {
    throw InputError(fmt::format("{}: {} motion primitives; at most {} are possible", origin,
                                 primitives.size(), kMostPrimitives));
  }
  for (const auto* rows : {&primitives.long_moves, &primitives.short_moves}) {
    for (const std::vector<int>& row : *rows) {
      for (int j = 0; j < space.size(); ++j) {
        if (!space.joint(j).continuous) continue;
        const auto i = static_cast<std::size_t>(j);
        const long cells = std::lround(2 * std::numbers::pi / discretization[i]);
        if (2L * std::abs(row[i]) < cells) continue;
        throw InputError(fmt::format(
            "{}: a motion primitive moves the continuous joint {} by {} cells, half a turn or more",
            origin, space.joint(j).name, row[i]));
      }
    }
  }
}

}  // namespace

ManipulationGraphOptions ResolveOptions(const AraSettings& settings, const NamedFile& primitives,
                                        const Robot& robot, const PlanningGroup& group,
                                        const std::string& origin) {
  const JointSpace& space = group.space;
  const std::vector<char> major =
      MajorJoints(space, JointReaches(robot, group), ArmsOf(robot.model, group));
  ManipulationGraphOptions options;
  for (const JointSpace::Joint& joint : space.joints()) {
    const auto cell = settings.discretization.find(joint.name);
    if (cell == settings.discretization.end() && !settings.discretization.empty()) {
      throw InputError(fmt::format("{}: discretization: joint {} has none", origin, joint.name));
    }
    const double size = settings.discretization.empty() ? DefaultCell(joint) : cell->second;
    const double range = joint.upper - joint.lower;
    const bool fits = settings.fit_cells && !joint.continuous;
    options.discretization.push_back(fits ? range / std::max(1.0, std::round(range / size)) : size);
    const std::string why = Lattice::WhyNoAxis(joint, options.discretization.back());
    if (!why.empty()) throw InputError(origin + ": " + why);
    const auto weight = settings.joint_weights.find(joint.name);
    options.weights.push_back(weight == settings.joint_weights.end() ? 1 : weight->second);
  }
  options.primitives = settings.primitives.empty()
                           ? DefaultPrimitives(space, options.discretization, major,
                                               JointsOnOneArm(robot.model, group))
                           : PrimitivesOfFile(primitives, space, options.discretization);
  if (!settings.use_long_primitives) options.primitives.long_moves.clear();
  if (!settings.use_short_primitives) options.primitives.short_moves.clear();
  RequireUsable(options.primitives, space, options.discretization, origin);
  options.long_moves_beyond = settings.long_primitives_beyond;
  options.short_moves_within = settings.short_primitives_within;
  options.cost = settings.cost;
  options.evaluation = settings.evaluation;
  options.refine = settings.refine;
  options.shorten = settings.shorten;
  options.bridge_after = settings.bridge_after;
  options.burs = settings.burs;
  options.wrap_heuristic = settings.wrap_heuristic;
  options.crowding = settings.crowding;
  options.arm_by_arm = settings.arm_by_arm;
  options.crowded_joints = major;
  if (!settings.crowding_joints.empty()) {
    options.crowded_joints.assign(major.size(), false);
    for (const std::string& name : settings.crowding_joints) {
      const int j = space.Find(name);
      if (j < 0) throw InputError(fmt::format("{}: crowding_joints: no joint {}", origin, name));
      options.crowded_joints[static_cast<std::size_t>(j)] = true;
    }
  }
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
      arms_(options_.arm_by_arm ? ArmsOf(edges->checker().robot().model, edges->checker().group())
                                : OneArm(edges->checker().group())),
      goal_cells_(start.size()),
      from_(start.size()),
      to_(start.size()),
      target_(start.size()) {
  if (options_.burs && edges->checker().model() == CollisionModel::kVoxels) {
    throw InputError(
        "burs: the collision model 'voxels' has distances between cells, which prove no motion "
        "free: take another model, or burs: false");
  }
  // The turns of a state are known of moves alone.
  if (arms_.num > 1 && options_.wrap_heuristic) {
    first_move_ = static_cast<std::uint16_t>(kArmToGoal + arms_.num);
  }
  const MotionPrimitives& primitives = options_.primitives;
  if (!AddMoves(primitives.long_moves, true) || !AddMoves(primitives.short_moves, false)) {
    throw InputError(fmt::format("{} motion primitives are more than the edges of a state can be",
                                 primitives.size()));
  }
  finest_moves_ = primitives.long_moves.empty() ? primitives.short_moves : primitives.long_moves;
  if (options_.cost == MoveCost::kUniform) {
    double longest = 1;
    for (const Move& move : moves_) longest = std::max(longest, move.length);
    unit_ = 1 / longest;
  }
  moves_depend_on_place_ =
      options_.long_moves_beyond > 0 || std::isfinite(options_.short_moves_within);

  const JointSpace& space = edges_->space();
  const Configuration root(start.begin(), start.end());
  const GoalDistance start_distance(space, {root, root, root}, options_.weights);
  for (int j = 0; j < space.size(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    goal_cells_[i] = lattice_.Nearest(j, goal_.nominal[i]);
    goal_terms_.push_back(goal_distance_.SquaredTerms(j, lattice_.values(j)));
    start_terms_.push_back(start_distance.SquaredTerms(j, lattice_.values(j)));
  }
  MakeRoomForKnowledge();
  std::vector<int> place_cells(start.size(), 0);
  for (std::size_t j = 0; j < options_.crowded_joints.size(); ++j) {
    if (!options_.crowded_joints[j]) continue;
    for (const Move& move : moves_) place_cells[j] = std::max(place_cells[j], move.cells[j]);
  }
  guide_.emplace(&lattice_, &goal_terms_, &goal_cells_, arms_, unit_, options_.crowding,
                 std::move(place_cells));
  points_.FindOrAdd(lattice_.anchor());
  if (!options_.wrap_heuristic) {
    turns_.emplace(start.size());
    std::fill_n(turns_->Append(), start.size(), std::int8_t{0});
  }
}

void ManipulationGraph::GuideByTip(std::unique_ptr<TipDistance> distance, double weight) {
  guide_->ByTip(std::move(distance), weight);
}

void ManipulationGraph::GuideRound(std::span<const std::optional<double>> walls) {
  terms_round_walls_ = goal_terms_;
  for (std::size_t j = 0; j < walls.size(); ++j) {
    if (!walls[j]) continue;
    const auto joint = static_cast<int>(j);
    terms_round_walls_[j] =
        goal_distance_.SquaredTermsRound(joint, lattice_.values(joint), *walls[j]);
  }
  guide_->MeasureBy(&terms_round_walls_);
}

void ManipulationGraph::AddPaths(std::span<const Path> paths) {
  recalled_.emplace(edges_->space(), lattice_, options_.weights, paths);
}

bool ManipulationGraph::Refine() {
  if (!options_.refine) return false;
  std::vector<std::vector<int>> halves;
  for (std::vector<int> row : finest_moves_) {
    if (std::any_of(row.begin(), row.end(), [](int cells) { return std::abs(cells) == 1; }))
      continue;
    for (int& cells : row) cells /= 2;
    halves.push_back(std::move(row));
  }
  if (halves.empty()) return false;
  std::set<std::vector<int>> known;
  for (const Move& move : moves_) known.insert(move.cells);
  std::vector<std::vector<int>> added;
  std::ranges::copy_if(halves, std::back_inserter(added),
                       [&](const std::vector<int>& row) { return known.insert(row).second; });
  if (!AddMoves(added, false)) return false;
  finest_moves_ = std::move(halves);
  MakeRoomForKnowledge();
  options_.short_moves_within = kInfinity;
  moves_depend_on_place_ = options_.long_moves_beyond > 0;
  return true;
}

void ManipulationGraph::AddRandomMoves(int num, std::uint64_t seed) {
  std::vector<int> most(from_.size(), 1);  // cells, by joint
  for (const Move& move : moves_) {
    for (std::size_t j = 0; j < most.size(); ++j) most[j] = std::max(most[j], move.cells[j]);
  }
  std::mt19937_64 random(seed);
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(num), most);
  for (std::vector<int>& row : rows) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      const auto joint = static_cast<int>(j);
      double reach = kRandomReach * most[j];
      if (edges_->space().joint(joint).continuous) {  // less than half a turn
        reach = std::min<double>(reach, (lattice_.num_cells(joint) - 1) / 2);
      }
      row[j] = static_cast<int>(std::lround((2 * UniformFraction(&random) - 1) * reach));
    }
  }
  if (AddMoves(rows, true)) MakeRoomForKnowledge();
}

// Of one record a state, which is wide enough for all of its edges.
void ManipulationGraph::MakeRoomForKnowledge() {
  const std::size_t words = (2 * (first_move_ + moves_.size()) + 63) / 64;
  if (words <= known_edges_.width()) return;
  ChunkedArray<std::uint64_t> wider(words);
  for (std::size_t state = 0; state < known_edges_.size(); ++state) {
    std::copy_n(known_edges_.Record(state), known_edges_.width(), wider.Append());
  }
  known_edges_ = std::move(wider);
}

double ManipulationGraph::LengthOf(const std::vector<int>& row) const {
  double sum = 0;
  for (std::size_t j = 0; j < row.size(); ++j) {
    const double weighted = options_.weights[j] * row[j] * lattice_.step(static_cast<int>(j));
    sum += weighted * weighted;
  }
  return std::sqrt(sum);
}

bool ManipulationGraph::AddMoves(const std::vector<std::vector<int>>& rows, bool are_long) {
  if (first_move_ + moves_.size() + 2 * rows.size() > kSpine) return false;
  const JointSpace& space = edges_->space();
  const std::vector<double>& reach = edges_->checker().motion_bound().reach();
  for (const std::vector<int>& row : rows) {
    double motion_m = 0;
    for (int j = 0; j < space.size(); ++j) {
      const auto i = static_cast<std::size_t>(j);
      const double motion = row[i] * lattice_.step(j);
      motion_m += reach[i] * std::abs(motion);
    }
    std::vector<int> opposite = row;
    for (int& cells : opposite) cells = -cells;
    const double length = LengthOf(row);
    moves_.push_back({row, length, motion_m, are_long});
    moves_.push_back({std::move(opposite), length, motion_m, are_long});
  }
  return true;
}

double ManipulationGraph::SquaredDistance(const std::vector<std::vector<double>>& terms,
                                          std::span<const Lattice::Coordinate> coordinates) {
  double sum = 0;
  for (std::size_t j = 0; j < coordinates.size(); ++j) sum += terms[j][coordinates[j]];
  return sum;
}

double ManipulationGraph::SquaredGoalDistance(std::span<const Lattice::Coordinate> coordinates,
                                              const std::int8_t* turns) const {
  if (turns == nullptr) return SquaredDistance(goal_terms_, coordinates);
  double sum = 0;
  for (std::size_t j = 0; j < coordinates.size(); ++j) {
    const auto joint = static_cast<int>(j);
    if (!edges_->space().joint(joint).continuous) {
      sum += goal_terms_[j][coordinates[j]];
      continue;
    }
    const double value = lattice_.Value(joint, coordinates[j]) + 2 * std::numbers::pi * turns[j];
    const double weighted = options_.weights[j] * (value - goal_.nominal[j]);
    sum += weighted * weighted;
  }
  return sum;
}

double ManipulationGraph::Heuristic(StateId state) const {
  if (state == kGoal) return 0;
  const std::uint32_t point = state - 1;
  return unit_ * std::sqrt(SquaredGoalDistance(points_.Coordinates(point),
                                               turns_ ? turns_->Record(point) : nullptr));
}

double ManipulationGraph::LeastCostTo(const GoalBox& goal) const {
  Configuration start(from_.size());
  ConfigurationOf(kStart, start);
  return CostOf(GoalDistance(edges_->space(), goal, options_.weights)(start));
}

std::uint32_t ManipulationGraph::TargetPoint(StateId source, const Move& move, int times) {
  const std::uint32_t point = points_.FindOrAdd(target_);
  if (!turns_ || point < turns_->size()) return point;
  std::int8_t* turns = turns_->Append();
  const std::int8_t* before = turns_->Record(source - 1);
  const std::span<const Lattice::Coordinate> from = points_.Coordinates(source - 1);
  for (std::size_t j = 0; j < target_.size(); ++j) {
    const auto joint = static_cast<int>(j);
    const double motion = times * move.cells[j] * lattice_.step(joint);
    const double beyond =
        lattice_.Value(joint, from[j]) + motion - lattice_.Value(joint, target_[j]);
    turns[j] = static_cast<std::int8_t>(before[j] + std::lround(beyond / (2 * std::numbers::pi)));
  }
  return point;
}

// Of a straight motion.
double ManipulationGraph::CostOf(double length) const {
  return options_.cost == MoveCost::kUniform ? std::max(1.0, unit_ * length) : length;
}

const ManipulationGraph::Move& ManipulationGraph::MoveOf(std::uint16_t action) const {
  return moves_[static_cast<std::size_t>((action & ~kSpine) - first_move_)];
}

float ManipulationGraph::ClearanceOf(StateId state) {
  while (clearances_.size() <= state) clearances_.Append();
  float& clearance_m = clearances_[state];
  if (clearance_m == 0) {
    SelectSource(state);
    double found_m = 0;
    edges_->FindClearances(from_, 1, kLongestSpine, {&found_m, 1});
    clearance_m = static_cast<float>(found_m);
  }
  return clearance_m;
}

// How often a move can be made in a row before anything can touch: bodies come no nearer to each
// other than the bound on their motion.
int ManipulationGraph::SpineLength(StateId source, const Move& move) {
  const double motion_m = std::max(move.motion_m, kLeastMotion);
  int times = static_cast<int>(std::ceil(ClearanceOf(source) / motion_m)) - 1;
  for (std::size_t j = 0; j < move.cells.size(); ++j) {
    const auto joint = static_cast<int>(j);
    const int cells = std::abs(move.cells[j]);
    if (cells == 0 || !edges_->space().joint(joint).continuous) continue;
    times = std::min(times, (lattice_.num_cells(joint) - 1) / 2 / cells);  // less than half a turn
  }
  while (times > 0 && !MoveFrom(source, move, times)) --times;
  return std::max(times, 0);
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

// Sets target_ to where the move leads, made so many times; false if that is outside the limits.
bool ManipulationGraph::MoveFrom(StateId source, const Move& move, int times) {
  const std::span<const Lattice::Coordinate> coordinates = points_.Coordinates(source - 1);
  for (std::size_t j = 0; j < coordinates.size(); ++j) {
    if (!lattice_.Move(static_cast<int>(j), coordinates[j], times * move.cells[j], &target_[j])) {
      return false;
    }
  }
  return true;
}

// Sets target_ to where such an edge leads.
void ManipulationGraph::MoveArmToGoal(StateId source, std::uint16_t action) {
  std::ranges::copy(points_.Coordinates(source - 1), target_.begin());
  for (std::size_t j = 0; j < target_.size(); ++j) {
    if (arms_.of_joint[j] == action - kArmToGoal) target_[j] = goal_cells_[j];
  }
}

// The waypoint that such an edge leads to, kNone if the state has fewer of them.
int ManipulationGraph::WaypointOf(StateId source, std::uint16_t action) {
  if (source != joined_) {
    joined_ = source;
    SelectSource(source);
    waypoints_ = recalled_->NeighboursOf(points_.Coordinates(source - 1), from_);
  }
  return waypoints_[action - kToRecalled];
}

void ManipulationGraph::CandidateEdges(StateId state, std::vector<CandidateEdge>* candidates) {
  // Where the goal can be had at once, no guide is needed.
  const bool by_tip = guide_->by_tip() &&
                      !(state == kStart && CheckEdge(state, kToNearestGoal) == EdgeVerdict::kFree);
  if (by_tip) SelectSource(state);
  guide_->SelectSource(points_.Coordinates(state - 1),
                       by_tip ? std::span<const double>(from_) : std::span<const double>());
  const bool eager = options_.evaluation == Evaluation::kEager;
  const auto is_candidate = [&](std::uint16_t action) {
    return !eager || CheckEdge(state, action) != EdgeVerdict::kBlocked;
  };
  if (is_candidate(kToNearestGoal)) {
    const double distance = std::sqrt(SquaredDistance(goal_terms_, points_.Coordinates(state - 1)));
    candidates->push_back({CostOf(distance), 0, 0, kToNearestGoal});
  }
  if (goal_distance_.has_extent() && is_candidate(kToNominalGoal)) {
    SelectSource(state);
    const double distance =
        WeightedDistance(edges_->space(), options_.weights, from_, goal_.nominal);
    candidates->push_back({CostOf(distance), 0, 0, kToNominalGoal});
  }

  for (std::uint16_t action = kToRecalled; recalled_ && action < kArmToGoal; ++action) {
    const int waypoint = WaypointOf(state, action);
    if (waypoint == RecalledPaths::kNone || !is_candidate(action)) continue;
    SelectEdge(state, action);
    const double length = WeightedDistance(edges_->space(), options_.weights, from_, to_);
    const double heuristic =
        unit_ * std::sqrt(SquaredDistance(goal_terms_, recalled_->CoordinatesOf(waypoint)));
    candidates->push_back({CostOf(length), heuristic, 0, action});
  }

  for (std::uint16_t action = kArmToGoal; action < first_move_; ++action) {
    SelectEdge(state, action);
    const bool is_there = std::ranges::equal(target_, points_.Coordinates(state - 1));
    if (is_there || !is_candidate(action)) continue;
    const double length = WeightedDistance(edges_->space(), options_.weights, from_, to_);
    const double heuristic = unit_ * std::sqrt(SquaredDistance(goal_terms_, target_));
    candidates->push_back({CostOf(length), heuristic, (*guide_)(target_, heuristic), action});
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
    if (!(move.is_long ? use_long : use_short)) continue;
    // An edge to target_.
    const auto offer = [&](std::uint16_t action, int times) {
      const double heuristic = turns_ ? Heuristic(TargetPoint(state, move, times) + 1)
                                      : unit_ * std::sqrt(SquaredDistance(goal_terms_, target_));
      candidates->push_back(
          {CostOf(times * move.length), heuristic, (*guide_)(target_, heuristic), action});
    };
    const auto action = static_cast<std::uint16_t>(first_move_ + m);
    if (options_.burs) {
      const int times = SpineLength(state, move);
      if (times > 0) Remember(state, action, EdgeVerdict::kFree);
      if (times > 1) offer(action | kSpine, times);
    }
    if (MoveFrom(state, move) && is_candidate(action)) offer(action, 1);
  }
}

StateId ManipulationGraph::Target(StateId source, std::uint16_t action) {
  if (action < kToRecalled) return kGoal;
  if (action < kArmToGoal) {
    return points_.FindOrAdd(recalled_->CoordinatesOf(WaypointOf(source, action))) + 1;
  }
  if (action < first_move_) {
    MoveArmToGoal(source, action);
    return points_.FindOrAdd(target_) + 1;
  }
  const Move& move = MoveOf(action);
  const int times = (action & kSpine) != 0 ? SpineLength(source, move) : 1;
  MoveFrom(source, move, times);
  return TargetPoint(source, move, times) + 1;
}

EdgeVerdict ManipulationGraph::CheckEdge(StateId source, std::uint16_t action) {
  if ((action & kSpine) != 0) return EdgeVerdict::kFree;
  const EdgeVerdict known = Recall(source, action);
  if (known != EdgeVerdict::kUnknown) return known;
  SelectEdge(source, action);
  const bool valid = edges_->IsValidEdge(from_, to_, /*from_is_free=*/true);
  if (edges_->GaveUp()) return EdgeVerdict::kUnknown;
  if (action < kToRecalled) ++num_goal_connections_tried_;
  if (valid && action >= kToRecalled && action < kArmToGoal) ++num_recalled_edges_;
  const EdgeVerdict verdict = valid ? EdgeVerdict::kFree : EdgeVerdict::kBlocked;
  Remember(source, action, verdict);
  return verdict;
}

// Sets from_ and to_ to the ends of an edge.
void ManipulationGraph::SelectEdge(StateId source, std::uint16_t action) {
  SelectSource(source);
  if (action < kToRecalled) {
    GoalConfiguration(action, from_, to_);
    return;
  }
  if (action < kArmToGoal) {
    std::ranges::copy(recalled_->ConfigurationOf(WaypointOf(source, action)), to_.begin());
    return;
  }
  if (action < first_move_) {
    MoveArmToGoal(source, action);
  } else {
    MoveFrom(source, MoveOf(action));
  }
  for (std::size_t j = 0; j < to_.size(); ++j) {
    to_[j] = lattice_.Value(static_cast<int>(j), target_[j]);
  }
}

void ManipulationGraph::GoalConfiguration(std::uint16_t action, std::span<const double> from,
                                          std::span<double> to) const {
  if (action == kToNearestGoal) {
    goal_distance_.Nearest(from, to);
  } else {
    std::copy(goal_.nominal.begin(), goal_.nominal.end(), to.begin());
  }
}

EdgeVerdict ManipulationGraph::Recall(StateId source, std::uint16_t action) {
  if (known_edges_.size() <= source) return EdgeVerdict::kUnknown;
  const std::size_t bit = 2 * static_cast<std::size_t>(action);
  return static_cast<EdgeVerdict>(known_edges_.Record(source)[bit / 64] >> bit % 64 & 3);
}

void ManipulationGraph::Remember(StateId source, std::uint16_t action, EdgeVerdict verdict) {
  while (known_edges_.size() <= source) known_edges_.Append();
  const std::size_t bit = 2 * static_cast<std::size_t>(action);
  std::uint64_t& word = known_edges_.Record(source)[bit / 64];
  word = (word & ~(std::uint64_t{3} << bit % 64)) | static_cast<std::uint64_t>(verdict) << bit % 64;
}

double ManipulationGraph::CostOf(const Path& path) const {
  double cost = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    cost += CostOf(WeightedDistance(edges_->space(), options_.weights, path[i - 1], path[i]));
  }
  return cost;
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
