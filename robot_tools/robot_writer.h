#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "robot_model/robot_folder.h"

namespace planbench {

/// What a robot folder is made of.
struct RobotDraft {
  /// Pairs of links that are never checked against each other.
  struct ExemptPairs {
    std::string reason;
    std::vector<std::pair<int, int>> pairs;
  };
  Robot robot;            ///< Name, model, groups, virtual joints, spheres, checked pairs, edges.
  std::string urdf_text;  ///< Written as it is.
  std::string origin;     ///< Of all this, for the first line of robot.yaml.
  std::vector<ExemptPairs> exempt;
  std::vector<std::string> links_without_spheres;
};

/// robot.yaml for a draft whose files are NAME.urdf and, if it has spheres, spheres.yaml.
std::string RobotYaml(const RobotDraft& draft);

/// Where the folder has a draft's URDF.
std::filesystem::path UrdfPath(const RobotDraft& draft, const std::filesystem::path& folder);

/// Writes the folder. Throws InputError if a file cannot be written.
void WriteRobotFolder(const RobotDraft& draft, const std::filesystem::path& folder);

}  // namespace planbench
