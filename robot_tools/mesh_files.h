#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "robot_model/robot_folder.h"

namespace planbench {

/// The collision meshes that a URDF names, and where a robot folder keeps copies of them, so that
/// it can be moved.
struct MeshFiles {
  struct File {
    std::filesystem::path source;
    std::filesystem::path place;  ///< Of the copy, relative to the robot folder.
  };
  /// package://NAME/FILE to NAME/FILE, relative paths likewise: where the URDF finds them as it is.
  /// Others (absolute, file://, with .. or %20, or of a place that is taken) to meshes/.
  std::vector<File> files;
  std::map<std::string, std::string> renamed;  ///< What the URDF must call the others, by URI.
  std::vector<std::string> missing;  ///< Of each that cannot be found, where it is named and why.
};

/// The meshes of a model for the robot folder `folder`, whose own files are kept.
MeshFiles FindMeshes(const RobotModel& model, const ResourceResolver& resources,
                     const std::filesystem::path& folder);

/// `urdf_text` with the meshes named anew. Throws InputError for a text that is no XML.
std::string RenameMeshes(const std::string& urdf_text,
                         const std::map<std::string, std::string>& renamed);

/// Throws InputError for a file that cannot be written.
void CopyMeshes(const MeshFiles& meshes, const std::filesystem::path& folder);

}  // namespace planbench
