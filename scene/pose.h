#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

namespace planbench {

/// The pose with that position and orientation; the quaternion (any non-zero length, either sign)
/// is normalised first.
Eigen::Isometry3d PoseFromPositionOrientation(const Eigen::Vector3d& position,
                                              const Eigen::Quaterniond& orientation);

/// A rotation in whole numbers: quaternion components w, x, y, z divided by the largest of them
/// (the first of those that are equal within 1e-6), in steps of 2^-40.
///
/// This form, and not the matrix or a plain quaternion, identifies an orientation in content
/// hashes. Going from matrix to quaternion to matrix moves the last bits of most rotations, and of
/// some of them a little further each time; that noise (1e-16) is far below a step, so whatever has
/// been put on this grid once comes back as the same whole numbers.
std::array<std::int64_t, 4> OrientationSteps(const Eigen::Isometry3d& pose);

/// The unit quaternion of OrientationSteps: what stands for an orientation in files and messages.
/// Differs from the pose's own by 1e-12 at most; identity, right angles and half turns are exact.
Eigen::Quaterniond OrientationOf(const Eigen::Isometry3d& pose);

/// The pose with OrientationOf's orientation. PoseFromPositionOrientation(p, OrientationOf(X)) of a
/// pose X that has been through this function has the same bits as X.
Eigen::Isometry3d CanonicalPose(const Eigen::Isometry3d& pose);

}  // namespace planbench
