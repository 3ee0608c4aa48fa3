#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace planbench {

/// Named joint positions (rad or m).
struct JointState {
  std::vector<std::string> names;
  std::vector<double> positions;
  bool operator==(const JointState&) const = default;
};

/// Goal of one joint: position in [position - tolerance_below, position + tolerance_above].
struct JointGoal {
  std::string joint;
  double position = 0;         ///< rad or m
  double tolerance_above = 0;  ///< >= 0
  double tolerance_below = 0;  ///< >= 0
  bool operator==(const JointGoal&) const = default;
};

/// Box that the request allows the robot to move in, in `frame`, m.
struct Workspace {
  std::string frame;
  Eigen::Vector3d min_corner = Eigen::Vector3d::Constant(-1);
  Eigen::Vector3d max_corner = Eigen::Vector3d::Constant(1);
};

/// One motion-planning problem: a MoveIt scene and request.
struct Problem {
  std::string set;  ///< Name of the problem set, "" outside one.
  int index = 0;    ///< NNNN of sceneNNNN.yaml or .yml.
  Scene scene;
  std::string group;  ///< Planning group, may be empty (the robot's first).
  /// Every joint that the scene's robot_state or the request's start_state names, the latter's
  /// positions before the former's; planar and floating joints by RobotModel::position_names.
  JointState start;
  /// Alternatives in turn, each of every joint of the group once, in the group's order.
  std::vector<JointGoal> goal;
  std::optional<Workspace> workspace;
  double time_limit_s = 0;            ///< allowed_planning_time; 0 if absent.
  std::vector<std::string> warnings;  ///< What was read otherwise than written, a line each.
};

/// sceneNNNN.yaml and requestNNNN.yaml of one folder, or .yml.
struct ProblemFiles {
  int index = 0;
  std::filesystem::path scene;
  std::filesystem::path request;
};

/// A folder of problems; its name is the folder's.
struct ProblemSet {
  std::string name;
  std::filesystem::path folder;
  std::vector<ProblemFiles> problems;  ///< By index, ascending.

  /// The files of a problem, nullptr if the set has none of that index.
  const ProblemFiles* Find(int index) const;
};

/// Throws InputError, with the system's reason, for a symbolic link that cannot be followed and for
/// what may not be looked at; not for what is not there.
void RefuseUnreachable(const std::filesystem::path& path);

/// Throws InputError if there is no such folder.
void RequireProblemFolder(const std::filesystem::path& folder);

/// Throws InputError if one of a problem's files is missing, or is a folder, a pipe or the like.
void RequireProblemFiles(const std::filesystem::path& scene, const std::filesystem::path& request);

/// Lists a problem set, problems of which a file is missing or none included. Throws InputError if
/// the folder is missing or holds no problem, or if two files have the same number.
ProblemSet ListProblemSet(const std::filesystem::path& folder);

/// NNNN of sceneNNNN.yaml or requestNNNN.yaml (any number of digits), or .yml; nothing for other
/// names. Throws InputError if the number is too large.
std::optional<int> ProblemIndexOf(const std::filesystem::path& scene_or_request_file);

/// Name of a problem set: its folder's, links not followed.
std::string ProblemSetNameOf(const std::filesystem::path& folder);

}  // namespace planbench
