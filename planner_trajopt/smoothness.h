#pragma once

#include <Eigen/Core>

namespace planbench {

/// The metric of smoothness over the N inner waypoints of a trajectory, one joint at a time: A = K'
/// K (N x N), K being the differences of neighbouring waypoints. Ends are fixed, so that they add
/// nothing to A. Returns the inverse of A.
Eigen::MatrixXd InverseSmoothness(int num_inner);

}  // namespace planbench
