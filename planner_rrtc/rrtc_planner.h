#pragma once

#include <map>
#include <memory>

#include "common/yaml.h"
#include "planning/planner.h"

namespace planbench {

struct RrtcSettings;

/// RRT-Connect, or any of OMPL's geometric planners, over one state space, one validator and
/// samplers that depend on the request's seed alone.
///
/// Counters: iterations (configurations drawn from the whole space); of RRT-Connect also
/// states_start_tree, states_goal_tree and, with a dynamic domain, out_of_domain. Guidance is
/// RRT-Connect's time for nearest neighbours.
class RrtcPlanner : public Planner {
 public:
  /// Settings: see RrtcSettings. Throws InputError for unknown keys, algorithms and parameters of
  /// OMPL's planners, and for bad values. The robot must outlive the planner.
  RrtcPlanner(const Robot& robot, const YamlNode& settings);
  ~RrtcPlanner() override;

  PlannerDescription Describe() const override;

 protected:
  SearchResult Search(SearchQuery& query) override;

 private:
  class Workspace;

  std::unique_ptr<RrtcSettings> settings_;
  /// What is kept from one request to the next, for each joint space.
  std::map<const JointSpace*, std::unique_ptr<Workspace>> workspaces_;
};

/// RrtcPlanner, for programs.
std::unique_ptr<Planner> MakeRrtcPlanner(const Robot& robot, const YamlNode& settings);

}  // namespace planbench
