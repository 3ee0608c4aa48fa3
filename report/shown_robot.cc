#include "report/shown_robot.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "collision/link_geometry.h"
#include "common/error.h"
#include "report/shape_json.h"

namespace planbench {
namespace {

/// Cells along its longest side that a mesh keeps at least.
constexpr double kLeastCells = 10;

double LongestSide(const SharedMesh& mesh) {
  return mesh.box().isEmpty() ? 0 : mesh.box().sizes().maxCoeff();
}

/// A mesh in which the first vertex in each cell of a grid, `most_cell_m` wide or less, stands for
/// all that are in it.
SharedMesh Coarse(const SharedMesh& mesh, double most_cell_m) {
  const double cell_m = std::min(most_cell_m, LongestSide(mesh) / kLeastCells);
  if (!(cell_m > 0)) return mesh;
  TriangleMesh coarse;
  std::map<std::array<double, 3>, std::uint32_t> by_cell;
  std::vector<std::uint32_t> stand_ins;
  for (const Eigen::Vector3d& p : mesh->vertices) {
    const Eigen::Array3d cell = ((p - mesh.box().min()) / cell_m).array().floor();
    const auto [found, is_new] =
        by_cell.try_emplace(std::array<double, 3>{cell.x(), cell.y(), cell.z()},
                            static_cast<std::uint32_t>(coarse.vertices.size()));
    if (is_new) coarse.vertices.push_back(p);
    stand_ins.push_back(found->second);
  }
  for (const auto& triangle : mesh->triangles) {
    const std::uint32_t a = stand_ins[triangle[0]];
    const std::uint32_t b = stand_ins[triangle[1]];
    const std::uint32_t c = stand_ins[triangle[2]];
    if (a != b && b != c && c != a) coarse.triangles.push_back({a, b, c});
  }
  return coarse.triangles.empty() ? mesh : SharedMesh(std::move(coarse));
}

std::size_t CountTriangles(const std::map<std::string, SharedMesh>& meshes) {
  std::size_t count = 0;
  for (const auto& [id, mesh] : meshes) count += mesh->triangles.size();
  return count;
}

/// Leaves the bodies' meshes, each of which a page holds once, about so many triangles at most;
/// what it tells of that, or nothing.
std::string Coarsen(std::size_t most_triangles, std::vector<LinkGeometry>* bodies) {
  std::vector<Mesh*> places;
  std::map<std::string, SharedMesh> finest;  // By id.
  double longest_m = 0;
  for (LinkGeometry& body : *bodies) {
    for (PlacedShape& placed : body.shapes) {
      auto* mesh = std::get_if<Mesh>(&placed.shape);
      if (mesh == nullptr) continue;
      places.push_back(mesh);
      finest.emplace(mesh->triangles.id(), mesh->triangles);
      longest_m = std::max(longest_m, LongestSide(mesh->triangles));
    }
  }
  std::map<std::string, SharedMesh> meshes = finest;
  const double coarsest_m = longest_m / kLeastCells;
  double cell_m = 0;
  for (double next_m = 1e-3; CountTriangles(meshes) > most_triangles && cell_m < coarsest_m;
       next_m *= 2) {
    cell_m = std::min(next_m, coarsest_m);
    for (auto& [id, mesh] : meshes) mesh = Coarse(finest.at(id), cell_m);
  }
  if (cell_m == 0) return "";
  for (Mesh* place : places) place->triangles = meshes.at(place->triangles.id());
  return fmt::format(
      "The robot's meshes are shown coarser than they are: {} triangles instead of {}, corners up "
      "to {} mm from their places.",
      CountTriangles(meshes), CountTriangles(finest), FormatNumber(1e3 * std::sqrt(3.0) * cell_m));
}

}  // namespace

ShownRobot::ShownRobot(Robot robot, std::size_t most_triangles)
    : robot_(std::move(robot)), most_triangles_(most_triangles) {}

const ShownBodies& ShownRobot::bodies() const {
  if (bodies_) return *bodies_;
  ShownBodies& shown = bodies_.emplace();
  try {
    std::vector<LinkGeometry> bodies = LoadLinkGeometry(robot_);
    if (bodies.empty()) shown.why_not = "its URDF has no collision geometry";
    shown.coarser = Coarsen(most_triangles_, &bodies);
    for (const LinkGeometry& body : bodies) {
      Json& shapes = shown.shapes[body.link];
      for (const PlacedShape& placed : body.shapes) {
        Json one;
        one["shape"] = ShapeJson(placed.shape, &shown.meshes);
        one["pose"] = PoseJson(placed.X_FS);
        shapes.push_back(std::move(one));
      }
    }
  } catch (const InputError& error) {
    shown.why_not = error.what();
  }
  return shown;
}

}  // namespace planbench
