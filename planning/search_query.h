#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/edge_checker.h"
#include "common/stopwatch.h"
#include "planning/goal_box.h"
#include "planning/plan_control.h"
#include "planning/plan_result.h"
#include "robot_model/joint_space.h"
#include "scene/scene.h"

namespace planbench {

/// One search, from `start` to `goal` whatever the request's direction was (Planner has swapped
/// them). Start and nominal goal have been found valid.
class SearchQuery {
 public:
  const JointSpace& space() const { return edges_->space(); }
  const Configuration& start() const { return start_; }
  const GoalBox& goal() const { return goal_; }
  /// The scene and the full positions that joints outside the group are held at.
  const Scene& scene() const { return *scene_; }
  const std::vector<double>& base_positions() const { return *base_positions_; }
  /// Validity of states and edges; the only way to ask.
  EdgeChecker& edges() const { return *edges_; }
  std::uint64_t seed() const { return seed_; }
  bool anytime() const { return anytime_; }
  /// A path from `start` into `goal` to be improved, not checked yet; empty: none.
  const Path& initial_path() const { return initial_path_; }
  /// Settings of this request, to be applied over the planner's own (see YamlNode::Override).
  const std::map<std::string, std::string>& parameters() const { return *parameters_; }

  /// True once the time limit has passed or the request was cancelled. Cheap (one clock reading).
  bool ShouldStop() const;
  bool Cancelled() const;
  double RemainingSeconds() const;
  /// Of several goals: the cost of the best path to one that was searched for before, infinity
  /// without one. Only cheaper paths are of use then.
  double known_cost() const { return known_cost_; }
  /// Of several goals, asked between two steps of a search (an edge, say) that can go on later:
  /// true once it is another goal's turn. It is the work that counts, no clock. The search is then
  /// to be kept. A planner that never asks has one turn for each goal, by the clock (ShouldStop).
  bool TurnIsOver();
  /// Keeps the search for this goal, which takes so many bytes, until its next turn.
  void Keep(std::shared_ptr<void> search, std::size_t bytes);
  /// What was kept in this goal's last turn; null in its first one, or if it has been dropped.
  std::shared_ptr<void> TakeKept();
  /// What is kept of the other goals' searches, bytes.
  std::size_t KeptBytes() const { return kept_bytes_; }
  /// Makes room: of the other goals' searches the one whose turn is the furthest off begins anew in
  /// it. Not to be called without one.
  void DropLastKept();
  /// Reports a solution of an anytime search the moment it is ready, and each better proof: the
  /// first stops the planning clock, if the request is anytime. If it is not, this is HoldPath. A
  /// better solution of which less is proven than was told before is not told.
  /// `lower_bound`: as in SearchResult. What is told of it holds for all goals.
  void ReportSolution(double lower_bound, double cost, std::int64_t expansions);
  /// Says that there is a path to return, should the limit come before the search has reached the
  /// bound it wants.
  void HoldPath();

 private:
  friend class Planner;

  struct KeptSearch {
    std::size_t goal;
    std::shared_ptr<void> search;
    std::size_t bytes;
  };
  bool IsKept(std::size_t goal) const;
  std::shared_ptr<void> TakeKeptOf(std::size_t goal);
  /// ShouldStop, of the request whatever the turn.
  bool IsOver() const;
  /// Whether searches of this planner go on in later turns, as far as is known.
  bool GoesOn() const { return num_steps_ > 0; }
  /// Done so far, of all goals: configurations checked, and steps between them.
  double Work() const;

  Configuration start_;
  GoalBox goal_;
  const Scene* scene_ = nullptr;
  const std::vector<double>* base_positions_ = nullptr;
  EdgeChecker* edges_ = nullptr;
  std::uint64_t seed_ = 0;
  bool anytime_ = false;
  Path initial_path_;
  const std::map<std::string, std::string>* parameters_ = nullptr;
  PlanControl* control_ = nullptr;
  Stopwatch clock_;
  double time_limit_s_ = 0;
  /// Of several goals, when it is the next one's turn, unless this one's has led to a path.
  std::optional<double> turn_ends_s_;
  double turn_ends_work_ = std::numeric_limits<double>::infinity();
  std::int64_t num_steps_ = 0;    ///< That TurnIsOver was asked between.
  std::size_t turn_ = 0;          ///< The goal whose turn it is.
  std::vector<KeptSearch> kept_;  ///< In the order of their next turns.
  std::size_t kept_bytes_ = 0;    ///< Their sum.
  double known_cost_ = std::numeric_limits<double>::infinity();
  /// What was known of the costs of paths to this goal and to the others when its turn began.
  double lower_bound_ = 0;
  double lower_bound_of_others_ = std::numeric_limits<double>::infinity();
  std::int64_t expansions_before_ = 0;  ///< By searches for other goals.
  std::vector<PlanProgress> progress_;
  std::optional<double> path_held_s_;  ///< When there was a path first, if it was said.
};

}  // namespace planbench
