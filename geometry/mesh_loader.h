#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// Finds the files that URIs name. package://NAME/rest resolves through the packages given by name
/// (`--package-path NAME=DIR`), else through a folder called NAME: in base_folder, base_folder
/// itself or beside it, or so for the two folders above it. file:// and file:/ URIs (of no host, or
/// localhost) and absolute paths are taken as they are, relative paths from own_folder, which is
/// that of the file that names them, or, where it has no such file, from base_folder. URIs write
/// characters as %20; other names may, where no file has the name as it is.
struct ResourceResolver {
  std::filesystem::path base_folder;
  std::map<std::string, std::filesystem::path> packages;
  std::filesystem::path own_folder = {};  ///< Empty: base_folder.

  /// Path of an existing file; throws InputError naming the URI and what was tried.
  std::filesystem::path Resolve(const std::string& uri) const;
};

/// Parses what is given to --package-path, each "NAME=DIR"; throws InputError, also for a NAME with
/// two folders.
std::map<std::string, std::filesystem::path> ParsePackagePaths(
    const std::vector<std::string>& arguments);

/// Reads an STL or PLY (binary or ASCII), OBJ or DAE file, all its meshes joined with their node
/// transforms and the file's unit applied, vertices scaled per axis. What other formats assimp
/// knows is read as well. Triangles with corners in one place are left out where another has that
/// edge or corner. Throws InputError if it cannot be read or has no triangles.
TriangleMesh LoadMesh(const std::filesystem::path& path,
                      const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

}  // namespace planbench
