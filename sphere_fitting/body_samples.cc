#include "sphere_fitting/body_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sphere_fitting/thinned_points.h"

namespace planbench {
namespace {

using Eigen::Vector3d;
using Piece = std::array<Vector3d, 3>;

// Adds the corners of all pieces when the triangle is halved until no edge is longer than that.
void AddPieces(const Piece& triangle, double longest_m, ThinnedPoints* points) {
  std::vector<Piece> open = {triangle};
  while (!open.empty()) {
    const Piece piece = open.back();
    open.pop_back();
    std::size_t longest = 0;
    double length2 = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double edge2 = (piece[(k + 1) % 3] - piece[k]).squaredNorm();
      if (edge2 > length2) {
        longest = k;
        length2 = edge2;
      }
    }
    if (length2 <= longest_m * longest_m) {
      for (const Vector3d& corner : piece) points->Add(corner);
      continue;
    }
    const Vector3d& from = piece[longest];
    const Vector3d& to = piece[(longest + 1) % 3];
    const Vector3d& top = piece[(longest + 2) % 3];
    const Vector3d middle = (from + to) / 2;
    open.push_back({from, middle, top});
    open.push_back({middle, to, top});
  }
}

}  // namespace

BodySamples SampleBody(const LinkBody& body, int on_surface, int inside) {
  BodySamples samples;
  double area = 0;
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  for (const Solid* solid : body.hulls()) {
    const TriangleMesh& mesh = solid->mesh();
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vector3d& corner = mesh.vertices[a];
      area += (mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).norm() / 2;
      for (const std::uint32_t v : {a, b, c}) {
        low = low.cwiseMin(mesh.vertices[v]);
        high = high.cwiseMax(mesh.vertices[v]);
      }
    }
  }
  if (!(low.array() <= high.array()).all()) return samples;
  const double extent = (high - low).norm();
  // Slivers without area still need some, and points one.
  samples.spacing_m = std::max({std::sqrt(area / on_surface), 0.002 * extent, 1e-9});
  ThinnedPoints surface(samples.spacing_m);
  for (const Solid* solid : body.hulls()) {
    const TriangleMesh& mesh = solid->mesh();
    for (const auto& [a, b, c] : mesh.triangles) {
      AddPieces({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, samples.spacing_m,
                &surface);
    }
  }
  samples.surface = surface.points();

  const Vector3d size = (high - low).cwiseMax(1e-9);
  const double step = std::cbrt(size.prod() / inside);
  std::array<int, 3> n;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double fitting = std::ceil(size[static_cast<Eigen::Index>(axis)] / step);
    n[axis] = static_cast<int>(std::clamp(fitting, 1.0, static_cast<double>(inside)));
  }
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        const Vector3d share((i + 0.5) / n[0], (j + 0.5) / n[1], (k + 0.5) / n[2]);
        const Vector3d point = low + share.cwiseProduct(size);
        for (const Solid* solid : body.hulls()) {
          if (!solid->inside().Contains(point)) continue;
          samples.inside.push_back(point);
          break;
        }
      }
    }
  }
  return samples;
}

}  // namespace planbench
