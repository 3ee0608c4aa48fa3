#include "collision/simd/robot_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <variant>

#include "collision/balls.h"
#include "collision/simd/kernels/sphere_kernel.h"
#include "geometry/mesh_surface.h"
#include "geometry/polyhedra.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

/// Longer edges are cut, m: the smaller triangles are, the closer balls are around them.
constexpr double kLongestEdge = 0.1;
/// Triangles that are in no ball are cut as long as they have a longer edge than this, m.
constexpr double kShortestCut = 0.02;
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

/// Halves a triangle across its longest edge, and its halves, until each is small enough for
/// `take(piece, longest edge)` to take it.
template <typename Take>
void Cut(const Corners& triangle, Take take) {
  std::vector<Corners> open = {triangle};
  while (!open.empty()) {
    const Corners corners = open.back();
    open.pop_back();
    std::size_t longest = 0;
    const auto length = [&](std::size_t k) { return (corners[(k + 1) % 3] - corners[k]).norm(); };
    for (std::size_t k = 1; k < 3; ++k) {
      if (length(k) > length(longest)) longest = k;
    }
    if (take(corners, length(longest))) continue;
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

/// Around the leaves below some trees.
Ball BallAroundLeaves(const std::vector<BallTree>& trees) {
  std::vector<Ball> balls;
  for (const BallTree& tree : trees) {
    for (const Ball& leaf : tree.Leaves()) balls.push_back(leaf);
  }
  return EnclosingBall(balls, kNumSteps);
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
  return {BallAround(triangles), std::move(children)};
}

double Farthest(const Corners& triangle, const Vector3d& from) {
  double farthest = 0;
  for (const Vector3d& corner : triangle) farthest = std::max(farthest, (corner - from).norm());
  return farthest;
}

/// Cut across the longest extent of their middles.
std::array<std::vector<BallTree>, 2> Halves(std::vector<BallTree> trees) {
  Vector3d low = trees.front().ball().center;
  Vector3d high = low;
  for (const BallTree& tree : trees) {
    low = low.cwiseMin(tree.ball().center);
    high = high.cwiseMax(tree.ball().center);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::stable_sort(trees.begin(), trees.end(), [axis](const BallTree& a, const BallTree& b) {
    return a.ball().center[axis] < b.ball().center[axis];
  });
  const auto middle = trees.begin() + static_cast<std::ptrdiff_t>(trees.size() / 2);
  return {std::vector<BallTree>(trees.begin(), middle), std::vector<BallTree>(middle, trees.end())};
}

/// Joins trees under balls, up to four a ball: always the group with the largest ball is halved.
BallTree Join(std::vector<BallTree> trees) {
  if (trees.size() == 1) return std::move(trees.front());
  constexpr std::size_t kMaxChildren = 4;
  std::vector<std::vector<BallTree>> groups = {std::move(trees)};
  std::vector<double> radii = {0};  // of groups of one: less than any
  while (groups.size() < kMaxChildren) {
    const auto largest =
        static_cast<std::size_t>(std::max_element(radii.begin(), radii.end()) - radii.begin());
    if (groups[largest].size() == 1) break;
    auto halves = Halves(std::move(groups[largest]));
    const auto radius = [](const std::vector<BallTree>& group) {
      return group.size() == 1 ? -1.0 : BallAroundLeaves(group).radius;
    };
    radii[largest] = radius(halves[0]);
    radii.push_back(radius(halves[1]));
    groups[largest] = std::move(halves[0]);
    groups.push_back(std::move(halves[1]));
  }
  std::vector<BallTree> children;
  for (std::vector<BallTree>& group : groups) children.push_back(Join(std::move(group)));
  return BallTree(std::move(children), kNumSteps);
}

/// Trees of triangles of a link under balls about the middles, or one tree without any.
void AddTrees(const std::vector<Corners>& triangles, const std::vector<Ball>& middles, int link,
              std::vector<RobotMeshes::Cluster>* clusters, std::vector<BallTree>* trees) {
  if (middles.empty()) {
    std::vector<Corners> pieces;
    for (const Corners& triangle : triangles) {
      Cut(triangle, [&](const Corners& piece, double longest) {
        if (longest > kLongestEdge) return false;
        pieces.push_back(piece);
        return true;
      });
    }
    trees->push_back(MakeTree(pieces, link, clusters));
    return;
  }
  std::vector<std::vector<Corners>> parts(middles.size());
  for (const Corners& triangle : triangles) {
    Cut(triangle, [&](const Corners& piece, double longest) {
      std::size_t best = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < middles.size(); ++i) {
        if ((piece[0] - middles[i].center).norm() - middles[i].radius >= least) continue;
        const double beyond = Farthest(piece, middles[i].center) - middles[i].radius;
        if (beyond >= least) continue;
        least = beyond;
        best = i;
      }
      if (least > 0 && longest > kShortestCut) return false;
      parts[best].push_back(piece);
      return true;
    });
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) continue;
    Ball ball{middles[i].center, 0};
    for (const Corners& piece : parts[i]) {
      ball.radius = std::max(ball.radius, Farthest(piece, ball.center));
    }
    BallTree tree = MakeTree(parts[i], link, clusters);
    if (tree.cluster() < 0) {
      trees->push_back({ball, tree.children()});
    } else {
      if (tree.ball().radius < ball.radius) ball = tree.ball();
      trees->push_back({ball, tree.cluster()});
    }
  }
}

}  // namespace

RobotMeshes::RobotMeshes(const std::vector<LinkGeometry>& geometry,
                         const std::vector<LinkSphere>& middles) {
  for (const LinkGeometry& link : geometry) {
    std::vector<BallTree> trees;
    std::vector<Corners> triangles;
    std::vector<Ball> spheres;
    std::vector<LinkMeshes::Closed> closed;
    std::vector<MeshSurface> surfaces;  // of these
    std::vector<Vector3d> points;
    for (const PlacedShape& placed : link.shapes) {
      if (const auto* sphere = std::get_if<Sphere>(&placed.shape)) {
        spheres.push_back({placed.X_FS.translation(), sphere->radius});
        points.push_back(spheres.back().center);
        continue;
      }
      TriangleMesh mesh = MeshOf(placed.shape);
      for (Vector3d& vertex : mesh.vertices) vertex = placed.X_FS * vertex;
      for (const auto& [a, b, c] : mesh.triangles) {
        triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
      }
      auto solid = std::make_shared<const SolidMesh>(mesh);
      std::copy(solid->component_points().begin(), solid->component_points().end(),
                std::back_inserter(points));
      if (!solid->has_inside()) continue;
      surfaces.emplace_back(mesh);
      closed.push_back({std::move(solid), std::move(mesh.vertices)});
    }
    if (!triangles.empty()) {
      std::vector<Ball> of_link;
      for (const LinkSphere& sphere : middles) {
        if (sphere.link == link.link) of_link.push_back({sphere.p_LS, sphere.radius});
      }
      AddTrees(triangles, of_link, link.link, &clusters, &trees);
    }
    if (!spheres.empty()) trees.emplace_back(std::move(spheres));
    BallTree tree = Join(std::move(trees));
    tree.SetInner([&](const Vector3d& point) {
      double depth = 0;
      for (std::size_t i = 0; i < closed.size(); ++i) {
        if (!closed[i].mesh->Contains(point)) continue;
        depth = std::max(depth, surfaces[i].Distance(point));
      }
      return depth;
    });
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
