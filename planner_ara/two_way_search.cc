#include "planner_ara/two_way_search.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/numbers.h"
#include "planner_ara/joint_walls.h"
#include "planning/proven_bound.h"
#include "planning/shortcut.h"

namespace planbench {
namespace {

/// What the guide to a first path counts beside the cost so far, whatever epsilon is asked for: the
/// bound is computed afterwards, and most often a path found in haste and shortened has it.
constexpr double kFirstGuideWeight = 100;
/// A search goes on for this much work before the other may.
constexpr std::int64_t kSlice = 200;
/// Work of an expansion, a configuration checked being 1.
constexpr std::int64_t kExpansionWork = 10;
/// The search that is in the narrower place does at most so many times the work of the other.
constexpr double kMostWorkRatio = 5;
/// Walls are sought after so many expansions without a path: by then most searches have one.
constexpr std::int64_t kSeekWallsAfter = 500;
/// The bridge's search goes on for this much work after each turn of another, as long as it has
/// done less than they in the mean.
constexpr std::int64_t kBridgeSlice = 1000;
/// With this bridge the searches get so many random moves.
constexpr int kRandomMovesWithBridge = 4;
constexpr int kNumRandomMoves = 32;
constexpr std::uint64_t kRandomMovesSeed = 1;
constexpr std::uint64_t kShortcutSeed = 1;
constexpr int kShortcutRounds = 4;
/// Clearance beyond which a state is as good as any, m.
constexpr double kWide = 0.5;

/// The work of a search since this was made.
class WorkMeter {
 public:
  WorkMeter(const EdgeChecker* edges, std::int64_t expansions)
      : edges_(edges), configurations_(edges->counters().configurations), expansions_(expansions) {}
  std::int64_t Work(std::int64_t expansions) const {
    return edges_->counters().configurations - configurations_ +
           kExpansionWork * (expansions - expansions_);
  }

 private:
  const EdgeChecker* edges_;
  std::int64_t configurations_;
  std::int64_t expansions_;
};

}  // namespace

struct TwoWaySearch::Side {
  Side(EdgeChecker* edges, const Configuration& start, const GoalBox& goal,
       const ManipulationGraphOptions& options)
      : root(start),
        target(goal.nominal),
        graph(edges, start, goal, options),
        least_cost(options.wrap_heuristic ? graph.LeastCostTo(goal) : 0),
        search(&graph, ManipulationGraph::kStart, ManipulationGraph::kGoal) {}

  /// The fewer, the more often moves are blocked: the narrower the place. 1 at first.
  double ExpansionsPerWork() const {
    return static_cast<double>(1 + search.num_expansions()) / static_cast<double>(1 + work);
  }

  Configuration root;
  Configuration target;
  ManipulationGraph graph;
  double least_cost;  // that a path has, known before the search has begun
  AraStar<ManipulationGraph> search;
  bool converged = false;
  std::int64_t work = 0;
  // Of the states looked at since the last bridge, the one with the most clearance.
  StateId widest = ManipulationGraph::kStart;
  double clearance_m = 0;
};

struct TwoWaySearch::Bridge {
  Bridge(EdgeChecker* edges, const Configuration& start, const GoalBox& goal,
         const ManipulationGraphOptions& options)
      : search(edges, start, goal, options, /*two_way=*/true) {}

  TwoWaySearch search;
  std::array<StateId, 2> ends{};  // by side
  std::int64_t work = 0;
};

TwoWaySearch::TwoWaySearch(EdgeChecker* edges, const Configuration& start, const GoalBox& goal,
                           const ManipulationGraphOptions& options, bool two_way)
    : edges_(edges),
      options_(options),
      may_have_walls_(options.wrap_heuristic),
      bridge_at_(options.bridge_after) {
  sides_.push_back(std::make_unique<Side>(edges, start, goal, options));
  if (!two_way) return;
  const GoalBox back_to_start{start, start, start};
  sides_.push_back(std::make_unique<Side>(edges, goal.nominal, back_to_start, options));
}

TwoWaySearch::~TwoWaySearch() = default;

TwoWaySearch::Counts& TwoWaySearch::Counts::operator+=(const Counts& more) {
  expansions += more.expansions;
  states += more.states;
  edges_generated += more.edges_generated;
  goal_connections_tried += more.goal_connections_tried;
  recalled_edges += more.recalled_edges;
  iterations = std::max(iterations, more.iterations);
  return *this;
}

TwoWaySearch::Counts TwoWaySearch::Counts::Since(const Counts& before) const {
  Counts since = *this;
  since.expansions -= before.expansions;
  since.states -= before.states;
  since.edges_generated -= before.edges_generated;
  since.goal_connections_tried -= before.goal_connections_tried;
  since.recalled_edges -= before.recalled_edges;
  return since;
}

void TwoWaySearch::GuideByTip(const Scene& scene, std::span<const double> base_positions,
                              double weight) {
  tip_guide_ = {&scene, {base_positions.begin(), base_positions.end()}, weight};
  const CollisionChecker& checker = edges_->checker();
  const Side& forward = *sides_.front();
  const auto grid = std::make_shared<TipGrid>(scene, checker.robot().model, checker.group(),
                                              base_positions, forward.root, forward.target);
  for (const auto& side : sides_) {
    side->graph.GuideByTip(std::make_unique<TipDistance>(grid, side->target), weight);
  }
}

void TwoWaySearch::AddPaths(std::span<const Path> paths) {
  for (const auto& side : sides_) side->graph.AddPaths(paths);
}

void TwoWaySearch::SetKnownCost(double cost) {
  if (cost >= best_cost()) return;
  known_cost_ = cost;
  // A guided search ends at a path alone. Beside one known from elsewhere there may be none.
  phase_ = Phase::kProof;
  GiveUpBridge();
  for (const auto& side : sides_) side->search.SetUpperBound(cost);
}

TwoWaySearch::Side* TwoWaySearch::NextSide() const {
  Side* first = sides_.front().get();
  Side* last = sides_.back().get();
  if (first->converged) return last->converged ? nullptr : last;
  if (last->converged) return first;
  const double r = first->ExpansionsPerWork() / last->ExpansionsPerWork();
  // How many times as much work as the first the last is to do.
  const double share = std::clamp(r * r * r, 1 / kMostWorkRatio, kMostWorkRatio);
  return share * static_cast<double>(first->work) <= static_cast<double>(last->work) ? first : last;
}

ImproveOutcome TwoWaySearch::Improve(double epsilon, const std::function<bool()>& should_stop,
                                     const std::function<void(double)>& on_solution) {
  const bool guided = tip_guide_ || options_.crowding > 0;
  if (phase_ == Phase::kFirst && !guided) phase_ = Phase::kProof;
  BeginPhase(phase_ == Phase::kFirst && cost_ < kInfinity ? Phase::kBetter : phase_);
  const auto reaches_epsilon = [&] {
    const double lower_bound = ProveLowerBound();
    on_solution(lower_bound);
    return ProvenBound(best_cost(), lower_bound) <= epsilon;
  };
  if (ShortenPath(should_stop) && reaches_epsilon()) return ImproveOutcome::kConverged;
  while (true) {
    Side* side = NextSide();
    if (side == nullptr && phase_ == Phase::kBetter) {
      BeginPhase(Phase::kProof);
      continue;
    }
    if (side == nullptr) break;
    const EdgeOrder order = phase_ == Phase::kProof ? EdgeOrder::kHeuristic : EdgeOrder::kGuide;
    const bool alone = sides_.size() == 1;
    const bool may_seek_walls = phase_ == Phase::kFirst && may_have_walls_;
    if (may_seek_walls && counts().expansions >= kSeekWallsAfter) SeekWalls();
    const bool takes_turns = !alone || may_seek_walls;
    const WorkMeter meter(edges_, side->search.num_expansions());
    const double cost_before = side->search.goal_cost();
    bool stopped = false;
    const ImproveOutcome outcome = side->search.ImprovePath(
        phase_ == Phase::kFirst ? std::max(epsilon, kFirstGuideWeight) : epsilon,
        [&] {
          stopped = should_stop();
          return stopped || (takes_turns && meter.Work(side->search.num_expansions()) >= kSlice);
        },
        order);
    side->work += meter.Work(side->search.num_expansions());
    if (outcome == ImproveOutcome::kExhausted && side->graph.Refine()) {
      side->search.ExpandAgain();
      continue;
    }
    side->converged = outcome != ImproveOutcome::kStopped;
    bool is_found = side->search.goal_cost() < cost_before;
    bool is_better = is_found && Offer(side, should_stop);
    if (best_cost() == kInfinity && !alone && options_.bridge_after < kInfinity) {
      LookAround(side);
      is_found = is_better = WorkOnBridge(epsilon, should_stop);
    }
    if (is_better && (reaches_epsilon() || (ShortenPath(should_stop) && reaches_epsilon()))) {
      return ImproveOutcome::kConverged;
    }
    if (stopped) return ImproveOutcome::kStopped;
    if (is_found && phase_ != Phase::kProof) {
      BeginPhase(phase_ == Phase::kFirst ? Phase::kBetter : Phase::kProof);
    }
  }
  return best_cost() < kInfinity ? ImproveOutcome::kConverged : ImproveOutcome::kExhausted;
}

void TwoWaySearch::BeginPhase(Phase phase) {
  phase_ = phase;
  for (const auto& side : sides_) side->converged = false;
  SetCost(cost_);
}

// Takes the path that a search has found, if it is the best, or becomes that by shortcuts.
bool TwoWaySearch::Offer(const Side* side, const std::function<bool()>& should_stop) {
  Path path = side->graph.Configurations(side->search.Path());
  // States on it may have become cheaper since the goal was reached by way of them.
  double cost = std::min(side->search.goal_cost(), side->graph.CostOf(path));
  if (cost >= best_cost() && options_.shorten) {
    path = ShortcutPath(edges_, path, kShortcutSeed, kShortcutRounds, should_stop);
    cost = side->graph.CostOf(path);
  }
  if (cost >= best_cost()) return false;
  TakePath(cost, std::move(path), side != sides_.front().get());
  return true;
}

void TwoWaySearch::TakePath(double cost, Path path, bool is_backward) {
  path_ = std::move(path);
  found_backward_ = is_backward;
  is_bridged_ = false;
  may_be_shortened_ = options_.shorten;
  if (is_backward) std::reverse(path_.begin(), path_.end());
  SetCost(cost);
}

void TwoWaySearch::SetCost(double cost) {
  cost_ = cost;
  if (phase_ != Phase::kProof) return;
  for (const auto& side : sides_) side->search.SetUpperBound(cost_);
}

// True if the best path has become cheaper by shortcuts.
bool TwoWaySearch::ShortenPath(const std::function<bool()>& should_stop) {
  if (!std::exchange(may_be_shortened_, false)) return false;
  Path path = ShortcutPath(edges_, path_, kShortcutSeed, kShortcutRounds, should_stop);
  may_be_shortened_ = should_stop();  // another time
  const double cost = sides_.front()->graph.CostOf(path);
  if (cost >= cost_) return false;
  path_ = std::move(path);
  SetCost(cost);
  return true;
}

double TwoWaySearch::MeanWork() const {
  return static_cast<double>(sides_.front()->work + sides_.back()->work) / 2;
}

void TwoWaySearch::SeekWalls() {
  may_have_walls_ = false;
  const Side& forward = *sides_.front();
  const auto walls = FindWalls(edges_, forward.root, forward.target);
  if (std::none_of(walls.begin(), walls.end(), [](const auto& wall) { return wall.has_value(); })) {
    return;
  }
  for (const auto& side : sides_) {
    if (side->converged) continue;
    side->graph.GuideRound(walls);
    side->search.ExpandAgain();
  }
}

// Looks at the clearance of a state that has just been expanded, if it may be an end of the next
// bridge.
void TwoWaySearch::LookAround(Side* side) {
  if (MeanWork() < bridge_at_ / 2) return;
  const StateId state = side->search.last_expanded();
  Configuration q(side->root.size());
  side->graph.ConfigurationOf(state, q);
  double clearance_m = 0;
  edges_->FindClearances(q, 1, kWide, {&clearance_m, 1});
  if (clearance_m <= side->clearance_m) return;
  side->clearance_m = clearance_m;
  side->widest = state;
}

void TwoWaySearch::BeginBridge() {
  GiveUpBridge();
  std::array<StateId, 2> ends;
  std::array<Configuration, 2> q;
  for (std::size_t i = 0; i < 2; ++i) {
    ends[i] = std::exchange(sides_[i]->widest, ManipulationGraph::kStart);
    sides_[i]->clearance_m = 0;
    q[i].resize(sides_[i]->root.size());
    sides_[i]->graph.ConfigurationOf(ends[i], q[i]);
  }
  ManipulationGraphOptions options = options_;
  options.bridge_after = kInfinity;
  bridge_ = std::make_unique<Bridge>(edges_, q[0], GoalBox{q[1], q[1], q[1]}, options);
  bridge_->ends = ends;
  if (tip_guide_) {
    bridge_->search.GuideByTip(*tip_guide_->scene, tip_guide_->base_positions, tip_guide_->weight);
  }
}

void TwoWaySearch::GiveUpBridge() {
  if (!bridge_) return;
  bridge_counts_ += bridge_->search.counts();
  bridge_.reset();
}

bool TwoWaySearch::WorkOnBridge(double epsilon, const std::function<bool()>& should_stop) {
  if (MeanWork() >= bridge_at_) {
    BeginBridge();
    bridge_at_ *= 2;
    if (++num_bridges_ == kRandomMovesWithBridge) {
      for (const auto& side : sides_) side->graph.AddRandomMoves(kNumRandomMoves, kRandomMovesSeed);
    }
  }
  if (!bridge_ || static_cast<double>(bridge_->work) >= MeanWork()) return false;
  TwoWaySearch& search = bridge_->search;
  const WorkMeter meter(edges_, search.counts().expansions);
  search.Improve(
      epsilon,
      [&] {
        return search.cost() < kInfinity ||
               meter.Work(search.counts().expansions) >= kBridgeSlice || should_stop();
      },
      [](double) {});
  bridge_->work += meter.Work(search.counts().expansions);
  if (search.cost() == kInfinity) return false;
  double cost = search.cost();
  std::array<Path, 2> ways;  // from the roots
  for (std::size_t i = 0; i < 2; ++i) {
    const Side& side = *sides_[i];
    cost += side.search.CostTo(bridge_->ends[i]);
    ways[i] = side.graph.Configurations(side.search.PathTo(bridge_->ends[i]));
  }
  Path path = std::move(ways[0]);
  path.insert(path.end(), search.path().begin() + 1, search.path().end());
  path.insert(path.end(), ways[1].rbegin() + 1, ways[1].rend());
  cost = std::min(cost, sides_.front()->graph.CostOf(path));  // as in Offer
  TakePath(cost, std::move(path), /*is_backward=*/false);
  is_bridged_ = true;
  GiveUpBridge();
  return true;
}

double TwoWaySearch::ProveLowerBound() {
  double lower_bound = best_cost();
  for (const auto& side : sides_) {
    lower_bound = std::min(lower_bound, std::max(side->search.ProveLowerBound(), side->least_cost));
  }
  return lower_bound;
}

TwoWaySearch::Counts TwoWaySearch::counts() const {
  Counts counts = bridge_counts_;
  if (bridge_) counts += bridge_->search.counts();
  for (const auto& side : sides_) {
    counts += {side->search.num_expansions(),      side->graph.num_states(),
               side->search.num_edges_generated(), side->graph.num_goal_connections_tried(),
               side->graph.num_recalled_edges(),   side->search.num_iterations()};
  }
  return counts;
}

std::size_t TwoWaySearch::bytes() const {
  std::size_t bytes = bridge_ ? bridge_->search.bytes() : 0;
  for (const auto& side : sides_) bytes += side->graph.bytes() + side->search.bytes();
  return bytes;
}

}  // namespace planbench
