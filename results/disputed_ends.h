#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "results/outcomes.h"

namespace planbench {

/// A contestant on one set.
struct JudgedOutcomes {
  std::string contestant;
  std::size_t session = 0;      ///< Its robot is that of the others of the session.
  std::string collision_model;  ///< "" if that is not known.
  const Outcomes* outcomes = nullptr;
  bool has_first_path = false;  ///< It is given that of another.
};

/// Whose planners called start or goal invalid where a path is confirmed in the same session by the
/// same collision model: a line on each, by contestant. `sets`: by name. With voxels the planner
/// may be right, as the referee has none; of who is given a first path the word may be the other's,
/// by its model; and that a search is exhausted is no such claim, but one of the planner's own
/// search space.
std::map<std::string, std::string> DescribeDisputedEnds(
    const std::map<std::string, std::vector<JudgedOutcomes>>& sets);

}  // namespace planbench
