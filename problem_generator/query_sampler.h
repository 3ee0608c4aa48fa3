#pragma once

#include <map>
#include <optional>
#include <vector>

#include "collision/collision_checker.h"
#include "problem_generator/problem_spec.h"
#include "problem_generator/random_stream.h"
#include "problem_generator/rejections.h"
#include "problem_generator/scene_sampler.h"
#include "robot_model/inverse_kinematics.h"

namespace planbench {

/// Finds starts and goals in a scene. Not thread-safe; keeps references to its arguments.
class QuerySampler {
 public:
  /// `kinematics`: by the tip links that grippers of the specification name. `checker`: has the
  /// scene in which ends are to be found.
  QuerySampler(const ProblemSpec& spec, std::map<int, InverseKinematics>* kinematics,
               CollisionChecker* checker);

  /// A configuration (group order) for the end, free with the specification's clearance; nothing
  /// if the effort allowed has found none. Joints that a gripper's pose leaves several turns have
  /// the one nearest to `other`, the query's other end, if that is known
  /// (JointSpace::ToNearestTurn). What it threw away is counted.
  std::optional<std::vector<double>> Sample(const EndSpec& end, const SampledScene& scene,
                                            const std::optional<std::vector<double>>& other,
                                            RandomStream* random, Rejections* rejections);

 private:
  bool Clear(const EndSpec& end, const std::vector<double>& q, Rejections* rejections);

  const ProblemSpec* spec_;
  std::map<int, InverseKinematics>* kinematics_;
  CollisionChecker* checker_;
};

/// A pose X_BT of the tip link as `gripper` allows it, X_BO being the object's.
Eigen::Isometry3d DrawTipPose(const GripperSpec& gripper, const Eigen::Isometry3d& X_BO,
                              RandomStream* random);

}  // namespace planbench
