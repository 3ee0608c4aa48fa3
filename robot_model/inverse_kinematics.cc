#include "robot_model/inverse_kinematics.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/random.h"

namespace planbench {
namespace {

// Least damping: enough to keep steps finite where the arm is singular, too little to slow the last
// steps down.
constexpr double kLeastDamping = 1e-9;
// Longest motion of a joint in one step, rad or m: the linear model is worthless beyond.
constexpr double kLongestStep = 1.0;
// A descent has stalled when this many steps together do not reduce the error by this factor.
constexpr int kPatience = 8;
constexpr double kExpectedReduction = 0.7;

// 1 for the parts of a pose error that count, 0 for those that are left free.
Eigen::Vector<double, 6> Wanted(const IkOptions& options) {
  Eigen::Vector<double, 6> wanted = Eigen::Vector<double, 6>::Ones();
  if (std::isinf(options.position_tolerance_m)) wanted.head<3>().setZero();
  if (std::isinf(options.orientation_tolerance_rad)) wanted.tail<3>().setZero();
  return wanted;
}

Eigen::Vector<double, 6> Difference(const Eigen::Isometry3d& wanted,
                                    const Eigen::Isometry3d& actual) {
  const Eigen::AngleAxisd rotation(Eigen::Matrix3d(wanted.linear() * actual.linear().transpose()));
  Eigen::Vector<double, 6> error;
  error << wanted.translation() - actual.translation(), rotation.angle() * rotation.axis();
  return error;
}

bool Reached(const Eigen::Vector<double, 6>& error, const IkOptions& options) {
  return error.head<3>().norm() <= options.position_tolerance_m &&
         error.tail<3>().norm() <= options.orientation_tolerance_rad;
}

}  // namespace

std::string DescribeMiss(double off_m, double off_rad, const IkOptions& options) {
  return fmt::format("nearest: {:.4g} m and {:.4g} rad off; {:g} m and {:g} rad are allowed", off_m,
                     off_rad, options.position_tolerance_m, options.orientation_tolerance_rad);
}

InverseKinematics::InverseKinematics(const RobotModel& model, const PlanningGroup& group,
                                     std::span<const double> base_positions,
                                     const Eigen::Isometry3d& X_LT)
    : space_(group.space) {
  std::vector<int> path;  // Joints from the tip to the root.
  for (int link = group.tip_link;
       model.links()[static_cast<std::size_t>(link)].parent_joint >= 0;) {
    path.push_back(model.links()[static_cast<std::size_t>(link)].parent_joint);
    link = model.joints()[static_cast<std::size_t>(path.back())].parent_link;
  }
  Eigen::Isometry3d X_LJ = Eigen::Isometry3d::Identity();  // Since the last chain joint.
  for (auto it = path.rbegin(); it != path.rend(); ++it) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(*it)];
    X_LJ = X_LJ * joint.X_PJ;
    const auto in_group = std::find(group.joints.begin(), group.joints.end(), *it);
    const auto follower =
        std::find_if(group.followers.begin(), group.followers.end(),
                     [&](const PlanningGroup::Follower& f) { return f.joint == *it; });
    if (in_group == group.joints.end() && follower == group.followers.end()) {
      X_LJ = X_LJ * JointMotion(joint, base_positions);
      continue;
    }
    const bool follows = follower != group.followers.end();
    const int group_index =
        follows ? follower->group_index : static_cast<int>(in_group - group.joints.begin());
    const auto column = std::find(columns_.begin(), columns_.end(), group_index);
    chain_.push_back({.group_index = group_index,
                      .column = static_cast<int>(column - columns_.begin()),
                      .multiplier = follows ? joint.multiplier : 1,
                      .offset = follows ? joint.offset : 0,
                      .prismatic = joint.type == JointType::kPrismatic,
                      .X_PJ = X_LJ,
                      .axis_J = joint.axis_J});
    if (column == columns_.end()) columns_.push_back(group_index);
    X_LJ = Eigen::Isometry3d::Identity();
  }
  X_LT_ = X_LJ * X_LT;
}

Eigen::Isometry3d InverseKinematics::TipPose(std::span<const double> q) {
  Eigen::Isometry3d X_BL = Eigen::Isometry3d::Identity();
  for (ChainJoint& joint : chain_) {
    const double position =
        joint.multiplier * q[static_cast<std::size_t>(joint.group_index)] + joint.offset;
    X_BL = X_BL * joint.X_PJ;
    joint.axis_B = X_BL.linear() * joint.axis_J;
    joint.p_BJ = X_BL.translation();
    if (joint.prismatic) {
      X_BL.translation() += position * joint.axis_B;
    } else {
      X_BL.linear() = X_BL.linear() * Eigen::AngleAxisd(position, joint.axis_J).toRotationMatrix();
    }
  }
  return X_BL * X_LT_;
}

std::vector<double> InverseKinematics::RandomConfiguration(std::mt19937_64* random) const {
  std::vector<double> q;
  for (const JointSpace::Joint& joint : space_.joints()) {
    q.push_back(joint.lower + UniformFraction(random) * (joint.upper - joint.lower));
  }
  return q;
}

void InverseKinematics::Step(const PoseError& error, const PoseError& wanted,
                             const Eigen::Vector3d& p_BT, std::span<double> q) const {
  const auto n = static_cast<Eigen::Index>(columns_.size());
  if (n == 0) return;
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  Columns jacobian = Columns::Zero(6, n);
  for (const ChainJoint& joint : chain_) {
    Eigen::Vector<double, 6> velocity;
    if (joint.prismatic) {
      velocity << joint.axis_B, Eigen::Vector3d::Zero();
    } else {
      velocity << joint.axis_B.cross(p_BT - joint.p_BJ), joint.axis_B;
    }
    jacobian.col(joint.column) += joint.multiplier * wanted.cwiseProduct(velocity);
  }
  const double damping = 0.5 * error.squaredNorm() + kLeastDamping;
  Eigen::VectorXd motion;
  for (bool pushes_out = true; pushes_out;) {
    Eigen::Matrix<double, 6, 6> normal = jacobian * jacobian.transpose();
    normal.diagonal().array() += damping;
    motion = jacobian.transpose() * normal.llt().solve(error);
    pushes_out = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      const int index = columns_[static_cast<std::size_t>(i)];
      const JointSpace::Joint& limits = space_.joint(index);
      const double position = q[static_cast<std::size_t>(index)];
      if (limits.continuous || motion[i] == 0) continue;
      if (motion[i] > 0 ? position < limits.upper : position > limits.lower) continue;
      jacobian.col(i).setZero();
      pushes_out = true;
    }
  }
  const double longest = motion.cwiseAbs().maxCoeff();
  if (longest > kLongestStep) motion *= kLongestStep / longest;
  for (Eigen::Index i = 0; i < n; ++i) {
    const int index = columns_[static_cast<std::size_t>(i)];
    const JointSpace::Joint& limits = space_.joint(index);
    double& position = q[static_cast<std::size_t>(index)];
    position += motion[i];
    if (!limits.continuous) position = std::clamp(position, limits.lower, limits.upper);
  }
}

InverseKinematics::PoseError InverseKinematics::Descend(const Eigen::Isometry3d& X_BT,
                                                        const IkOptions& options,
                                                        std::vector<double>* q, int* steps) {
  Eigen::Isometry3d X_BL = TipPose(*q);
  const PoseError wanted = Wanted(options);
  PoseError error = wanted.cwiseProduct(Difference(X_BT, X_BL));
  double reference = error.norm();
  for (int step = 1; step <= options.max_steps && !Reached(error, options); ++step) {
    Step(error, wanted, X_BL.translation(), *q);
    ++*steps;
    X_BL = TipPose(*q);
    error = wanted.cwiseProduct(Difference(X_BT, X_BL));
    if (step % kPatience != 0) continue;
    if (error.norm() > kExpectedReduction * reference) break;
    reference = error.norm();
  }
  return error;
}

IkResult InverseKinematics::Solve(const Eigen::Isometry3d& X_BT, std::mt19937_64* random,
                                  const IkOptions& options) {
  IkResult best;
  double best_error = std::numeric_limits<double>::infinity();
  int steps = 0;
  int starts = 0;
  while (starts < options.max_starts && !best.solved) {
    ++starts;
    std::vector<double> q = RandomConfiguration(random);
    const PoseError error = Descend(X_BT, options, &q, &steps);
    if (error.norm() >= best_error) continue;
    best_error = error.norm();
    space_.Wrap(q);
    best.q = std::move(q);
    best.solved = Reached(error, options);
    best.position_error_m = error.head<3>().norm();
    best.orientation_error_rad = error.tail<3>().norm();
  }
  best.starts = starts;
  best.steps = steps;
  return best;
}

}  // namespace planbench
