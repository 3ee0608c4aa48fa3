#include "collision/simd/robot_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <span>
#include <utility>
#include <variant>

#include "collision/balls.h"
#include "collision/simd/kernels/sphere_kernel.h"
#include "geometry/polyhedra.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

/// Longer edges are cut, m: the smaller triangles are, the closer balls are around them.
constexpr double kLongestEdge = 0.1;
/// A ball around more than one triangle is no larger, m.
constexpr double kLargestBall = 0.06;
/// Of the search for small balls.
constexpr int kNumSteps = 30;
/// How far a prism's corners may be outside of the cylinder that it stands for, m.
constexpr double kPrismError = 2e-5;

TriangleMesh MeshOf(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return BoxMesh(box->size);
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return mesh->triangles;
  // A URDF has no other shapes.
  const auto& cylinder = std::get<Cylinder>(shape);
  const double half_angle = std::acos(cylinder.radius / (cylinder.radius + kPrismError));
  const int sides = std::max(8, static_cast<int>(std::ceil(std::numbers::pi / half_angle)));
  return PrismMesh(cylinder.radius / std::cos(std::numbers::pi / sides), cylinder.length, sides);
}

/// Halves triangles, across their longest edge, until none has an edge longer than kLongestEdge.
void AddCut(const Corners& triangle, std::vector<Corners>* triangles) {
  std::vector<Corners> open = {triangle};
  while (!open.empty()) {
    const Corners corners = open.back();
    open.pop_back();
    std::size_t longest = 0;
    const auto squared = [&](std::size_t k) {
      return (corners[(k + 1) % 3] - corners[k]).squaredNorm();
    };
    for (std::size_t k = 1; k < 3; ++k) {
      if (squared(k) > squared(longest)) longest = k;
    }
    if (squared(longest) <= kLongestEdge * kLongestEdge) {
      triangles->push_back(corners);
      continue;
    }
    const Vector3d middle = (corners[longest] + corners[(longest + 1) % 3]) / 2;
    const Vector3d& apex = corners[(longest + 2) % 3];
    open.push_back({corners[longest], middle, apex});
    open.push_back({middle, corners[(longest + 1) % 3], apex});
  }
}

Vector3d Middle(const Corners& triangle) { return (triangle[0] + triangle[1] + triangle[2]) / 3; }

/// Sorts triangles along the longest extent of their middles; returns their first half.
std::span<Corners> FirstHalf(std::span<Corners> triangles) {
  Vector3d low = Middle(triangles.front());
  Vector3d high = low;
  for (const Corners& triangle : triangles) {
    low = low.cwiseMin(Middle(triangle));
    high = high.cwiseMax(Middle(triangle));
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::stable_sort(triangles.begin(), triangles.end(), [axis](const Corners& a, const Corners& b) {
    return Middle(a)[axis] < Middle(b)[axis];
  });
  return triangles.first(triangles.size() / 2);
}

Ball BallAround(std::span<const Corners> triangles) {
  std::vector<Ball> corners;
  for (const Corners& triangle : triangles) {
    for (const Vector3d& corner : triangle) corners.push_back({corner, 0});
  }
  return EnclosingBall(corners, kNumSteps);
}

bool IsCluster(std::span<const Corners> triangles, const Ball& ball) {
  constexpr auto kMost = static_cast<std::size_t>(kernels::kWide);
  return triangles.size() == 1 || (triangles.size() <= kMost && ball.radius <= kLargestBall);
}

BallTree MakeTree(std::span<Corners> triangles, int link,
                  std::vector<RobotMeshes::Cluster>* clusters) {
  if (triangles.size() <= static_cast<std::size_t>(kernels::kWide)) {
    const Ball ball = BallAround(triangles);
    if (IsCluster(triangles, ball)) {
      clusters->push_back({link, {triangles.begin(), triangles.end()}});
      return {ball, static_cast<int>(clusters->size()) - 1};
    }
  }
  std::vector<BallTree> children;
  const std::span<Corners> first = FirstHalf(triangles);
  for (const std::span<Corners> half : {first, triangles.subspan(first.size())}) {
    if (half.size() <= static_cast<std::size_t>(kernels::kWide) &&
        IsCluster(half, BallAround(half))) {
      children.push_back(MakeTree(half, link, clusters));
      continue;
    }
    const std::span<Corners> quarter = FirstHalf(half);
    children.push_back(MakeTree(quarter, link, clusters));
    children.push_back(MakeTree(half.subspan(quarter.size()), link, clusters));
  }
  return BallTree(std::move(children), kNumSteps);
}

}  // namespace

RobotMeshes::RobotMeshes(const std::vector<LinkGeometry>& geometry) {
  for (const LinkGeometry& link : geometry) {
    std::vector<BallTree> trees;
    std::vector<Ball> spheres;
    std::vector<LinkMeshes::Closed> closed;
    std::vector<Vector3d> points;
    for (const PlacedShape& placed : link.shapes) {
      if (const auto* sphere = std::get_if<Sphere>(&placed.shape)) {
        spheres.push_back({placed.X_FS.translation(), sphere->radius});
        points.push_back(spheres.back().center);
        continue;
      }
      TriangleMesh mesh = MeshOf(placed.shape);
      for (Vector3d& vertex : mesh.vertices) vertex = placed.X_FS * vertex;
      std::vector<Corners> triangles;
      for (const auto& [a, b, c] : mesh.triangles) {
        AddCut({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, &triangles);
      }
      trees.push_back(MakeTree(triangles, link.link, &clusters));
      auto solid = std::make_shared<const SolidMesh>(mesh);
      std::copy(solid->component_points().begin(), solid->component_points().end(),
                std::back_inserter(points));
      if (solid->has_inside()) closed.push_back({std::move(solid), std::move(mesh.vertices)});
    }
    if (!spheres.empty()) trees.emplace_back(std::move(spheres));
    BallTree tree = trees.size() == 1 ? std::move(trees.front()) : BallTree(std::move(trees));
    links.push_back({link.link, std::move(tree), std::move(closed), std::move(points)});
  }
}

namespace kernels {

bool Encloses(const Inside& inside, const float* p) {
  Vector3d point = Vector3d::Map(inside.position);
  for (int row = 0; row < 3; ++row) {
    for (int c = 0; c < 3; ++c) point[row] += inside.rotation[3 * row + c] * p[c];
  }
  return inside.mesh->Contains(point);
}

}  // namespace kernels
}  // namespace planbench
