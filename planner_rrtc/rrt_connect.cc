#include "planner_rrtc/rrt_connect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/stopwatch.h"
#include "planner_rrtc/stopped_search.h"

namespace planbench {
namespace {

/// Extensions prepared together: few after a success, when the next may succeed too, more with
/// every batch that fails.
constexpr int kSmallestBatch = 4;
constexpr int kLargestBatch = 16;

/// Change of a node's domain at a success or a failure, relative.
constexpr double kDomainChange = 1e-4;

}  // namespace

RrtConnect::RrtConnect(const JointSpace& joints)
    : joints_(joints),
      flat_(joints),
      trees_{Tree(joints), Tree(joints)},
      samples_(At(kLargestBatch)),
      candidates_(kLargestBatch),
      ends_(At(kLargestBatch)),
      unchecked_ends_(At(kLargestBatch)),
      reached_(flat_.size()),
      step_(flat_.size()) {}

void RrtConnect::Clear() {
  for (Tree& tree : trees_) {
    tree.nodes.Clear();
    tree.domains.clear();
  }
  num_iterations_ = num_out_of_domain_ = 0;
  num_goals_drawn_ = num_drawn_ = 0;
  nearest_ticks_ = 0;
}

int RrtConnect::Add(int tree, const double* q, int parent) {
  trees_[tree].domains.push_back(std::numeric_limits<double>::infinity());
  return trees_[tree].nodes.Add({q, flat_.size()}, parent);
}

bool RrtConnect::IsValidEdge(const double* from, const double* to) {
  const std::size_t n = flat_.size();
  return edges_->IsValidEdge({from, n}, {to, n}, /*from_is_free=*/true);
}

bool RrtConnect::InDomain(const Candidate& candidate) const {
  return candidate.near.distance <=
         trees_[candidate.tree].domains[static_cast<std::size_t>(candidate.near.node)];
}

void RrtConnect::AddGoal(GoalSampler* goals) {
  const Configuration q = goals->Sample();
  // The first is the nominal goal, known to be valid.
  if (num_goals_drawn_++ == 0 || edges_->IsValidState(q)) {
    Add(kGoal, q.data(), NodeTree::kNoParent);
  }
}

int RrtConnect::NextTree(int last) const {
  const int other = 1 - last;
  return settings_->balance && NumStates(other) > NumStates(last) ? last : other;
}

void RrtConnect::Prepare(JointSampler* sampler, int num, int last) {
  const std::size_t n = flat_.size();
  for (; num_drawn_ < num; ++num_drawn_) sampler->Sample(samples_.data() + At(num_drawn_));
  {
    const ScopedTimer timer(&nearest_ticks_);
    for (int k = 0; k < num; ++k) {
      Candidate& candidate = candidates_[static_cast<std::size_t>(k)];
      candidate.tree = last = NextTree(last);
      candidate.near = trees_[last].nodes.Nearest(samples_.data() + At(k));
    }
  }
  unchecked_.clear();
  for (int k = 0; k < num; ++k) {
    const double* sample = samples_.data() + At(k);
    Candidate& candidate = candidates_[static_cast<std::size_t>(k)];
    candidate.in_domain = InDomain(candidate);
    if (!candidate.in_domain) continue;
    flat_.Interpolate(trees_[candidate.tree].nodes.Positions(candidate.near.node), sample,
                      std::min(1.0, range_ / candidate.near.distance), ends_.data() + At(k));
    std::copy_n(ends_.data() + At(k), n,
                unchecked_ends_.data() + At(static_cast<int>(unchecked_.size())));
    unchecked_.push_back(k);
  }
  const auto count = static_cast<int>(unchecked_.size());
  verdicts_.resize(unchecked_.size());
  edges_->ScreenStates({unchecked_ends_.data(), At(count)}, count, verdicts_);
  for (std::size_t i = 0; i < unchecked_.size(); ++i) {
    candidates_[static_cast<std::size_t>(unchecked_[i])].end_passes = verdicts_[i] != 0;
  }
}

int RrtConnect::Extend(int k, double* reached) {
  const std::size_t n = flat_.size();
  const Candidate& candidate = candidates_[static_cast<std::size_t>(k)];
  NodeTree& nodes = trees_[candidate.tree].nodes;
  double& domain = trees_[candidate.tree].domains[static_cast<std::size_t>(candidate.near.node)];
  std::copy_n(ends_.data() + At(k), n, reached);
  if (!candidate.end_passes || !IsValidEdge(nodes.Positions(candidate.near.node), reached)) {
    if (settings_->domain_radius > 0) {
      domain = std::max(
          range_, std::isinf(domain) ? settings_->domain_radius : domain * (1 - kDomainChange));
    }
    return -1;
  }
  domain *= 1 + kDomainChange;
  int node = Add(candidate.tree, reached, candidate.near.node);
  if (settings_->extension == Extension::kStep) return node;
  const double* sample = samples_.data() + At(k);
  // Of a tiny range more than an int counts; edges given up end them.
  for (double i = 1; i * range_ < candidate.near.distance; ++i) {
    const double t = std::min(1.0, (i + 1) * range_ / candidate.near.distance);
    flat_.Interpolate(nodes.Positions(candidate.near.node), sample, t, step_.data());
    if (!IsValidEdge(nodes.Positions(node), step_.data())) break;
    std::copy_n(step_.data(), n, reached);
    node = Add(candidate.tree, reached, node);
  }
  return node;
}

int RrtConnect::Connect(int tree, const double* q) {
  const NodeTree& nodes = trees_[tree].nodes;
  NodeTree::Neighbor near;
  {
    const ScopedTimer timer(&nearest_ticks_);
    near = nodes.Nearest(q);
  }
  const double num_steps = std::max(1.0, std::ceil(near.distance / range_));
  int node = near.node;
  for (double i = 1; i <= num_steps; ++i) {
    flat_.Interpolate(nodes.Positions(near.node), q, i / num_steps, step_.data());
    if (!IsValidEdge(nodes.Positions(node), step_.data())) return -1;
    if (i < num_steps) node = Add(tree, step_.data(), node);
  }
  return node;
}

std::optional<RrtConnect::Meeting> RrtConnect::Follow(const Path& way) {
  // The nodes that the trees get to; the other tree then has them in reach, or not.
  const auto follow = [&](int tree, auto begin, auto end) -> std::optional<Meeting> {
    int last = -1;
    for (auto q = begin; q != end; ++q) {
      const int node = Connect(tree, q->data());
      if (node < 0) break;
      last = Add(tree, q->data(), node);
    }
    if (last < 0) return std::nullopt;
    std::copy_n(trees_[tree].nodes.Positions(last), flat_.size(), reached_.data());
    const int other = Connect(1 - tree, reached_.data());
    if (other < 0) return std::nullopt;
    return tree == kStart ? Meeting{last, other} : Meeting{other, last};
  };
  if (const auto meeting = follow(kStart, way.begin(), way.end())) return meeting;
  return follow(kGoal, way.rbegin(), way.rend());
}

std::optional<RrtConnect::Meeting> RrtConnect::Recall(const PathLibrary& experience,
                                                      const SearchQuery& query) {
  range_ = settings_->range.value_or(ShrinkingRange(0));
  for (const Path& way :
       experience.Recall(joints_, query.start(), query.goal().nominal, settings_->recall)) {
    if (query.ShouldStop()) break;
    if (const auto meeting = Follow(way)) return meeting;
  }
  return std::nullopt;
}

Path RrtConnect::PathThrough(const Meeting& meeting) const {
  Path path;
  const auto append = [&](int tree, int node) {
    const NodeTree& nodes = trees_[tree].nodes;
    for (; node != NodeTree::kNoParent; node = nodes.Parent(node)) {
      path.emplace_back(nodes.Positions(node), nodes.Positions(node) + flat_.size());
    }
  };
  append(kStart, meeting.start_node);
  std::reverse(path.begin(), path.end());
  append(kGoal, meeting.goal_node);
  return path;
}

std::optional<RrtConnect::Meeting> RrtConnect::Grow(const SearchQuery& query, JointSampler* sampler,
                                                    GoalSampler* goals) {
  int tree = kGoal;  // the last that was extended
  int batch = kSmallestBatch;
  while (!query.ShouldStop()) {
    // As OMPL does: the goals drawn keep up with half the size of the tree.
    if (num_goals_drawn_ < std::min(goals->max_samples(), NumStates(kGoal) / 2)) AddGoal(goals);
    range_ = settings_->range.value_or(ShrinkingRange(num_iterations_));
    Prepare(sampler, batch, tree);
    int taken = 0;
    bool grown = false;
    while (taken < batch && !grown) {
      const int k = taken++;
      ++num_iterations_;
      const Candidate& candidate = candidates_[static_cast<std::size_t>(k)];
      tree = candidate.tree;
      // Once more: a failure of this batch may have narrowed the domain.
      if (!candidate.in_domain || !InDomain(candidate)) {
        ++num_out_of_domain_;
        continue;
      }
      const int node = Extend(k, reached_.data());
      if (node < 0) continue;
      grown = true;
      const int other_node = Connect(1 - tree, reached_.data());
      if (other_node < 0) continue;
      return tree == kStart ? Meeting{node, other_node} : Meeting{other_node, node};
    }
    num_drawn_ -= taken;
    std::copy_n(samples_.data() + At(taken), At(num_drawn_), samples_.data());
    batch = grown ? kSmallestBatch : std::min(2 * batch, kLargestBatch);
  }
  return std::nullopt;
}

SearchResult RrtConnect::Search(const RrtcSettings& settings, const PathLibrary* experience,
                                const SearchQuery& query) {
  settings_ = &settings;
  edges_ = &query.edges();
  Clear();
  JointSampler sampler(joints_, settings.sampler, query.seed());
  // Another seed than the sampler's, lest goals and samples be the same numbers.
  GoalSampler goals(joints_, query.goal(), ~query.seed());
  Configuration start = query.start();
  joints_.Wrap(start);
  Add(kStart, start.data(), NodeTree::kNoParent);
  AddGoal(&goals);

  std::optional<Meeting> meeting;
  if (experience != nullptr) meeting = Recall(*experience, query);
  const int num_recalled = NumStates(kStart) + NumStates(kGoal) - 2;
  if (!meeting) meeting = Grow(query, &sampler, &goals);
  SearchResult result;
  if (meeting) {
    result.status = PlanStatus::kSolved;
    result.path = PathThrough(*meeting);
  } else {
    result = StoppedSearch(query);
  }
  result.guidance_ticks = nearest_ticks_;
  result.counters = {{"iterations", static_cast<double>(num_iterations_)},
                     {"states_start_tree", NumStates(kStart)},
                     {"states_goal_tree", NumStates(kGoal)}};
  if (settings.domain_radius > 0) {
    result.counters["out_of_domain"] = static_cast<double>(num_out_of_domain_);
  }
  if (experience != nullptr) result.counters["states_recalled"] = num_recalled;
  return result;
}

}  // namespace planbench
