#include "robot_model/mesh_robot_id.h"

#include <optional>
#include <variant>

#include "common/content_hash.h"
#include "common/error.h"
#include "common/read_text.h"

namespace planbench {
namespace {

std::optional<std::filesystem::path> FindFile(const ResourceResolver& resources,
                                              const std::string& uri) {
  try {
    return resources.Resolve(uri);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

std::string MeshRobotId(const Robot& robot) {
  ContentHash hash;
  hash.Add(robot.content_id);
  for (const Link& link : robot.model.links()) {
    for (const PlacedShape& placed : link.collision) {
      const Mesh* mesh = std::get_if<Mesh>(&placed.shape);
      if (mesh == nullptr) continue;
      if (const auto file = FindFile(robot.resources, mesh->resource)) hash.Add(ReadText(*file));
    }
  }
  return hash.HexDigest();
}

}  // namespace planbench
