#include "geometry/mesh_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace planbench {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kTrianglesOfALeaf = 4;

double SquaredDistanceToSegment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d edge = b - a;
  const double length2 = edge.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
  return (a + t * edge - p).squaredNorm();
}

double SquaredDistanceToTriangle(const Vector3d& p, const Corners& corners) {
  // The normal of less than that is rounding; no point of the face is then that far from an edge.
  constexpr double kLeastSine = 1e-9;
  const auto& [a, b, c] = corners;
  const Vector3d normal = (b - a).cross(c - a);
  const double normal2 = normal.squaredNorm();
  const double least2 = kLeastSine * kLeastSine * (b - a).squaredNorm() * (c - a).squaredNorm();
  const bool above = normal2 > least2 && normal.cross(b - a).dot(p - a) >= 0 &&
                     normal.cross(c - b).dot(p - b) >= 0 && normal.cross(a - c).dot(p - c) >= 0;
  if (above) {
    const double height = normal.dot(p - a);
    return height * height / normal2;
  }
  return std::min({SquaredDistanceToSegment(p, a, b), SquaredDistanceToSegment(p, b, c),
                   SquaredDistanceToSegment(p, c, a)});
}

double SquaredDistanceToBox(const Vector3d& p, const Vector3d& low, const Vector3d& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0).squaredNorm();
}

std::vector<Corners> TrianglesOf(const TriangleMesh& mesh) {
  std::vector<Corners> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  }
  return triangles;
}

}  // namespace

MeshSurface::MeshSurface(const TriangleMesh& mesh) : MeshSurface(TrianglesOf(mesh)) {}

MeshSurface::MeshSurface(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
  if (!triangles_.empty()) Build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void MeshSurface::Build(std::uint32_t begin, std::uint32_t end) {
  Node node;
  node.begin = begin;
  node.end = end;
  node.low = node.high = triangles_[begin][0];
  Vector3d middle_low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d middle_high = -middle_low;
  for (std::uint32_t t = begin; t < end; ++t) {
    const Corners& corners = triangles_[t];
    for (const Vector3d& corner : corners) {
      node.low = node.low.cwiseMin(corner);
      node.high = node.high.cwiseMax(corner);
    }
    const Vector3d middle = corners[0] + corners[1] + corners[2];
    middle_low = middle_low.cwiseMin(middle);
    middle_high = middle_high.cwiseMax(middle);
  }
  const std::size_t index = nodes_.size();
  nodes_.push_back(node);
  if (end - begin <= kTrianglesOfALeaf) return;
  Eigen::Index axis = 0;
  (middle_high - middle_low).maxCoeff(&axis);
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + half, triangles_.begin() + end,
                   [axis](const Corners& a, const Corners& b) {
                     return a[0][axis] + a[1][axis] + a[2][axis] <
                            b[0][axis] + b[1][axis] + b[2][axis];
                   });
  Build(begin, half);
  nodes_[index].second = static_cast<std::uint32_t>(nodes_.size());
  Build(half, end);
}

double MeshSurface::Distance(const Vector3d& point, double at_most) const {
  return std::sqrt(Least(
      at_most * at_most,
      [&](const Vector3d& low, const Vector3d& high, double) {
        return SquaredDistanceToBox(point, low, high);
      },
      [&](const Corners& corners, double) { return SquaredDistanceToTriangle(point, corners); }));
}

double MeshSurface::Distance(const Segment& segment, double at_most) const {
  return Least(
      at_most,
      [&](const Vector3d& low, const Vector3d& high, double best) {
        return LeastOnSegment(segment, best, [&](const Vector3d& p) {
          return std::sqrt(SquaredDistanceToBox(p, low, high));
        });
      },
      [&](const Corners& corners, double best) {
        return LeastOnSegment(segment, best, [&](const Vector3d& p) {
          return std::sqrt(SquaredDistanceToTriangle(p, corners));
        });
      });
}

}  // namespace planbench
