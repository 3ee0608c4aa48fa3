#include "report/shown_robot.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <variant>

#include "common/error.h"

namespace planbench {
namespace {

/// A mesh in which the first vertex in each cell of a grid stands for all that are in it. Of a
/// million triangles, which some robots have, no page can hold the copies of its attempts.
SharedMesh Coarse(const SharedMesh& mesh) {
  constexpr double kCells = 10;  // along its longest side
  const Eigen::Vector3d low = mesh.box().min();
  const double cell_m = mesh.box().sizes().maxCoeff() / kCells;
  if (!(cell_m > 0)) return mesh;
  TriangleMesh coarse;
  std::map<std::array<int, 3>, std::uint32_t> by_cell;
  const auto stand_in = [&](std::uint32_t vertex) {
    const Eigen::Vector3d& p = mesh->vertices[vertex];
    const Eigen::Array3i cell = ((p - low) / cell_m).array().floor().cast<int>();
    const auto found = by_cell.try_emplace({cell.x(), cell.y(), cell.z()},
                                           static_cast<std::uint32_t>(coarse.vertices.size()));
    if (found.second) coarse.vertices.push_back(p);
    return found.first->second;
  };
  for (const auto& triangle : mesh->triangles) {
    const std::uint32_t a = stand_in(triangle[0]);
    const std::uint32_t b = stand_in(triangle[1]);
    const std::uint32_t c = stand_in(triangle[2]);
    if (a != b && b != c && c != a) coarse.triangles.push_back({a, b, c});
  }
  return coarse.triangles.empty() ? mesh : SharedMesh(std::move(coarse));
}

}  // namespace

ShownRobot::ShownRobot(Robot robot) : robot_(std::move(robot)) {
  if (!robot_.spheres.empty()) return;
  try {
    bodies_ = LoadLinkGeometry(robot_);
  } catch (const InputError& error) {
    why_not_ = fmt::format("has no spheres, and {}", error.what());
    return;
  }
  if (bodies_.empty()) why_not_ = "has neither spheres nor collision geometry";
  for (LinkGeometry& body : bodies_) {
    for (PlacedShape& placed : body.shapes) {
      if (auto* mesh = std::get_if<Mesh>(&placed.shape)) mesh->triangles = Coarse(mesh->triangles);
    }
  }
}

}  // namespace planbench
