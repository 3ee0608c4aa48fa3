#pragma once

#include <ompl/base/Planner.h>

#include <cstdint>
#include <span>
#include <vector>

#include "common/enum_names.h"
#include "planner_rrtc/edge_validity.h"
#include "planner_rrtc/node_tree.h"
#include "planner_rrtc/ompl_joint_space.h"

namespace planbench {

/// How a tree grows towards a sample.
enum class Extension {
  kStep,     ///< By one motion of at most the range: "EXTEND".
  kConnect,  ///< By one after the other until the sample or an obstacle is reached: "CONNECT".
};
template <>
struct EnumNames<Extension> {
  static constexpr auto kNames = std::to_array<std::string_view>({"step", "connect"});
};

/// RRT-Connect (Kuffner and LaValle, "RRT-Connect: An Efficient Approach to Single-Query Path
/// Planning", ICRA 2000) as a planner of OMPL, for spaces that are OmplJointSpaces and motions that
/// an EdgeMotionValidator judges. What ompl::geometric::RRTConnect does state by state and node by
/// node, it does over flat arrays that it keeps from one problem to the next:
///
/// Where a search is stuck almost every extension fails, and almost every failure is a collision at
/// the extension's far end. So the extensions towards the next samples are prepared together and
/// their far ends are checked in one batch; they are then taken in order, and when one changes a
/// tree the ones after it are prepared anew. The result is that of one sample at a time.
class RrtConnect final : public ompl::base::Planner {
 public:
  struct Settings {
    /// Longest motion added to a tree, joint-space L2.
    double range = 1;
    /// Of the tree that draws the sample; the other one always connects.
    Extension extension = Extension::kConnect;
    /// Grow the smaller tree (as Kuffner and LaValle's "balanced" variant); else they take turns.
    bool balance = true;
    /// Dynamic domain (Yershova, Jaillet, Simeon and LaValle, ICRA 2005): a node that failed to
    /// extend takes samples within this distance only, which shrinks with further failures and
    /// grows with successes (Jaillet, Yershova, LaValle and Simeon, IROS 2005), but not below the
    /// range. 0: off.
    double domain_radius = 0;
  };

  struct Counters {
    std::int64_t iterations = 0;     ///< Samples taken.
    std::int64_t out_of_domain = 0;  ///< Of them, refused by the dynamic domain.
    double nearest_s = 0;            ///< Time for nearest neighbours.
  };

  RrtConnect(const ompl::base::SpaceInformationPtr& si, const Settings& settings);
  ~RrtConnect() override;

  void set_settings(const Settings& settings) { settings_ = settings; }
  const Counters& counters() const { return counters_; }
  int NumStates(int tree) const { return trees_[tree].nodes.size(); }

  void setup() override;
  void clear() override;
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;

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
    bool end_is_valid = false;
  };

  const FlatJoints& flat() const { return space_->flat_joints(); }
  std::size_t At(int k) const { return static_cast<std::size_t>(k) * flat().size(); }

  int Add(int tree, const double* q, int parent);
  bool IsValidEdge(const double* from, const double* to);
  bool InDomain(const Candidate& candidate) const;
  /// Adds the problem's starts and first goal; what is wrong with them, if anything.
  ompl::base::PlannerStatus AddEnds();
  void AddGoals();
  /// The tree whose turn comes after `last`'s.
  int NextTree(int last) const;
  /// Prepares extensions towards the next `num` samples. `last`: the tree extended before them.
  void Prepare(int num, int last);
  /// Takes the k-th extension prepared. The last node added, -1 if none; `reached` (n values)
  /// becomes its configuration.
  int Extend(int k, double* reached);
  /// Grows `tree` towards q. The node from which q is reached, -1 if it is not.
  int Connect(int tree, const double* q);
  void AddSolution(int start_node, int goal_node);

  Settings settings_;
  Counters counters_;
  const OmplJointSpace* space_;
  EdgeMotionValidator* motions_ = nullptr;
  ompl::base::StateSamplerPtr sampler_;
  ompl::base::State* sample_state_;
  Tree trees_[2];
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
