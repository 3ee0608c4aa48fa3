#include "scene/moveit_pose_goal.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "common/numbers.h"
#include "common/random.h"
#include "robot_model/group_kinematics.h"
#include "robot_model/inverse_kinematics.h"
#include "scene/moveit_fields.h"
#include "scene/moveit_object_reader.h"

namespace planbench {
namespace {

constexpr std::size_t kMostConfigurations = 16;
constexpr double kLeastDistance = 0.1;  // Between two of them, rad and m.
constexpr double kMet = 1e-6;           // m or rad
// Poses tried, and random configurations that each is tried from.
constexpr int kPoses = 64;
constexpr int kStartsOfPose = 8;
// The same for all problems: two files that say the same in other frames get the same goals.
constexpr std::uint64_t kSeed = 1;

// P is the frame that is constrained: fixed to a tip link T, with its origin at the constrained
// point and the axes of the link whose orientation is constrained. B is the base frame.

struct Orientation {
  Eigen::Matrix3d R_BD;       // D is the wanted orientation of P.
  Eigen::Vector3d tolerance;  // rad
  bool rotation_vector = false;

  // The angles by which R_BP deviates.
  Eigen::Vector3d Deviation(const Eigen::Matrix3d& R_BP) const {
    const Eigen::Matrix3d R_DP = R_BD.transpose() * R_BP;
    if (rotation_vector) {
      const Eigen::AngleAxisd turn(R_DP);
      return turn.angle() * turn.axis();
    }
    return {std::atan2(-R_DP(1, 2), R_DP(2, 2)), std::asin(std::clamp(R_DP(0, 2), -1.0, 1.0)),
            std::atan2(-R_DP(0, 1), R_DP(0, 0))};
  }

  Eigen::Matrix3d Deviated(const Eigen::Vector3d& angles) const {
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    if (rotation_vector) {
      const double angle = angles.norm();
      return angle > 0 ? Eigen::Matrix3d(R_BD * AngleAxisd(angle, angles / angle)) : R_BD;
    }
    return R_BD *
           (AngleAxisd(angles.x(), Vector3d::UnitX()) * AngleAxisd(angles.y(), Vector3d::UnitY()) *
            AngleAxisd(angles.z(), Vector3d::UnitZ()))
               .toRotationMatrix();
  }

  // A rotation that deviates by no more than the tolerances.
  Eigen::Matrix3d Sample(std::mt19937_64* random) const {
    // Beyond these angles rotations are those of smaller ones.
    const Eigen::Vector3d most(kPi, rotation_vector ? kPi : kPi / 2, kPi);
    Eigen::Vector3d angles;
    do {
      for (int i = 0; i < 3; ++i) {
        angles[i] = (2 * UniformFraction(random) - 1) * std::min(tolerance[i], most[i]);
      }
    } while (rotation_vector && angles.norm() > kPi);
    return Deviated(angles);
  }
};

struct Region {
  Eigen::Isometry3d X_BR;
  Eigen::Vector3d half_size;  // Of a box; of a sphere, its radius thrice.
  bool ball = false;

  double Distance(const Eigen::Vector3d& p_B) const {  // 0 inside, m
    const Eigen::Vector3d p_R = X_BR.inverse(Eigen::Isometry) * p_B;
    if (ball) return std::max(0.0, p_R.norm() - half_size.x());
    return (p_R.cwiseAbs() - half_size).cwiseMax(0).norm();
  }

  Eigen::Vector3d Sample(std::mt19937_64* random) const {
    Eigen::Vector3d fraction;
    do {
      for (double& f : fraction) f = 2 * UniformFraction(random) - 1;
    } while (ball && fraction.norm() > 1);
    return X_BR * half_size.cwiseProduct(fraction);
  }
};

// The poses X_BP that are wanted. Without regions, or orientation, that is free.
struct PoseSet {
  std::vector<Region> regions;
  std::optional<Orientation> orientation;
  int tip_link = -1;
  Eigen::Isometry3d X_TP = Eigen::Isometry3d::Identity();

  // In turn the middle of each region with the wanted orientation, and one from all that is
  // allowed.
  Eigen::Isometry3d Try(int number, std::mt19937_64* random) const {
    const bool middle = number % 2 == 0;
    Eigen::Isometry3d X_BP = Eigen::Isometry3d::Identity();
    if (!regions.empty()) {
      const Region& region = regions[static_cast<std::size_t>(number / 2) % regions.size()];
      X_BP.translation() = middle ? region.X_BR.translation() : region.Sample(random);
    }
    if (orientation) X_BP.linear() = middle ? orientation->R_BD : orientation->Sample(random);
    return X_BP;
  }

  // What is left of free parts is not tried for.
  IkOptions Options() const {
    IkOptions options{.max_starts = kStartsOfPose};
    // Far below kMet, which what is found is judged by.
    options.position_tolerance_m = regions.empty() ? kInfinity : kMet / 10;
    options.orientation_tolerance_rad = orientation ? kMet / 10 : kInfinity;
    return options;
  }

  double PositionExcess(const Eigen::Isometry3d& X_BP) const {  // m
    if (regions.empty()) return 0;
    double nearest = kInfinity;
    for (const Region& region : regions) {
      nearest = std::min(nearest, region.Distance(X_BP.translation()));
    }
    return nearest;
  }

  double OrientationExcess(const Eigen::Isometry3d& X_BP) const {  // rad
    if (!orientation) return 0;
    return (orientation->Deviation(X_BP.linear()).cwiseAbs() - orientation->tolerance)
        .cwiseMax(0)
        .norm();
  }
};

// The link L that a constraint is of, and the tip that it moves as one with. What is constrained is
// the frame F, that of L or of an object that is attached to L.
struct ConstrainedLink {
  int tip_link;
  Eigen::Isometry3d X_TL;
  Eigen::Isometry3d X_LF;
};

// The link of a frame that a constraint names, and the frame in it.
FrameTree::InLink ReadConstrainedFrame(const YamlNode& node, const RobotModel& model,
                                       const FrameTree& frames) {
  const std::string name = LinkNamed(node.String(), model);
  if (model.FindLink(name) >= 0) return {name, Eigen::Isometry3d::Identity()};
  const std::optional<FrameTree::InLink> of_object = frames.OfObject(name);
  if (!of_object) {
    node.Fail("the robot has no link '" + name +
              "', nor is an object of that frame attached to it");
  }
  if (of_object->link.empty()) {
    node.Fail("'" + name + "' is a frame of an object that is not attached to the robot");
  }
  return *of_object;
}

ConstrainedLink ReadLink(const YamlNode& constraint, const RobotModel& model,
                         const PlanningGroup& group, const std::vector<double>& start,
                         const FrameTree& frames) {
  const YamlNode node = constraint.At("link_name");
  const FrameTree::InLink frame = ReadConstrainedFrame(node, model, frames);
  const int link = model.FindLink(frame.link);
  const GroupKinematics kinematics(model, group, start);
  std::vector<std::string> tips;
  for (const int tip : group.tips()) {
    if (!kinematics.MoveRelatively(link, tip)) {
      return {tip, kinematics.X_BL(tip).inverse(Eigen::Isometry) * kinematics.X_BL(link),
              frame.X_LF};
    }
    tips.push_back("'" + model.links()[static_cast<std::size_t>(tip)].name + "'");
  }
  node.Fail(fmt::format("the link '{}' does not move as one with {}, the tip{} of group '{}'",
                        frame.link, fmt::join(tips, " or "), tips.size() > 1 ? "s" : "",
                        group.name));
}

std::vector<Region> ReadRegions(const YamlNode& constraint, const FrameTree& frames) {
  const Eigen::Isometry3d& X_BF = frames.At(ReadFrame(constraint), FrameNode(constraint));
  const YamlNode volume = constraint.At("constraint_region");
  RefuseElements(volume, "meshes", "regions are boxes and spheres; meshes are not supported");
  const std::vector<YamlNode> primitives = OptionalElements(volume, "primitives");
  const std::vector<YamlNode> poses = OptionalElements(volume, "primitive_poses");
  if (primitives.empty()) volume.Fail("has no primitives");
  if (primitives.size() != poses.size()) {
    volume.Fail("has " + std::to_string(primitives.size()) + " primitives but " +
                std::to_string(poses.size()) + " primitive_poses");
  }
  std::vector<Region> regions;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    Region region{X_BF * ReadPose(poses[i]), Eigen::Vector3d::Zero()};
    const Shape shape = ReadPrimitive(primitives[i]);
    if (const auto* box = std::get_if<Box>(&shape)) {
      region.half_size = box->size / 2;
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
      region.ball = true;
      region.half_size.setConstant(sphere->radius);
    } else {
      primitives[i].At("type").Fail("regions are boxes and spheres; others are not supported");
    }
    regions.push_back(region);
  }
  return regions;
}

Orientation ReadOrientation(const YamlNode& constraint, const FrameTree& frames) {
  const Eigen::Isometry3d& X_BF = frames.At(ReadFrame(constraint), FrameNode(constraint));
  Orientation orientation;
  orientation.R_BD =
      X_BF.linear() * ReadQuaternion(constraint.At("orientation")).toRotationMatrix();
  for (int i = 0; i < 3; ++i) {
    const auto tolerance = constraint.Find(fmt::format("absolute_{}_axis_tolerance", "xyz"[i]));
    orientation.tolerance[i] = tolerance ? tolerance->NonNegativeDouble() : 0;
  }
  if (const auto node = constraint.Find("parameterization")) {
    const long long number = node->Int();
    if (number != 0 && number != 1) {
      node->Fail("expected 0 (XYZ_EULER_ANGLES) or 1 (ROTATION_VECTOR), found " +
                 std::to_string(number));
    }
    orientation.rotation_vector = number == 1;
  }
  return orientation;
}

// The poses that are wanted of the tip that `link` moves as one with; new ones if nothing is yet.
PoseSet* PosesOfTip(const ConstrainedLink& link, std::vector<PoseSet>* all) {
  const auto found = std::find_if(all->begin(), all->end(), [&](const PoseSet& poses) {
    return poses.tip_link == link.tip_link;
  });
  if (found != all->end()) return &*found;
  all->emplace_back().tip_link = link.tip_link;
  return &all->back();
}

// What is wanted of the tips, in the order that they are named in.
std::vector<PoseSet> ReadPoseSets(const YamlNode& constraints, const RobotModel& model,
                                  const PlanningGroup& group, const std::vector<double>& start,
                                  const FrameTree& frames) {
  constexpr const char* kTwice = "is the second of this kind for the same tip; one is supported";
  std::vector<PoseSet> all;
  for (const YamlNode& position : OptionalElements(constraints, "position_constraints")) {
    const ConstrainedLink link = ReadLink(position, model, group, start, frames);
    PoseSet* poses = PosesOfTip(link, &all);
    if (!poses->regions.empty()) position.Fail(kTwice);
    const auto offset = position.Find("target_point_offset");
    poses->X_TP.translation() =
        link.X_TL * link.X_LF *
        (offset ? ReadVector3(*offset) : Eigen::Vector3d(Eigen::Vector3d::Zero()));
    poses->regions = ReadRegions(position, frames);
  }
  for (const YamlNode& orientation : OptionalElements(constraints, "orientation_constraints")) {
    const ConstrainedLink link = ReadLink(orientation, model, group, start, frames);
    PoseSet* poses = PosesOfTip(link, &all);
    if (poses->orientation) orientation.Fail(kTwice);
    // As in MoveIt, what is wanted of an object is made what is wanted of its link, about whose
    // axes the tolerances then are.
    poses->X_TP.linear() = link.X_TL.linear();
    poses->orientation = ReadOrientation(orientation, frames);
    poses->orientation->R_BD *= link.X_LF.linear().transpose();
  }
  return all;
}

struct Attempt {
  std::vector<double> q;
  double off_m = 0;  // Sums over the tips.
  double off_rad = 0;
};

// Looks for a configuration with every tip at its try of that number: one after the other, with the
// joints held that move those before.
Attempt TryToReach(const std::vector<PoseSet>& poses, int number, const RobotModel& model,
                   const PlanningGroup& group, const JointSpace& limits,
                   const std::vector<double>& start, std::span<const double> from,
                   std::mt19937_64* random) {
  Attempt attempt;
  PlanningGroup limited = group;
  limited.space = limits;
  std::vector<InverseKinematics> tips;
  for (const PoseSet& of_tip : poses) {
    limited.tip_link = of_tip.tip_link;
    InverseKinematics& tip = tips.emplace_back(model, limited, start, of_tip.X_TP);
    attempt.q = tip.Solve(of_tip.Try(number, random), random, of_tip.Options()).q;
    limited.space = limited.space.Held(tip.moving_joints(), attempt.q);
  }
  limits.ToNearestTurn(from, attempt.q);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Isometry3d X_BP = tips[i].TipPose(attempt.q);
    attempt.off_m += poses[i].PositionExcess(X_BP);
    attempt.off_rad += poses[i].OrientationExcess(X_BP);
  }
  return attempt;
}

}  // namespace

bool HasPoseConstraints(const YamlNode& constraints) {
  return !OptionalElements(constraints, "position_constraints").empty() ||
         !OptionalElements(constraints, "orientation_constraints").empty();
}

std::vector<std::vector<double>> FindPoseGoals(const YamlNode& constraints, const RobotModel& model,
                                               const PlanningGroup& group, const JointSpace& limits,
                                               const std::vector<double>& start,
                                               const FrameTree& frames) {
  const std::vector<PoseSet> poses = ReadPoseSets(constraints, model, group, start, frames);
  std::vector<double> from;
  for (const int joint : group.joints) {
    const int index = model.joints()[static_cast<std::size_t>(joint)].position_index;
    from.push_back(start[static_cast<std::size_t>(index)]);
  }
  std::mt19937_64 random(kSeed);
  std::vector<std::vector<double>> found;
  double best_m = kInfinity;
  double best_rad = kInfinity;
  for (int number = 0; number < kPoses && found.size() < kMostConfigurations; ++number) {
    const Attempt attempt = TryToReach(poses, number, model, group, limits, start, from, &random);
    if (attempt.off_m + attempt.off_rad < best_m + best_rad) {
      best_m = attempt.off_m;
      best_rad = attempt.off_rad;
    }
    if (attempt.off_m > kMet || attempt.off_rad > kMet) continue;
    const bool is_new = std::all_of(found.begin(), found.end(), [&](const auto& other) {
      return group.space.Distance(attempt.q, other) >= kLeastDistance;
    });
    if (is_new) found.push_back(attempt.q);
  }
  if (found.empty()) {
    const auto positions = OptionalElements(constraints, "position_constraints");
    const YamlNode first =
        positions.empty() ? constraints.At("orientation_constraints").At(0) : positions.front();
    throw OutOfReach(fmt::format(
        "{}: no configuration of group '{}' reaches the pose{} ({})", first.Where(), group.name,
        poses.size() > 1 ? "s of its tips" : "",
        DescribeMiss(best_m, best_rad,
                     {.position_tolerance_m = kMet, .orientation_tolerance_rad = kMet})));
  }
  return found;
}

}  // namespace planbench
