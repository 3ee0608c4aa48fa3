#include "problem_generator/query_sampler.h"

namespace planbench {

Eigen::Isometry3d DrawTipPose(const GripperSpec& gripper, const Eigen::Isometry3d& X_BO,
                              RandomStream* random) {
  const Eigen::AngleAxisd around(random->Draw(gripper.around), Eigen::Vector3d::UnitZ());
  const Range position_error{-gripper.position_tolerance_m, gripper.position_tolerance_m};
  const Range turn_error{-gripper.orientation_tolerance_rad, gripper.orientation_tolerance_rad};
  Eigen::Isometry3d X_OT = Eigen::Isometry3d::Identity();
  // Statements of their own: within one, the compiler would choose what is drawn first.
  const Eigen::Vector3d error =
      random->Draw(Range3{position_error, position_error, position_error});
  X_OT.translation() = random->Draw(gripper.position) + error;
  const Eigen::Matrix3d nominal = RotationFromRpy(random->Draw(gripper.rpy));
  const Eigen::Vector3d turn = random->Draw(Range3{turn_error, turn_error, turn_error});
  X_OT.linear() = nominal;
  if (turn.norm() > 0) {
    X_OT.linear() = nominal * Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  }
  return X_BO * around * X_OT;
}

QuerySampler::QuerySampler(const ProblemSpec& spec, std::map<int, InverseKinematics>* kinematics,
                           CollisionChecker* checker)
    : spec_(&spec), kinematics_(kinematics), checker_(checker) {}

bool QuerySampler::Clear(const EndSpec& end, const std::vector<double>& q, Rejections* rejections) {
  if (!checker_->IsFree(q)) {
    rejections->Add(end.name + ": in collision", end.where);
    return false;
  }
  if (checker_->FindClosest(q).distance_m < spec_->clearance_m) {
    rejections->Add(end.name + ": too little clearance", end.where);
    return false;
  }
  return true;
}

std::optional<std::vector<double>> QuerySampler::Sample(
    const EndSpec& end, const SampledScene& scene, const std::optional<std::vector<double>>& other,
    RandomStream* random, Rejections* rejections) {
  if (end.configuration) {
    return Clear(end, *end.configuration, rejections) ? end.configuration : std::nullopt;
  }
  std::vector<Eigen::Isometry3d> objects;  // X_BO of those in the scene.
  for (const int object : end.gripper.objects) {
    const auto& X_BO = scene.poses[static_cast<std::size_t>(object)];
    if (X_BO) objects.push_back(*X_BO);
  }
  if (objects.empty()) {
    rejections->Add(end.name + ": object not in the scene", end.where);
    return std::nullopt;
  }
  InverseKinematics& kinematics = kinematics_->at(end.gripper.tip_link);
  const IkOptions options{.max_starts = spec_->effort.ik_starts};
  for (int pose = 0; pose < spec_->effort.poses; ++pose) {
    const Eigen::Isometry3d& X_BO = objects[random->Index(objects.size())];
    const Eigen::Isometry3d X_BT = DrawTipPose(end.gripper, X_BO, random);
    for (int solution = 0; solution < spec_->effort.solutions; ++solution) {
      IkResult result = kinematics.Solve(X_BT, random->engine(), options);
      if (!result.solved) {
        rejections->Add(end.name + ": no inverse kinematics solution", end.where,
                        {result.position_error_m, result.orientation_error_rad, options});
        break;
      }
      if (other) checker_->space().ToNearestTurn(*other, result.q);
      if (Clear(end, result.q, rejections)) return result.q;
    }
  }
  return std::nullopt;
}

}  // namespace planbench
