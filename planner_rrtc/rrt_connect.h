#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "planner_rrtc/flat_joints.h"
#include "planner_rrtc/joint_sampler.h"
#include "planner_rrtc/node_tree.h"
#include "planner_rrtc/rrtc_settings.h"
#include "planning/goal_sampler.h"
#include "planning/path_library.h"
#include "planning/plan_result.h"
#include "planning/search_query.h"
#include "planning/search_result.h"

namespace planbench {

/// RRT-Connect (Kuffner and LaValle, "RRT-Connect: An Efficient Approach to Single-Query Path
/// Planning", ICRA 2000) over flat arrays that are kept from one query to the next.
///
/// Where a search is stuck almost every extension fails, and almost every failure is a collision at
/// the extension's far end. So the extensions towards the next samples are prepared together and
/// their far ends are checked in one batch; they are then taken in order, and when one changes a
/// tree the ones after it are prepared anew. The result is that of one sample at a time, where
/// goals are drawn and the range shrinks between batches.
class RrtConnect {
 public:
  /// `joints` must outlive it.
  explicit RrtConnect(const JointSpace& joints);

  /// Counters: iterations (samples taken), states_start_tree, states_goal_tree and, with a dynamic
  /// domain, out_of_domain (samples that it refused). Guidance is the time for nearest neighbours.
  ///
  /// With `experience` (of these joints; null: none) both trees first follow the recalled paths
  /// nearest to start and goal as far as they are free, which is Lightning's retrieval and repair
  /// (Berenson, Abbeel and Goldberg, "A robot path planning framework that learns from experience",
  /// ICRA 2012) in one search. Counters then: states_recalled.
  SearchResult Search(const RrtcSettings& settings, const PathLibrary* experience,
                      const SearchQuery& query);

 private:
  static constexpr int kStart = 0;
  static constexpr int kGoal = 1;

  struct Tree {
    explicit Tree(const JointSpace& joints) : nodes(joints) {}
    NodeTree nodes;
    std::vector<double> domains;  ///< Of each node, for the dynamic domain.
  };

  /// An extension towards a sample, not taken yet.
  struct Candidate {
    int tree = 0;
    NodeTree::Neighbor near;
    bool in_domain = true;
    bool end_passes = false;  ///< If not, it is invalid.
  };

  /// Nodes that a free motion joins, one of each tree: a way leads through them from start to goal.
  struct Meeting {
    int start_node = -1;
    int goal_node = -1;
  };

  std::size_t At(int k) const { return static_cast<std::size_t>(k) * flat_.size(); }
  int NumStates(int tree) const { return trees_[tree].nodes.size(); }

  void Clear();
  int Add(int tree, const double* q, int parent);
  bool IsValidEdge(const double* from, const double* to);
  bool InDomain(const Candidate& candidate) const;
  void AddGoal(GoalSampler* goals);
  /// The tree whose turn comes after `last`'s.
  int NextTree(int last) const;
  /// Grows the trees until they meet or the query says stop.
  std::optional<Meeting> Grow(const SearchQuery& query, JointSampler* sampler, GoalSampler* goals);
  /// Prepares extensions towards the next `num` samples. `last`: the tree extended before them.
  void Prepare(JointSampler* sampler, int num, int last);
  /// Takes the k-th extension prepared. The last node added, -1 if none; `reached` (n values)
  /// becomes its configuration.
  int Extend(int k, double* reached);
  /// Grows `tree` towards q. The node from which q is reached, -1 if it is not.
  int Connect(int tree, const double* q);
  /// Grows both trees along `way` from its two ends.
  std::optional<Meeting> Follow(const Path& way);
  std::optional<Meeting> Recall(const PathLibrary& experience, const SearchQuery& query);
  Path PathThrough(const Meeting& meeting) const;

  const JointSpace& joints_;
  FlatJoints flat_;
  Tree trees_[2];
  // Of the query being served:
  const RrtcSettings* settings_ = nullptr;
  EdgeChecker* edges_ = nullptr;
  double range_ = 0;  ///< Of the extensions prepared.
  std::int64_t num_iterations_ = 0;
  std::int64_t num_out_of_domain_ = 0;
  int num_goals_drawn_ = 0;
  std::uint64_t nearest_ticks_ = 0;
  /// Samples drawn and not taken yet, the first of which have candidates and ends.
  int num_drawn_ = 0;
  std::vector<double> samples_;
  std::vector<Candidate> candidates_;
  std::vector<double> ends_;  ///< Of the first motion of each extension.
  // Scratch:
  std::vector<int> unchecked_;
  std::vector<double> unchecked_ends_;
  std::vector<unsigned char> verdicts_;
  std::vector<double> reached_;
  std::vector<double> step_;
};

}  // namespace planbench
