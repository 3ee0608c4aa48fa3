#pragma once

#include <memory>

#include "common/yaml.h"
#include "planning/planner.h"

namespace planbench {

/// RRT-Connect (Kuffner and LaValle, "RRT-Connect: An Efficient Approach to Single-Query Path
/// Planning", ICRA 2000) as OMPL implements it (ompl::geometric::RRTConnect). Grows a tree from the
/// start and one from the goal by straight motions of at most `range` towards random
/// configurations, and tries to connect them.
///
/// Counters: iterations (random configurations drawn), states_start_tree, states_goal_tree.
/// Guidance is the time for nearest neighbours.
class RrtConnectPlanner : public Planner {
 public:
  /// Settings: range: longest motion added to a tree, joint-space L2 (rad and m unweighted), > 0,
  /// default kDefaultRange. Throws InputError for unknown keys and bad values. The robot must
  /// outlive the planner.
  RrtConnectPlanner(const Robot& robot, const YamlNode& settings);

  static constexpr double kDefaultRange = 1.0;

  PlannerDescription Describe() const override;

 protected:
  SearchResult Search(SearchQuery& query) override;

 private:
  double range_;
};

/// RrtConnectPlanner, for programs.
std::unique_ptr<Planner> MakeRrtcPlanner(const Robot& robot, const YamlNode& settings);

}  // namespace planbench
