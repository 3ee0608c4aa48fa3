#include "planner_rrtc/rrt_connect.h"

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Exception.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace planbench {
namespace {

namespace ob = ompl::base;

/// Extensions prepared together: few after a success, when the next may succeed too, more with
/// every batch that fails.
constexpr int kSmallestBatch = 4;
constexpr int kLargestBatch = 16;

/// Change of a node's domain at a success or a failure, relative.
constexpr double kDomainChange = 1e-4;

class Stopwatch {
 public:
  explicit Stopwatch(double* total_s) : total_s_(total_s) {}
  ~Stopwatch() { *total_s_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double* total_s_;
  Clock::time_point begin_ = Clock::now();
};

const OmplJointSpace* JointSpaceOf(const ob::SpaceInformationPtr& si) {
  const auto* space = dynamic_cast<const OmplJointSpace*>(si->getStateSpace().get());
  if (space == nullptr) throw ompl::Exception("RrtConnect", "needs an OmplJointSpace");
  return space;
}

}  // namespace

RrtConnect::RrtConnect(const ob::SpaceInformationPtr& si, const Settings& settings)
    : ob::Planner(si, "RRT-Connect"),
      settings_(settings),
      space_(JointSpaceOf(si)),
      trees_{Tree(space_->joints()), Tree(space_->joints())},
      candidates_(kLargestBatch) {
  specs_.recognizedGoal = ob::GOAL_SAMPLEABLE_REGION;
  specs_.directed = true;
  const std::size_t n = flat().size();
  samples_.resize(kLargestBatch * n);
  ends_.resize(kLargestBatch * n);
  unchecked_ends_.resize(kLargestBatch * n);
  reached_.resize(n);
  step_.resize(n);
  sample_state_ = si->allocState();
}

RrtConnect::~RrtConnect() { si_->freeState(sample_state_); }

void RrtConnect::setup() {
  Planner::setup();
  motions_ = dynamic_cast<EdgeMotionValidator*>(si_->getMotionValidator().get());
  if (motions_ == nullptr) throw ompl::Exception(getName(), "needs an EdgeMotionValidator");
}

void RrtConnect::clear() {
  Planner::clear();
  for (Tree& tree : trees_) {
    tree.nodes.Clear();
    tree.domains.clear();
  }
  counters_ = {};
  num_drawn_ = 0;
  sampler_.reset();
}

int RrtConnect::Add(int tree, const double* q, int parent) {
  trees_[tree].domains.push_back(std::numeric_limits<double>::infinity());
  return trees_[tree].nodes.Add({q, flat().size()}, parent);
}

bool RrtConnect::IsValidEdge(const double* from, const double* to) {
  const std::size_t n = flat().size();
  return motions_->edges()->IsValidEdge({from, n}, {to, n}, /*from_is_free=*/true);
}

bool RrtConnect::InDomain(const Candidate& candidate) const {
  return candidate.near.distance <=
         trees_[candidate.tree].domains[static_cast<std::size_t>(candidate.near.node)];
}

ob::PlannerStatus RrtConnect::AddEnds() {
  if (dynamic_cast<ob::GoalSampleableRegion*>(pdef_->getGoal().get()) == nullptr) {
    return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  }
  while (const ob::State* state = pis_.nextStart()) {
    Add(kStart, OmplPositions(state), NodeTree::kNoParent);
  }
  if (NumStates(kStart) == 0) return ob::PlannerStatus::INVALID_START;
  if (NumStates(kGoal) == 0) {
    const ob::State* state = pis_.nextGoal();
    if (state == nullptr) return ob::PlannerStatus::INVALID_GOAL;
    Add(kGoal, OmplPositions(state), NodeTree::kNoParent);
  }
  return ob::PlannerStatus::UNKNOWN;
}

void RrtConnect::AddGoals() {
  // As OMPL does: the goals drawn keep up with half the size of the tree.
  const auto* goal = static_cast<const ob::GoalSampleableRegion*>(pdef_->getGoal().get());
  if (pis_.getSampledGoalsCount() >= goal->maxSampleCount()) return;
  if (static_cast<int>(pis_.getSampledGoalsCount()) >= NumStates(kGoal) / 2) return;
  if (const ob::State* state = pis_.nextGoal()) {
    Add(kGoal, OmplPositions(state), NodeTree::kNoParent);
  }
}

int RrtConnect::NextTree(int last) const {
  const int other = 1 - last;
  return settings_.balance && NumStates(other) > NumStates(last) ? last : other;
}

void RrtConnect::Prepare(int num, int last) {
  const std::size_t n = flat().size();
  for (; num_drawn_ < num; ++num_drawn_) {
    sampler_->sampleUniform(sample_state_);
    std::copy_n(OmplPositions(sample_state_), n, samples_.data() + At(num_drawn_));
  }
  {
    const Stopwatch stopwatch(&counters_.nearest_s);
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
    flat().Interpolate(trees_[candidate.tree].nodes.Positions(candidate.near.node), sample,
                       std::min(1.0, settings_.range / candidate.near.distance),
                       ends_.data() + At(k));
    std::copy_n(ends_.data() + At(k), n,
                unchecked_ends_.data() + At(static_cast<int>(unchecked_.size())));
    unchecked_.push_back(k);
  }
  const auto count = static_cast<int>(unchecked_.size());
  verdicts_.resize(unchecked_.size());
  motions_->edges()->CheckStates({unchecked_ends_.data(), At(count)}, count, verdicts_);
  for (std::size_t i = 0; i < unchecked_.size(); ++i) {
    candidates_[static_cast<std::size_t>(unchecked_[i])].end_is_valid = verdicts_[i] != 0;
  }
}

int RrtConnect::Extend(int k, double* reached) {
  const std::size_t n = flat().size();
  const Candidate& candidate = candidates_[static_cast<std::size_t>(k)];
  NodeTree& nodes = trees_[candidate.tree].nodes;
  double& domain = trees_[candidate.tree].domains[static_cast<std::size_t>(candidate.near.node)];
  std::copy_n(ends_.data() + At(k), n, reached);
  if (!candidate.end_is_valid || !IsValidEdge(nodes.Positions(candidate.near.node), reached)) {
    if (settings_.domain_radius > 0) {
      domain = std::isinf(domain) ? settings_.domain_radius
                                  : std::max(settings_.range, domain * (1 - kDomainChange));
    }
    return -1;
  }
  domain *= 1 + kDomainChange;
  int node = Add(candidate.tree, reached, candidate.near.node);
  if (settings_.extension == Extension::kStep) return node;
  const double* sample = samples_.data() + At(k);
  for (int i = 1; i * settings_.range < candidate.near.distance; ++i) {
    const double t = std::min(1.0, (i + 1) * settings_.range / candidate.near.distance);
    flat().Interpolate(nodes.Positions(candidate.near.node), sample, t, step_.data());
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
    const Stopwatch stopwatch(&counters_.nearest_s);
    near = nodes.Nearest(q);
  }
  const int num_steps = std::max(1, static_cast<int>(std::ceil(near.distance / settings_.range)));
  int node = near.node;
  for (int i = 1; i <= num_steps; ++i) {
    flat().Interpolate(nodes.Positions(near.node), q, static_cast<double>(i) / num_steps,
                       step_.data());
    if (!IsValidEdge(nodes.Positions(node), step_.data())) return -1;
    if (i < num_steps) node = Add(tree, step_.data(), node);
  }
  return node;
}

void RrtConnect::AddSolution(int start_node, int goal_node) {
  const auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
  const auto append = [&](int tree, int node) {
    ob::State* state = si_->allocState();
    std::copy_n(trees_[tree].nodes.Positions(node), flat().size(), OmplPositions(state));
    path->getStates().push_back(state);
  };
  for (int node = start_node; node != NodeTree::kNoParent;
       node = trees_[kStart].nodes.Parent(node)) {
    append(kStart, node);
  }
  std::reverse(path->getStates().begin(), path->getStates().end());
  for (int node = goal_node; node != NodeTree::kNoParent; node = trees_[kGoal].nodes.Parent(node)) {
    append(kGoal, node);
  }
  pdef_->addSolutionPath(path, /*approximate=*/false, /*difference=*/0, getName());
}

ob::PlannerStatus RrtConnect::solve(const ob::PlannerTerminationCondition& ptc) {
  checkValidity();
  if (!sampler_) sampler_ = si_->allocStateSampler();
  const ob::PlannerStatus ends = AddEnds();
  if (ends != ob::PlannerStatus::UNKNOWN) return ends;

  int tree = kGoal;  // the last that was extended
  int batch = kSmallestBatch;
  while (!ptc) {
    AddGoals();
    Prepare(batch, tree);
    int taken = 0;
    bool grown = false;
    while (taken < batch && !grown) {
      const int k = taken++;
      ++counters_.iterations;
      const Candidate& candidate = candidates_[static_cast<std::size_t>(k)];
      tree = candidate.tree;
      // Once more: a failure of this batch may have narrowed the domain.
      if (!candidate.in_domain || !InDomain(candidate)) {
        ++counters_.out_of_domain;
        continue;
      }
      const int node = Extend(k, reached_.data());
      if (node < 0) continue;
      grown = true;
      const int other_node = Connect(1 - tree, reached_.data());
      if (other_node < 0) continue;
      AddSolution(tree == kStart ? node : other_node, tree == kStart ? other_node : node);
      return ob::PlannerStatus::EXACT_SOLUTION;
    }
    num_drawn_ -= taken;
    std::copy_n(samples_.data() + At(taken), At(num_drawn_), samples_.data());
    batch = grown ? kSmallestBatch : std::min(2 * batch, kLargestBatch);
  }
  return ob::PlannerStatus::TIMEOUT;
}

}  // namespace planbench
