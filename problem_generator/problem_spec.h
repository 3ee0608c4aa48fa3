#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/enum_names.h"
#include "robot_model/robot_folder.h"
#include "scene/problem.h"

namespace planbench {

/// What a problem set is made from: the contents of a specification file (format:
/// problems/README.md), resolved against a robot.

/// A number, or what it is drawn from: uniform in [low, high].
struct Range {
  double low = 0;
  double high = 0;
};
using Range3 = std::array<Range, 3>;

enum class PartKind { kBox, kCylinder, kSphere };
template <>
struct EnumNames<PartKind> {
  static constexpr auto kNames = std::to_array<std::string_view>({"box", "cylinder", "sphere"});
};

/// A primitive of an object.
struct PartSpec {
  std::string name;  ///< May be empty; unique within the object otherwise.
  PartKind kind = PartKind::kBox;
  std::vector<Range> size;  ///< m. Box: x, y, z; cylinder: height, radius; sphere: radius.
  Range3 position;          ///< In the object's frame, m.
  Range3 rpy;               ///< Fixed-axis roll, pitch, yaw as in URDF, rad.
};

struct ObjectSpec {
  std::string id;
  std::string where;  ///< "file:line: objects[i]", for errors.
  std::vector<PartSpec> parts;
  double probability = 1;  ///< Of being in a scene.

  /// The object whose frame the pose is in, an index below this object's own; -1: the robot's base
  /// frame.
  int parent = -1;
  /// Index of the parent's box that the object stands on, -1 if it does not stand on one.
  /// `position` is then from the centre of the box's upper face, and z is not used.
  int support_part = -1;
  Range3 position;   ///< m
  Range3 rpy;        ///< rad
  Range about_base;  ///< Turned by this about the base frame's z axis after all else, rad.
};

/// Poses of a tip link of the group relative to an object.
struct GripperSpec {
  int tip_link = -1;
  std::vector<int> objects;  ///< One of these, each as likely, of those that are in the scene.
  /// The tip is at Rz(around) * (position, rpy) in the object's frame, off by up to the
  /// tolerances: each coordinate (m), each component of the rotation vector (rad).
  Range around;
  Range3 position;
  Range3 rpy;
  double position_tolerance_m = 0;
  double orientation_tolerance_rad = 0;
};

/// Start or goal of a query.
struct EndSpec {
  std::string where;                                 ///< "file:line: queries[i].goal", for errors.
  std::string name;                                  ///< "approach goal", for counts.
  std::optional<std::vector<double>> configuration;  ///< Group order; without one, `gripper`.
  GripperSpec gripper;
};

struct QuerySpec {
  std::string name;
  double weight = 1;
  EndSpec start;
  EndSpec goal;
};

/// What is tried for a problem before it is given up.
struct Effort {
  int scenes = 0;     ///< Scenes drawn.
  int poses = 0;      ///< Gripper poses drawn for an end in a scene.
  int solutions = 0;  ///< Solutions of the inverse kinematics tried for a pose.
  int ik_starts = 0;  ///< IkOptions::max_starts
};

struct ProblemSpec {
  std::string name;  ///< The file's, without .yaml.
  std::string group;
  /// Every joint that can move. Those of the group count where a gripper's pose leaves them open.
  JointState rest;
  std::optional<Workspace> workspace;
  double time_limit_s = 0;
  AllowedCollisionMatrix allowed_collisions;

  double clearance_m = 0;         ///< Of the robot at start and goal, from everything.
  double object_gap_m = 0;        ///< Between objects, but for what an object stands on.
  double min_joint_distance = 0;  ///< Between start and goal: L2, rad and m unweighted.
  Effort effort;
  std::vector<ObjectSpec> objects;
  std::vector<QuerySpec> queries;
  std::vector<std::string> warnings;  ///< What is odd about the setup, one line each.
};

/// Reads a specification for a robot. Throws InputError naming file, line and key.
ProblemSpec LoadProblemSpec(const std::filesystem::path& file, const Robot& robot);

}  // namespace planbench
