#include "robot_model/referee_misfits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "common/random.h"
#include "robot_model/full_positions.h"

namespace planbench {
namespace {

// Descriptions of one robot differ by their rounding, which is less.
constexpr double kSamePlace = 1e-3;  // m
constexpr double kSameTurn = 1e-3;   // rad
constexpr int kDraws = 8;

// Position of a joint of one position at full positions of its robot; of one that follows another,
// where that one puts it.
double PlaceOf(const Joint& joint, const std::vector<double>& full) {
  if (joint.position_index < 0) return joint.offset;
  const double position = full[static_cast<std::size_t>(joint.position_index)];
  return joint.leader < 0 ? position : joint.multiplier * position + joint.offset;
}

// Puts the joints of `other` where `model` has those of the same names at full positions, those
// that follow others among them.
void PutAll(const RobotModel& model, const std::vector<double>& positions, const RobotModel& other,
            std::vector<double>* positions_of_other) {
  std::vector<std::string> names = model.position_names();
  std::vector<double> values = positions;
  for (const Joint& joint : model.joints()) {
    if (joint.leader < 0) continue;
    names.push_back(joint.name);
    values.push_back(PlaceOf(joint, positions));
  }
  PutPositions(other, names, values, positions_of_other);
}

// Where a robot that has a joint fixed shows it, which here has one position.
double ShownPosition(const Joint& joint, const Joint& fixed) {
  const Eigen::Isometry3d X_JC = joint.X_PJ.inverse(Eigen::Isometry) * fixed.X_PJ;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(X_JC.linear()));
  return joint.type == JointType::kPrismatic ? X_JC.translation().dot(joint.axis_J)
                                             : turn.angle() * turn.axis().dot(joint.axis_J);
}

// Puts joints of `model` that only `other` has fixed where it shows them, whatever their limits.
void PutWhereFixed(const RobotModel& other, const RobotModel& model,
                   std::vector<double>* positions) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const Joint& fixed : other.joints()) {
    const int index = model.FindJoint(fixed.name);
    if (fixed.type != JointType::kFixed || index < 0) continue;
    const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
    if (NumPositions(joint.type) != 1) continue;
    names.push_back(joint.name);
    values.push_back(ShownPosition(joint, fixed));
  }
  PutPositions(model, names, values, positions);
}

// Full positions, the default ones first. Planar and floating joints stay there.
std::vector<std::vector<double>> Configurations(const RobotModel& model) {
  std::vector<std::vector<double>> configurations = {model.DefaultPositions()};
  std::mt19937_64 random(1);
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<double> positions = configurations.front();
    for (const Joint& joint : model.joints()) {
      if (joint.leader >= 0 || NumPositions(joint.type) != 1) continue;
      const JointSpace::Joint range = SpaceJoint(joint);
      positions[static_cast<std::size_t>(joint.position_index)] =
          range.lower + UniformFraction(&random) * (range.upper - range.lower);
    }
    configurations.push_back(std::move(positions));
  }
  return configurations;
}

std::vector<Eigen::Isometry3d> PosesFrom(int base, const RobotModel& model,
                                         const std::vector<double>& positions) {
  std::vector<Eigen::Isometry3d> poses = ComputeLinkPoses(model, positions);
  const Eigen::Isometry3d X_RB = poses[static_cast<std::size_t>(base)].inverse(Eigen::Isometry);
  for (Eigen::Isometry3d& pose : poses) pose = X_RB * pose;
  return poses;
}

struct Offset {
  double distance = 0;  // m
  double angle = 0;     // rad
  bool Counts() const { return distance > kSamePlace || angle > kSameTurn; }
};

// Of each link of the planning robot the greatest, zero of those that the referee does not have. A
// link's frame may have another direction for the same body: but of a tip, the angle is by how much
// that changes.
std::vector<Offset> OffsetsOfLinks(const Robot& planning_robot, const RobotModel& other) {
  const RobotModel& model = planning_robot.model;
  std::set<int> tips;
  for (const PlanningGroup& group : planning_robot.groups) {
    for (const int tip : group.tips()) tips.insert(tip);
  }
  // As scenes are placed: where the one root is in the other robot.
  const int root_in_other = other.FindLink(model.links().front().name);
  const int base = root_in_other >= 0 ? 0 : model.FindLink(other.links().front().name);
  std::vector<Offset> offsets(model.links().size());
  std::map<int, Eigen::Matrix3d> directions;
  for (const int tip : tips) directions.emplace(tip, Eigen::Matrix3d::Identity());
  for (std::vector<double>& positions : Configurations(model)) {
    PutWhereFixed(other, model, &positions);
    const std::vector<double> of_other = RefereePositions(model, positions, other);
    // What only there follows another joint is where that one has it.
    PutAll(other, of_other, model, &positions);
    const auto X_RL = PosesFrom(base, model, positions);
    const auto X_RL_of_other = PosesFrom(std::max(root_in_other, 0), other, of_other);
    for (int link = 0; link < model.num_links(); ++link) {
      const auto i = static_cast<std::size_t>(link);
      const int same = other.FindLink(model.links()[i].name);
      if (same < 0) continue;
      const Eigen::Isometry3d offset =
          X_RL[i].inverse(Eigen::Isometry) * X_RL_of_other[static_cast<std::size_t>(same)];
      const Eigen::Matrix3d& direction = directions.emplace(link, offset.linear()).first->second;
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(direction.transpose() * offset.linear()));
      offsets[i].distance = std::max(offsets[i].distance, offset.translation().norm());
      offsets[i].angle = std::max(offsets[i].angle, turn.angle());
    }
  }
  return offsets;
}

// Wider limits are no matter: paths keep to the planning robot's.
bool MovesOtherwise(const Joint& joint, const Joint& of_referee) {
  return of_referee.lower > joint.lower + JointSpace::kLimitTolerance ||
         of_referee.upper < joint.upper - JointSpace::kLimitTolerance ||
         SpaceJoint(of_referee).continuous != SpaceJoint(joint).continuous;
}

std::string Range(const Joint& joint) {
  return SpaceJoint(joint).continuous ? "none"
                                      : fmt::format("[{:.6g}, {:.6g}]", joint.lower, joint.upper);
}

// Joints of the groups, in the order of the URDF, with their limits there and here.
std::vector<std::string> OtherLimits(const Robot& planning_robot, const RobotModel& other) {
  std::set<int> planned;
  for (const PlanningGroup& group : planning_robot.groups) {
    planned.insert(group.joints.begin(), group.joints.end());
  }
  std::vector<std::string> limits;
  for (const int index : planned) {
    const Joint& joint = planning_robot.model.joints()[static_cast<std::size_t>(index)];
    const Joint& same = other.joints()[static_cast<std::size_t>(other.FindJoint(joint.name))];
    if (!MovesOtherwise(joint, same)) continue;
    limits.push_back(fmt::format("{} {}, not {}", joint.name, Range(same), Range(joint)));
  }
  return limits;
}

// In words; "" for a joint that is not elsewhere in the referee's robot.
std::string JointMisfit(const Joint& joint, const std::vector<double>& positions, const Joint& same,
                        const RobotModel& referee, const std::vector<double>& of_referee) {
  const bool is_fixed = same.type == JointType::kFixed;
  if (NumPositions(joint.type) > 1) {
    if (!is_fixed) return "";
    const Eigen::Isometry3d offset =
        (joint.X_PJ * JointMotion(joint, positions)).inverse() * same.X_PJ;
    const double angle = Eigen::AngleAxisd(Eigen::Matrix3d(offset.linear())).angle();
    if (offset.translation().norm() <= kSamePlace && angle <= kSameTurn) return "";
    return fmt::format("joint '{}' is fixed there, at another pose", joint.name);
  }
  if (NumPositions(same.type) > 1 || (!is_fixed && same.leader < 0)) return "";
  const double here = PlaceOf(joint, positions);
  const double there = is_fixed ? ShownPosition(joint, same) : PlaceOf(same, of_referee);
  const double offset = there - here;
  if (joint.type == JointType::kPrismatic ? std::abs(offset) <= kSamePlace
                                          : std::abs(WrapAngle(offset)) <= kSameTurn) {
    return "";
  }
  const std::string why =
      is_fixed ? "is fixed there"
               : fmt::format("follows '{}' there",
                             referee.joints()[static_cast<std::size_t>(same.leader)].name);
  return fmt::format("joint '{}' {}, at {:.4f}, not at {:.4f}", joint.name, why, there, here);
}

}  // namespace

std::vector<double> RefereePositions(const RobotModel& model, const std::vector<double>& positions,
                                     const RobotModel& referee) {
  std::vector<double> of_referee = referee.DefaultPositions();
  PutWhereFixed(model, referee, &of_referee);
  PutAll(model, positions, referee, &of_referee);
  return of_referee;
}

std::string PostureMisfits(const RobotModel& model, const std::vector<double>& positions,
                           const RobotModel& referee) {
  const std::vector<double> of_referee = RefereePositions(model, positions, referee);
  std::vector<std::string> misfits;
  for (const Joint& joint : model.joints()) {
    const int index = referee.FindJoint(joint.name);
    if (joint.type == JointType::kFixed || index < 0) continue;
    const Joint& same = referee.joints()[static_cast<std::size_t>(index)];
    std::string misfit = JointMisfit(joint, positions, same, referee, of_referee);
    if (!misfit.empty()) misfits.push_back(std::move(misfit));
  }
  return fmt::format("{}", fmt::join(misfits, ", "));
}

std::string RefereeMisfits(const Robot& planning_robot, const Robot& referee) {
  const RobotModel& model = planning_robot.model;
  std::vector<std::string> misfits;
  const std::vector<Offset> offsets = OffsetsOfLinks(planning_robot, referee.model);
  const auto first = std::ranges::find_if(offsets, &Offset::Counts);
  if (first != offsets.end()) {
    std::vector<std::string> by;
    if (first->distance > kSamePlace) {
      by.push_back(fmt::format("{:.1f} mm", 1000 * first->distance));
    }
    if (first->angle > kSameTurn) by.push_back(fmt::format("{:.3g} rad", first->angle));
    const Link& link = model.links()[static_cast<std::size_t>(first - offsets.begin())];
    misfits.push_back(fmt::format(
        "it is another robot: link '{}', beyond joint '{}', is up to {} from where the robot '{}' "
        "has it",
        link.name, model.joints()[static_cast<std::size_t>(link.parent_joint)].name,
        fmt::join(by, " and "), planning_robot.name));
  }
  const std::vector<std::string> limits = OtherLimits(planning_robot, referee.model);
  if (!limits.empty()) {
    misfits.push_back(fmt::format("its joints have other limits than those of the robot '{}': {}",
                                  planning_robot.name, fmt::join(limits, ", ")));
  }
  return fmt::format("{}", fmt::join(misfits, "; "));
}

}  // namespace planbench
