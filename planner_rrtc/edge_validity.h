#pragma once

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>

#include "collision/edge_checker.h"

namespace planbench {

/// OMPL's two questions, answered by the EdgeChecker of the request being served.

class EdgeStateValidity final : public ompl::base::StateValidityChecker {
 public:
  explicit EdgeStateValidity(const ompl::base::SpaceInformationPtr& si)
      : ompl::base::StateValidityChecker(si) {}

  void set_edges(EdgeChecker* edges) { edges_ = edges; }

  bool isValid(const ompl::base::State* state) const override;

 private:
  EdgeChecker* edges_ = nullptr;
};

class EdgeMotionValidator final : public ompl::base::MotionValidator {
 public:
  explicit EdgeMotionValidator(const ompl::base::SpaceInformationPtr& si)
      : ompl::base::MotionValidator(si) {}

  void set_edges(EdgeChecker* edges) { edges_ = edges; }
  /// For planners that hand over whole edges and batches of states.
  EdgeChecker* edges() const { return edges_; }

  /// OMPL's contract: s1 is known to be valid.
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2) const override;
  /// The valid stretch of an invalid motion is not measured: s1 counts as the last valid state.
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

 private:
  EdgeChecker* edges_ = nullptr;
};

}  // namespace planbench
