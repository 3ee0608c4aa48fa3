#pragma once

#include <map>
#include <memory>
#include <string>

#include "planner_rrtc/rrtc_settings.h"
#include "planning/planner.h"

namespace planbench {

/// Any of OMPL's geometric planners, over one state space, one validator and samplers that depend
/// on the request's seed alone. Counts iterations (configurations drawn, goals not among them).
class OmplPlanner final : public Planner {
 public:
  /// `settings` name an OMPL algorithm. Throws InputError, beginning with `origin`, for parameters
  /// that it does not have, and bad values of them. The robot must outlive the planner.
  OmplPlanner(const Robot& robot, RrtcSettings settings, const std::string& origin);
  ~OmplPlanner() override;

  PlannerDescription Describe() const override;

 protected:
  SearchResult Search(SearchQuery& query) override;
  /// By the settings' longest_valid_segment_fraction, if there is one. Throws InputError for edges
  /// that are to be certified then: they would not be.
  std::optional<EdgeSampling> OwnEdgeSampling(const PlanningGroup& group, EdgeCheck method,
                                              double resolution_m) const override;

 private:
  class Workspace;

  RrtcSettings settings_;
  bool has_range_;  ///< Whether the setting `range` is one of this algorithm's.
  /// What is kept from one request to the next, for each joint space.
  std::map<const JointSpace*, std::unique_ptr<Workspace>> workspaces_;
};

}  // namespace planbench
