#pragma once

#include <ompl/base/Planner.h>

#include <span>
#include <string>
#include <string_view>

#include "planning/planner_description.h"

namespace planbench {

/// A geometric planner of the installed OMPL.
struct OmplAlgorithm {
  std::string_view name;  ///< Its class in ompl::geometric.
  PlannerClass planner_class;
  /// Improves its path until it is stopped, and tells of each better one.
  bool anytime;
  /// Grows from start and goal at once, or a roadmap from neither.
  bool bidirectional;
  ompl::base::PlannerPtr (*make)(const ompl::base::SpaceInformationPtr& si);
  /// What is not as in OMPL, for its name; empty: nothing.
  std::string_view variant = {};
  /// Draws configurations near those it has, none from the whole space.
  bool draws_near = false;
};

/// Those offered, by name: single-threaded ones that need nothing but a space, a validator and a
/// goal, and that depend on nothing but their generators' seeds.
std::span<const OmplAlgorithm> OmplAlgorithms();
/// Null if there is none of that name.
const OmplAlgorithm* FindOmplAlgorithm(std::string_view name);

}  // namespace planbench
