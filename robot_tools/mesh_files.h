#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "robot_model/robot_folder.h"

namespace planbench {

/// The collision meshes that a URDF names.
struct MeshFiles {
  struct File {
    std::filesystem::path source;
    std::filesystem::path place;  ///< Where a URDF in a robot folder finds it, relative to that.
  };
  /// Those to copy: package://NAME/FILE to NAME/FILE, relative paths likewise. Absolute ones stay
  /// where they are.
  std::vector<File> files;
  std::vector<std::string> missing;  ///< Of each that cannot be found, its URI and why.
};

MeshFiles FindMeshes(const RobotModel& model, const ResourceResolver& resources);

/// Throws InputError for a file that cannot be written.
void CopyMeshes(const MeshFiles& meshes, const std::filesystem::path& folder);

}  // namespace planbench
