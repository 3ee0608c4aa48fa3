#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "problem_generator/problem_spec.h"
#include "problem_generator/random_stream.h"
#include "problem_generator/rejections.h"
#include "scene/scene.h"

namespace planbench {

/// A scene drawn from a specification.
struct SampledScene {
  /// Objects have the identity as pose and their shapes' poses in the robot's base frame, which
  /// readers that do not know an object's pose understand too.
  Scene scene;
  /// X_BO of every object of the specification, nothing for those that are not in the scene.
  std::vector<std::optional<Eigen::Isometry3d>> poses;
};

/// Draws sizes, presence and poses. Nothing, counted in `rejections`, if objects touch or come
/// nearer to each other than the gap of the specification, or do not stand wholly on what they
/// stand on.
std::optional<SampledScene> SampleScene(const ProblemSpec& spec, const Robot& robot,
                                        RandomStream* random, Rejections* rejections);

/// Rotation by fixed-axis roll, pitch, yaw (rad), as in URDF.
Eigen::Matrix3d RotationFromRpy(const Eigen::Vector3d& rpy);

}  // namespace planbench
