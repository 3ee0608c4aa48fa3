#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace planbench {

/// The pose with that position and orientation; the quaternion (any non-zero length, either sign)
/// is normalised first.
Eigen::Isometry3d PoseFromPositionOrientation(const Eigen::Vector3d& position,
                                              const Eigen::Quaterniond& orientation);

/// The unit quaternion that stands for a pose's orientation wherever it is written down: in files,
/// messages and content hashes. Its first component (in the order w, x, y, z) above 1e-9 in size is
/// positive.
///
/// It survives being written down and read back any number of times: with
/// X' = PoseFromPositionOrientation(p, OrientationOf(X)), OrientationOf(X') has the same bits as
/// OrientationOf(X). A plain conversion does not give that: matrix to quaternion to matrix moves
/// the last bits of most matrices. Here that round trip is repeated until it stands still (or moves
/// in a circle, of which the smallest member is taken), and both X and X' lead to the same place.
Eigen::Quaterniond OrientationOf(const Eigen::Isometry3d& pose);

}  // namespace planbench
