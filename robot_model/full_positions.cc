#include "robot_model/full_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "common/error.h"

namespace planbench {
namespace {

// Positions that differ by less say the same (rad or m): they were measured, or written as text.
constexpr double kAgreement = 1e-3;
// The same for what must be none at all: how far a planar joint is off its plane (m; rad).
constexpr double kOffPlane = 1e-4;

// Index of the position of that name, the joint's own or its leader's; -1 if there is none.
int PositionIndex(const RobotModel& model, const std::string& name, const Joint** joint) {
  *joint = nullptr;
  const int index = model.FindJoint(name);
  if (index >= 0) {
    *joint = &model.joints()[static_cast<std::size_t>(index)];
    return (*joint)->position_index;
  }
  const std::vector<std::string>& known = model.position_names();
  const auto found = std::find(known.begin(), known.end(), name);
  return found == known.end() ? -1 : static_cast<int>(found - known.begin());
}

bool AreEqual(double a, double b) { return std::abs(a - b) <= JointSpace::kLimitTolerance; }

// Whether a fixed joint is at that position by its description: one that fixes a joint away from
// its zero has moved its origin there, along or about the axis.
bool IsFixedAt(const Joint& joint, double position) {
  if (AreEqual(position, 0)) return true;
  const Eigen::Matrix3d R_PJ = joint.X_PJ.linear();
  const Eigen::AngleAxisd turn(R_PJ);
  return AreEqual(position, joint.X_PJ.translation().dot(R_PJ * joint.axis_J)) ||
         AreEqual(position, turn.angle() * turn.axis().dot(joint.axis_J));
}

// Whether it may be, by a description that tells no axis, or another one.
bool MayBeFixedAt(const Joint& joint, double position) {
  const Eigen::Vector3d& p = joint.X_PJ.translation();
  const double angle = Eigen::AngleAxisd(Eigen::Matrix3d(joint.X_PJ.linear())).angle();
  return IsFixedAt(joint, position) ||
         std::ranges::any_of(std::array{p.x(), p.y(), p.z(), angle}, [&](double value) {
           return AreEqual(std::abs(value), std::abs(position));
         });
}

// Why a position that is a part of a joint's pose cannot have that value.
std::optional<std::string> FindPartFault(const RobotModel& model, int position_index,
                                         double position) {
  for (const Joint& joint : model.joints()) {
    if (joint.type != JointType::kPlanar) continue;
    const int part = position_index - joint.position_index;  // x, y, z and those of a quaternion.
    if ((part == 2 || part == 3 || part == 4) && std::abs(position) > kOffPlane) {
      return fmt::format("is of a planar joint and cannot be at {}, only at 0", position);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<PosePart> FindPosePart(const RobotModel& model, const std::string& name) {
  const Joint* joint = nullptr;
  const int index = PositionIndex(model, name, &joint);
  if (joint != nullptr) return std::nullopt;
  if (index >= 0) return PosePart{index};
  for (const Joint& planar : model.joints()) {
    if (planar.type != JointType::kPlanar) continue;
    const int first = planar.position_index;
    if (name == planar.name + "/x") return PosePart{first};
    if (name == planar.name + "/y") return PosePart{first + 1};
    if (name == planar.name + "/theta") return PosePart{first + 5, true};
  }
  return std::nullopt;
}

double PositionOf(const PosePart& part, const std::vector<double>& full) {
  const auto i = static_cast<std::size_t>(part.position_index);
  return part.is_angle ? 2 * std::atan2(full[i], full[i + 1]) : full[i];
}

std::optional<std::string> FindPoseFault(JointType type, const Eigen::Isometry3d& X_JC) {
  if (NumPositions(type) == 1) return "is not one that takes a pose";
  if (type == JointType::kFixed &&
      (X_JC.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() > kOffPlane) {
    return "is fixed and cannot be at a pose other than the identity";
  }
  if (type != JointType::kPlanar) return std::nullopt;
  const double height = X_JC.translation().z();
  if (std::abs(height) > kOffPlane) {
    return fmt::format("is planar and cannot be off its plane, at z = {}", height);
  }
  const Eigen::Vector3d& z_J = X_JC.linear().col(2);
  const double tilt = std::atan2(z_J.head<2>().norm(), z_J.z());
  if (tilt > kOffPlane) {
    return fmt::format("is planar and cannot be tilted, here by {:.4g} rad", tilt);
  }
  return std::nullopt;
}

std::optional<std::string> FindPositionFault(const RobotModel& model, const std::string& name,
                                             double position) {
  const Joint* joint = nullptr;
  const int index = PositionIndex(model, name, &joint);
  if (joint == nullptr) {
    if (index >= 0) return FindPartFault(model, index, position);
    return fmt::format("is unknown; robot '{}' has none of that name", model.name());
  }
  if (NumPositions(joint->type) > 1) return "takes a pose (multi_dof_joint_state), not a position";
  if (joint->type == JointType::kFixed && !MayBeFixedAt(*joint, position)) {
    return fmt::format("is fixed and cannot be at {}", position);
  }
  return std::nullopt;
}

std::optional<std::string> FindPositionDoubt(const RobotModel& model, const std::string& name,
                                             double position) {
  const int index = model.FindJoint(name);
  if (index < 0) return std::nullopt;
  const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
  if (joint.type == JointType::kFixed && !IsFixedAt(joint, position) &&
      MayBeFixedAt(joint, position)) {
    return fmt::format(
        "is fixed; {} is a number of its origin, taken for where it was fixed, and does not count",
        position);
  }
  return std::nullopt;
}

void PutPositions(const RobotModel& model, const std::vector<std::string>& names,
                  const std::vector<double>& positions, std::vector<double>* full) {
  // Followers first: where the leader is named too, it has the last word.
  for (const bool followers : {true, false}) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Joint* joint = nullptr;
      const int index = PositionIndex(model, names[i], &joint);
      const bool follows = joint != nullptr && joint->leader >= 0;
      if (index < 0 || follows != followers) continue;
      if (joint != nullptr && NumPositions(joint->type) > 1) continue;
      double position = positions[i];
      if (follows && joint->multiplier == 0) continue;
      if (follows) position = (position - joint->offset) / joint->multiplier;
      (*full)[static_cast<std::size_t>(index)] = position;
    }
  }
}

std::string FollowerThatPuts(const RobotModel& model, int leader,
                             const std::vector<std::string>& names) {
  std::string puts;  // The last one does.
  for (const std::string& name : names) {
    const int index = model.FindJoint(name);
    if (index == leader) return "";
    if (index < 0) continue;
    const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
    if (joint.leader == leader && joint.position_index >= 0 && joint.multiplier != 0) puts = name;
  }
  return puts;
}

std::vector<double> FullPositionsWherePossible(const RobotModel& model,
                                               const std::vector<std::string>& names,
                                               const std::vector<double>& positions) {
  std::vector<double> full = model.DefaultPositions();
  PutPositions(model, names, positions, &full);
  return full;
}

std::vector<double> FullPositions(const RobotModel& model, const std::vector<std::string>& names,
                                  const std::vector<double>& positions, const std::string& origin) {
  if (names.size() != positions.size()) {
    throw InputError(
        fmt::format("{}: {} joint names but {} positions", origin, names.size(), positions.size()));
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const auto fault = FindPositionFault(model, names[i], positions[i])) {
      throw InputError(fmt::format("{}: joint '{}' {}", origin, names[i], *fault));
    }
    if (!seen.insert(names[i]).second) {
      throw InputError(fmt::format("{}: joint '{}' occurs twice", origin, names[i]));
    }
  }
  return FullPositionsWherePossible(model, names, positions);
}

std::vector<std::string> FindContradictions(const RobotModel& model,
                                            const std::vector<std::string>& names,
                                            const std::vector<double>& positions) {
  const std::vector<double> full = FullPositionsWherePossible(model, names, positions);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int index = model.FindJoint(names[i]);
    if (index < 0) continue;
    const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
    if (joint.leader < 0) continue;
    const Joint& leader = model.joints()[static_cast<std::size_t>(joint.leader)];
    const double at =
        joint.position_index < 0
            ? joint.offset
            : joint.multiplier * full[static_cast<std::size_t>(joint.position_index)] +
                  joint.offset;
    if (std::abs(at - positions[i]) <= kAgreement) continue;
    const std::string puts = FollowerThatPuts(model, joint.leader, names);
    lines.push_back(
        fmt::format("joint '{}' is given at {}, but follows joint '{}', which {}puts it at {:g}",
                    joint.name, positions[i], leader.name,
                    puts.empty() ? "" : fmt::format("is where '{}' has it, and ", puts), at));
  }
  return lines;
}

}  // namespace planbench
