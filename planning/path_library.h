#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/yaml.h"
#include "planning/plan_result.h"
#include "robot_model/joint_space.h"
#include "robot_model/robot_model.h"

namespace planbench {

/// Setting by which a planner tells the problem sets that it has learned from, ", " between.
inline constexpr char kLearnedFrom[] = "learned_from";
/// Setting by which it tells their scenes (ShortSceneId), a blank between.
inline constexpr char kLearnedScenes[] = "learned_scenes";

/// Enough of a scene's content id to know it again.
std::string ShortSceneId(const std::string& scene_id);

/// Paths that were found before, for a planner to follow as far as they are still free.
struct PathLibrary {
  std::vector<std::string> joints;        ///< n, in the order of positions.
  std::vector<std::string> learned_from;  ///< Problem sets, sorted.
  /// One at least; each of two waypoints at least, n positions each, continuous joints wrapped.
  std::vector<Path> paths;
  /// Content ids of the scenes that the paths were found in, sorted; empty in libraries that were
  /// made before scenes were told.
  std::vector<std::string> scenes = {};

  /// True if its joints are those of the group, in its order.
  bool Fits(const JointSpace& space) const;

  /// The stretches of up to `count` paths, as they were or reversed, whose ends are nearest to
  /// `from` and `to` (sum of the two distances in joint space), the nearest first: waypoints from
  /// the one nearest to `from` to the one nearest to `to`. The library fits `space`.
  std::vector<Path> Recall(const JointSpace& space, std::span<const double> from,
                           std::span<const double> to, int count) const;
};

/// Throws InputError with file and line for what is no path library, one without paths or with
/// another number of them than it says, joints that are those of none of `groups`, and waypoints
/// outside their limits.
PathLibrary ReadPathLibrary(const YamlNode& file, std::span<const PlanningGroup> groups);

/// What ReadPathLibrary reads.
std::string ToYaml(const PathLibrary& library);

}  // namespace planbench
