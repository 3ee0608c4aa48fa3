#include "report/coarse_meshes.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <variant>

#include "report/table.h"

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

/// A mesh that is drawn at so many places.
struct DrawnMesh {
  SharedMesh finest;
  SharedMesh shown;
  std::size_t num_places = 0;
};

}  // namespace

void Coarsen(std::string_view whose, std::size_t most_triangles,
             const std::vector<std::vector<PlacedShape>*>& bodies,
             std::vector<std::string>* remarks) {
  std::vector<Mesh*> places;
  std::map<std::string, DrawnMesh> meshes;  // By id.
  double longest_m = 0;
  for (std::vector<PlacedShape>* body : bodies) {
    for (PlacedShape& placed : *body) {
      auto* place = std::get_if<Mesh>(&placed.shape);
      if (place == nullptr) continue;
      places.push_back(place);
      DrawnMesh& mesh = meshes[place->triangles.id()];
      mesh.finest = mesh.shown = place->triangles;
      ++mesh.num_places;
      longest_m = std::max(longest_m, LongestSide(mesh.finest));
    }
  }
  const auto count = [&](SharedMesh DrawnMesh::*which) {
    std::size_t sum = 0;
    for (const auto& [id, mesh] : meshes) {
      sum += mesh.num_places * (mesh.*which)->triangles.size();
    }
    return sum;
  };
  const double coarsest_m = longest_m / kLeastCells;
  double cell_m = 0;
  for (double next_m = 1e-3; count(&DrawnMesh::shown) > most_triangles && cell_m < coarsest_m;
       next_m *= 2) {
    cell_m = std::min(next_m, coarsest_m);
    for (auto& [id, mesh] : meshes) mesh.shown = Coarse(mesh.finest, cell_m);
  }
  if (cell_m == 0) return;
  for (Mesh* place : places) place->triangles = meshes.at(place->triangles.id()).shown;
  remarks->push_back(fmt::format(
      "The {}'s meshes are shown coarser than they are: {} triangles instead of {}, corners up to "
      "{} mm from their places.",
      whose, count(&DrawnMesh::shown), count(&DrawnMesh::finest),
      FormatNumber(1e3 * std::sqrt(3.0) * cell_m)));
}

}  // namespace planbench
