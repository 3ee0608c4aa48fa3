#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "collision/collision_checker.h"
#include "problem_generator/problem_spec.h"
#include "problem_generator/rejections.h"
#include "robot_model/inverse_kinematics.h"
#include "scene/problem.h"

namespace planbench {

/// Makes the problems of a specification. The k-th problem is a function of the specification, the
/// robot, the seed, k and the attempt, and of nothing else: problems can be made in any order, and
/// one that turns out to be unsolvable is replaced by making it again with the next attempt.
///
/// Not thread-safe: one instance a thread. The specification and the robot must outlive it.
class ProblemGenerator {
 public:
  /// Throws InputError if the robot has no spheres.
  ProblemGenerator(const ProblemSpec& spec, const Robot& robot, std::uint64_t seed);

  struct Result {
    std::optional<Problem> problem;  ///< Nothing if the effort allowed was spent in vain.
    std::string query;               ///< Name of the query it was made for.
    Rejections rejections;           ///< What was drawn and thrown away.
  };
  /// `k` counts from 1, `attempt` from 0.
  Result Generate(int k, int attempt);

 private:
  const ProblemSpec* spec_;
  const Robot* robot_;
  const PlanningGroup* group_;
  std::uint64_t seed_;
  std::vector<double> rest_;  // Full positions.
  std::unique_ptr<CollisionChecker> checker_;
  std::map<int, InverseKinematics> kinematics_;  // By tip link.
};

}  // namespace planbench
