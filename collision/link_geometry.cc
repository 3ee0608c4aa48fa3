#include "collision/link_geometry.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "collision/at.h"
#include "collision/shape_check.h"
#include "common/error.h"
#include "robot_model/odd_size.h"

namespace planbench {

std::vector<LinkGeometry> LoadLinkGeometry(const Robot& robot) {
  std::vector<LinkGeometry> links;
  for (int link = 0; link < robot.model.num_links(); ++link) {
    const Link& urdf_link = At(robot.model.links(), link);
    if (urdf_link.collision.empty()) continue;
    LinkGeometry geometry{link, urdf_link.collision};
    for (PlacedShape& placed : geometry.shapes) {
      auto* mesh = std::get_if<Mesh>(&placed.shape);
      if (mesh == nullptr || !mesh->triangles->triangles.empty() || mesh->resource.empty())
        continue;
      try {
        mesh->triangles = LoadMesh(robot.resources.Resolve(mesh->resource), mesh->scale);
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: collision mesh: {}", urdf_link.where, error.what()));
      }
    }
    links.push_back(std::move(geometry));
  }
  return links;
}

void RequireSolid(const Robot& robot, const std::vector<LinkGeometry>& links) {
  if (links.empty()) {
    throw InputError(fmt::format(
        "robot '{}' has no collision geometry, which the meshes model needs", robot.name));
  }
  for (const LinkGeometry& geometry : links) {
    const std::string& name = At(robot.model.links(), geometry.link).name;
    for (const PlacedShape& placed : geometry.shapes) RequireSolid(placed.shape, name);
  }
}

std::vector<std::string> OddSizes(const Robot& robot, const std::vector<LinkGeometry>& links) {
  std::vector<std::string> odd;
  for (const auto& [link, shapes] : links) {
    for (const PlacedShape& placed : shapes) {
      auto line = OddSize(At(robot.model.links(), link).name, placed.shape);
      if (line) odd.push_back(*std::move(line));
    }
  }
  return odd;
}

std::vector<LinkSphere> CoverOf(const std::vector<LinkGeometry>& links) {
  std::vector<LinkSphere> balls;
  for (const LinkGeometry& geometry : links) {
    for (const PlacedShape& placed : geometry.shapes) {
      if (const auto* mesh = std::get_if<Mesh>(&placed.shape)) {
        for (const Eigen::Vector3d& vertex : mesh->triangles->vertices) {
          balls.push_back({geometry.link, placed.X_FS * vertex, 0});
        }
      } else {
        const BoundingSphere bound = ComputeBoundingSphere(placed.shape);
        balls.push_back({geometry.link, placed.X_FS * bound.center, bound.radius});
      }
    }
  }
  return balls;
}

}  // namespace planbench
