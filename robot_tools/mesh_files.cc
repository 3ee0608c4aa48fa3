#include "robot_tools/mesh_files.h"

#include <set>
#include <string_view>
#include <variant>

#include "common/error.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackage = "package://";

bool IsAbsolute(const std::string& uri) {
  return fs::path(uri).is_absolute() || uri.starts_with("file://");
}

}  // namespace

MeshFiles FindMeshes(const RobotModel& model, const ResourceResolver& resources) {
  std::set<std::string> uris;
  for (const Link& link : model.links()) {
    for (const PlacedShape& placed : link.collision) {
      const auto* mesh = std::get_if<Mesh>(&placed.shape);
      if (mesh != nullptr && !mesh->resource.empty()) uris.insert(mesh->resource);
    }
  }
  MeshFiles meshes;
  for (const std::string& uri : uris) {
    try {
      const fs::path source = resources.Resolve(uri);
      if (IsAbsolute(uri)) continue;
      const bool in_package = uri.starts_with(kPackage);
      const fs::path place =
          fs::path(in_package ? uri.substr(kPackage.size()) : uri).lexically_normal();
      if (*place.begin() == "..") throw InputError(uri + ": leads out of the URDF's folder");
      meshes.files.push_back({source, place});
    } catch (const InputError& error) {
      meshes.missing.emplace_back(error.what());
    }
  }
  return meshes;
}

void CopyMeshes(const MeshFiles& meshes, const fs::path& folder) {
  for (const MeshFiles::File& file : meshes.files) {
    const fs::path target = folder / file.place;
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    if (!error) {
      fs::copy_file(file.source, target, fs::copy_options::overwrite_existing, error);
    }
    if (error) throw InputError("cannot write " + target.string());
  }
}

}  // namespace planbench
