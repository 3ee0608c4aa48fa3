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
#include "geometry/lexicographic_less.h"
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
constexpr double kLargestBall = 0.15;
/// Of a link, at most. Of one that needs more (a crane, or millimetres taken for metres) the three
/// lengths above are longer: the verdict is the same, at more cost.
constexpr std::size_t kMostCuts = 1 << 16;
/// Of a link, at most: the largest. Hulls tell more than ever smaller balls.
constexpr std::size_t kMostMiddles = 64;
/// Of the search for small balls.
constexpr int kNumSteps = 30;
/// How far a prism's corners may be outside of the cylinder that it stands for, m.
constexpr double kPrismError = 2e-5;
/// Of a prism: as many as a radius of 65 m needs; those of larger ones are further outside.
constexpr double kMostSides = 1 << 12;

TriangleMesh MeshOf(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return BoxMesh(box->size);
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return mesh->triangles;
  // There are no other shapes: in a URDF, and of what is attached see CompiledScene.
  const auto& cylinder = std::get<Cylinder>(shape);
  const double half_angle = std::acos(cylinder.radius / (cylinder.radius + kPrismError));
  const auto sides =
      static_cast<int>(std::clamp(std::ceil(std::numbers::pi / half_angle), 8.0, kMostSides));
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

/// Part of a triangle, or all of it.
struct Piece {
  Corners corners;
  std::size_t triangle;  ///< Index.
};

Vector3d Middle(const Piece& piece) {
  return (piece.corners[0] + piece.corners[1] + piece.corners[2]) / 3;
}

/// Sorts along the longest extent of what middle(item) gives so that the first `num` are first.
template <typename Item, typename MiddleOf>
void Split(std::span<Item> items, std::size_t num, MiddleOf middle) {
  Eigen::AlignedBox3d middles;
  for (const Item& item : items) middles.extend(Vector3d(middle(item)));
  int axis = 0;
  middles.sizes().maxCoeff(&axis);
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(num), items.end(),
                   [&](const Item& a, const Item& b) { return middle(a)[axis] < middle(b)[axis]; });
}

/// Around the leaves below some trees.
Ball BallAroundLeaves(const std::vector<BallTree>& trees) {
  std::vector<Ball> balls;
  for (const BallTree& tree : trees) {
    for (const Ball& leaf : tree.Leaves()) balls.push_back(leaf);
  }
  return EnclosingBall(balls, kNumSteps);
}

Ball BallAround(std::span<const Vector3d> points) {
  std::vector<Ball> balls;
  for (const Vector3d& point : points) balls.push_back({point, 0});
  return EnclosingBall(balls, kNumSteps);
}

std::vector<Vector3d> CornersOf(std::span<const Piece> pieces) {
  std::vector<Vector3d> corners;
  for (const Piece& piece : pieces) {
    corners.insert(corners.end(), piece.corners.begin(), piece.corners.end());
  }
  return corners;
}

/// Makes patches of the triangles of a link, whole ones by index.
class PatchMaker {
 public:
  PatchMaker(int link, const std::vector<Corners>& triangles, double largest_ball,
             std::vector<RobotMeshes::Patch>* patches)
      : link_(link), triangles_(triangles), largest_ball_(largest_ball), patches_(patches) {}

  BallTree MakeTree(std::span<Piece> pieces) {
    const std::vector<Vector3d> corners = CornersOf(pieces);
    const Ball ball = BallAround(corners);
    if (pieces.size() == 1 || (NumTriangles(pieces) <= kMost && ball.radius <= largest_ball_)) {
      AddPatch(pieces);
      return {ball, static_cast<int>(patches_->size()) - 1,
              MakeHull(corners, kernels::kMostPoints)};
    }
    const std::size_t half = pieces.size() / 2;
    Split(pieces, half, Middle);
    std::vector<BallTree> children;
    children.push_back(MakeTree(pieces.first(half)));
    children.push_back(MakeTree(pieces.subspan(half)));
    return {ball, std::move(children)};
  }

 private:
  static constexpr auto kGroup = static_cast<std::size_t>(kernels::kWide);
  static constexpr std::size_t kMost = kGroup * kGroup;  ///< Triangles of a patch.

  /// What a patch has of one triangle.
  struct Part {
    std::size_t triangle;
    std::vector<Vector3d> corners;
    Vector3d middle;
  };

  static std::size_t NumTriangles(std::span<const Piece> pieces) {
    std::vector<std::size_t> triangles;
    for (const Piece& piece : pieces) triangles.push_back(piece.triangle);
    std::sort(triangles.begin(), triangles.end());
    return static_cast<std::size_t>(std::unique(triangles.begin(), triangles.end()) -
                                    triangles.begin());
  }

  void AddPatch(std::span<Piece> pieces) {
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& a, const Piece& b) { return a.triangle < b.triangle; });
    std::vector<Part> parts;
    for (const Piece& piece : pieces) {
      if (parts.empty() || parts.back().triangle != piece.triangle) {
        parts.push_back({piece.triangle, {}, Vector3d::Zero()});
      }
      std::copy(piece.corners.begin(), piece.corners.end(),
                std::back_inserter(parts.back().corners));
    }
    for (Part& part : parts) part.middle = BallAround(part.corners).center;
    patches_->push_back({link_, {}, {}});
    AddGroups(parts);
  }

  /// All groups are full but the last.
  void AddGroups(std::span<Part> parts) {
    if (parts.size() > kGroup) {
      const std::size_t num_groups = (parts.size() + kGroup - 1) / kGroup;
      const std::size_t first = num_groups / 2 * kGroup;
      Split(parts, first, [](const Part& part) { return part.middle; });
      AddGroups(parts.first(first));
      AddGroups(parts.subspan(first));
      return;
    }
    RobotMeshes::Group& group = patches_->back().groups.emplace_back();
    std::vector<Vector3d> corners;
    for (const Part& part : parts) {
      group.triangles.push_back(triangles_[part.triangle]);
      corners.insert(corners.end(), part.corners.begin(), part.corners.end());
    }
    group.hull = MakeHull(corners, kernels::kMostPoints);
    group.corners = std::move(corners);
  }

  int link_;
  const std::vector<Corners>& triangles_;
  double largest_ball_;  // m
  std::vector<RobotMeshes::Patch>* patches_;
};

double Farthest(const Corners& triangle, const Vector3d& from) {
  double farthest = 0;
  for (const Vector3d& corner : triangle) farthest = std::max(farthest, (corner - from).norm());
  return farthest;
}

/// Cut across the longest extent of their middles.
std::array<std::vector<BallTree>, 2> Halves(std::vector<BallTree> trees) {
  Split(std::span(trees), trees.size() / 2,
        [](const BallTree& tree) { return tree.ball().center; });
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

/// A link's triangles in pieces, of each middle those that its ball is to enclose.
struct Pieces {
  std::vector<std::vector<Piece>> of_middles;  ///< One list without middles.
  double coarseness = 1;  ///< The lengths that they are cut to are so much longer.
  std::size_t num_cuts = 0;
};

Pieces CutTriangles(const std::vector<Corners>& triangles, const std::vector<Ball>& middles,
                    double coarseness) {
  Pieces pieces;
  pieces.coarseness = coarseness;
  pieces.of_middles.resize(std::max<std::size_t>(1, middles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Cut(triangles[i], [&](const Corners& piece, double longest) {
      std::size_t best = 0;
      bool is_large = middles.empty() && longest > coarseness * kLongestEdge;
      if (!middles.empty()) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t m = 0; m < middles.size(); ++m) {
          if ((piece[0] - middles[m].center).norm() - middles[m].radius >= least) continue;
          const double beyond = Farthest(piece, middles[m].center) - middles[m].radius;
          if (beyond >= least) continue;
          least = beyond;
          best = m;
        }
        is_large = least > 0 && longest > coarseness * kShortestCut;
      }
      if (is_large && pieces.num_cuts < kMostCuts) {
        ++pieces.num_cuts;
        return false;
      }
      pieces.of_middles[best].push_back({piece, i});
      return true;
    });
  }
  return pieces;
}

/// Trees of patches of a link's triangles under balls about the middles, or one tree without any.
void AddTrees(const std::vector<Corners>& triangles, const std::vector<Ball>& middles, int link,
              std::vector<RobotMeshes::Patch>* patches, std::vector<BallTree>* trees) {
  Pieces pieces = CutTriangles(triangles, middles, 1);
  while (pieces.num_cuts == kMostCuts) {
    pieces = CutTriangles(triangles, middles, 2 * pieces.coarseness);
  }
  std::vector<std::vector<Piece>>& parts = pieces.of_middles;
  PatchMaker maker(link, triangles, pieces.coarseness * kLargestBall, patches);
  for (std::size_t m = 0; m < parts.size(); ++m) {
    if (parts[m].empty()) continue;
    BallTree tree = maker.MakeTree(parts[m]);
    if (!middles.empty()) {
      Ball ball{middles[m].center, 0};
      for (const Piece& piece : parts[m]) {
        ball.radius = std::max(ball.radius, Farthest(piece.corners, ball.center));
      }
      tree.Replace(ball);
    }
    trees->push_back(std::move(tree));
  }
}

/// Gives each point to a patch that has a triangle with such a corner.
void AddPoints(std::vector<Vector3d> points, std::span<RobotMeshes::Patch> patches) {
  std::sort(points.begin(), points.end(), LexicographicLess);
  std::vector<bool> given(points.size(), false);
  for (RobotMeshes::Patch& patch : patches) {
    for (const RobotMeshes::Group& group : patch.groups) {
      for (const Corners& triangle : group.triangles) {
        for (const Vector3d& corner : triangle) {
          const auto found =
              std::lower_bound(points.begin(), points.end(), corner, LexicographicLess);
          if (found == points.end() || *found != corner) continue;
          const auto i = static_cast<std::size_t>(found - points.begin());
          if (!given[i]) patch.points.push_back(corner);
          given[i] = true;
        }
      }
    }
  }
}

}  // namespace

RobotMeshes::RobotMeshes(const std::vector<LinkGeometry>& geometry,
                         const std::vector<LinkSphere>& middles) {
  for (const LinkGeometry& link : geometry) {
    std::vector<Ball> of_link;
    for (const LinkSphere& sphere : middles) {
      if (sphere.link == link.link) of_link.push_back({sphere.p_LS, sphere.radius});
    }
    if (of_link.size() > kMostMiddles) {
      std::stable_sort(of_link.begin(), of_link.end(),
                       [](const Ball& a, const Ball& b) { return a.radius > b.radius; });
      of_link.resize(kMostMiddles);
    }
    Add(link, of_link);
  }
}

RobotMeshes::RobotMeshes(const LinkGeometry& geometry, const std::vector<Ball>& middles) {
  Add(geometry, middles);
}

void RobotMeshes::Add(const LinkGeometry& link, const std::vector<Ball>& middles) {
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
    const std::size_t first_patch = patches.size();
    AddTrees(triangles, middles, link.link, &patches, &trees);
    AddPoints(points, std::span(patches).subspan(first_patch));
  }
  if (!spheres.empty()) trees.emplace_back(std::move(spheres));
  BallTree tree = Join(std::move(trees));
  tree.SetHulls(kernels::kMostPoints);
  tree.SetInner([&](const Vector3d& point) {
    double depth = 0;
    for (std::size_t i = 0; i < closed.size(); ++i) {
      if (!closed[i].mesh->Contains(point)) continue;
      depth = std::max(depth, surfaces[i].Distance(point));
    }
    return depth;
  });
  links.push_back({link.link, std::move(tree), std::move(closed), std::move(points),
                   MeshSurface(std::move(triangles))});
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
