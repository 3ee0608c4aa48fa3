#include "planner_rrtc/edge_validity.h"

#include "planner_rrtc/ompl_joint_space.h"

namespace planbench {

namespace ob = ompl::base;

bool EdgeStateValidity::isValid(const ob::State* state) const {
  return edges_->IsValidState({OmplPositions(state), si_->getStateDimension()});
}

bool EdgeMotionValidator::checkMotion(const ob::State* s1, const ob::State* s2) const {
  const std::size_t n = si_->getStateDimension();
  const bool valid = edges_->IsValidEdge({OmplPositions(s1), n}, {OmplPositions(s2), n},
                                         /*from_is_free=*/true);
  ++(valid ? valid_ : invalid_);
  return valid;
}

bool EdgeMotionValidator::checkMotion(const ob::State* s1, const ob::State* s2,
                                      std::pair<ob::State*, double>& last_valid) const {
  if (checkMotion(s1, s2)) return true;
  if (last_valid.first != nullptr && last_valid.first != s1) si_->copyState(last_valid.first, s1);
  last_valid.second = 0;
  return false;
}

}  // namespace planbench
