#include "collision/voxels/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "collision/object_cover.h"
#include "collision/shape_check.h"
#include "common/numbers.h"
#include "geometry/solid_mesh.h"

namespace planbench {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Solids that are less apart touch, m. Above the rounding of coordinates, so that a board that
/// ends where a cell begins meets that cell whatever its pose was computed from.
constexpr double kTouching = 1e-9;
/// Sine of the tilt below which a solid counts as upright.
constexpr double kUpright = 1e-12;

/// Around a box given in S, in W.
AlignedBox3d Around(const AlignedBox3d& box, const Isometry3d& X_WS) {
  const Vector3d center = X_WS * box.center();
  const Vector3d half = X_WS.linear().cwiseAbs() * box.sizes() / 2;
  return {center - half, center + half};
}

Vector2d NearestOnSegment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double squared = along.squaredNorm();
  return squared > 0 ? a + std::clamp((p - a).dot(along) / squared, 0.0, 1.0) * along : a;
}

/// Point of a solid nearest to p, in the solid's frame; p itself if it is inside.
Vector3d NearestPoint(const Cylinder& cylinder, const Vector3d& p) {
  Vector3d nearest = p;
  const double rho = p.head<2>().norm();
  if (rho > cylinder.radius) nearest.head<2>() *= cylinder.radius / rho;
  nearest.z() = std::clamp(p.z(), -cylinder.length / 2, cylinder.length / 2);
  return nearest;
}

Vector3d NearestPoint(const Cone& cone, const Vector3d& p) {
  // In the half-plane through the axis the cone is the triangle of apex, rim and centre of the
  // base.
  const Vector2d apex(0, cone.length / 2);
  const Vector2d rim(cone.radius, -cone.length / 2);
  const Vector2d base(0, -cone.length / 2);
  const Vector2d q(p.head<2>().norm(), p.z());
  const Vector2d side = rim - apex;
  if (q.y() >= base.y() && side.x() * (q.y() - apex.y()) - side.y() * (q.x() - apex.x()) <= 0) {
    return p;
  }
  const Vector2d on_side = NearestOnSegment(q, apex, rim);
  const Vector2d on_base = NearestOnSegment(q, base, rim);
  const Vector2d nearest =
      (q - on_side).squaredNorm() < (q - on_base).squaredNorm() ? on_side : on_base;
  const double scale = q.x() > 0 ? nearest.x() / q.x() : 0;
  return {p.x() * scale, p.y() * scale, nearest.y()};
}

Vector3d NearestPoint(const Capsule& capsule, const Vector3d& p) {
  const Vector3d on_axis(0, 0, std::clamp(p.z(), -capsule.length / 2, capsule.length / 2));
  const double distance = (p - on_axis).norm();
  return distance <= capsule.radius ? p
                                    : Vector3d(on_axis + capsule.radius / distance * (p - on_axis));
}

/// A convex shape with a NearestPoint.
template <typename S>
struct Posed {
  S shape;
  Isometry3d X_WS;
  Isometry3d X_SW;

  Posed(const S& shape_in, const Isometry3d& pose)
      : shape(shape_in), X_WS(pose), X_SW(pose.inverse()) {}
};

/// Alternating projections (von Neumann; Cheney and Goldstein, "Proximity maps for convex sets",
/// Proc. AMS 1959) tell most cases apart in a few steps: they end where a point is found in both,
/// or where the plane across the last step, behind which the solid lies, has the box before it.
/// They creep where surfaces graze: there the box is halved, down to edges of `finest` at which the
/// two count as touching (of a surface of curvature radius r, up to about finest^2 / r apart).
template <typename S>
bool TouchesDownTo(const Posed<S>& solid, const AlignedBox3d& box, double finest) {
  constexpr int kMaxSteps = 8;
  Vector3d p = box.center();
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vector3d in_solid = solid.X_WS * NearestPoint(solid.shape, solid.X_SW * p);
    const Vector3d in_box = in_solid.cwiseMax(box.min()).cwiseMin(box.max());
    if ((in_box - in_solid).squaredNorm() <= kTouching * kTouching) return true;
    const Vector3d normal = p - in_solid;
    const Vector3d lowest = (normal.array() > 0).select(box.min(), box.max());
    if (normal.dot(lowest - in_solid) > kTouching * normal.norm()) return false;
    p = in_box;
  }
  int longest = 0;
  if (box.sizes().maxCoeff(&longest) <= finest) return true;
  AlignedBox3d low = box;
  AlignedBox3d high = box;
  low.max()[longest] = high.min()[longest] = box.center()[longest];
  const bool low_first = p[longest] < box.center()[longest];
  return TouchesDownTo(solid, low_first ? low : high, finest) ||
         TouchesDownTo(solid, low_first ? high : low, finest);
}

template <typename S>
bool Touches(const Posed<S>& solid, const AlignedBox3d& box) {
  return TouchesDownTo(solid, box, box.sizes().minCoeff() / 32);
}

struct PosedSphere {
  Vector3d center;
  double radius;

  PosedSphere(const Sphere& sphere, const Isometry3d& X_WS)
      : center(X_WS.translation()), radius(sphere.radius) {}
};

bool Touches(const PosedSphere& sphere, const AlignedBox3d& box) {
  const double reach = sphere.radius + kTouching;
  return box.squaredExteriorDistance(sphere.center) <= reach * reach;
}

struct PosedBox {
  Vector3d center;
  Vector3d half_size;
  Eigen::Matrix3d R_WS;
  Eigen::Matrix3d absolute;  // of R_WS

  PosedBox(const Box& box, const Isometry3d& X_WS)
      : center(X_WS.translation()),
        half_size(box.size / 2),
        R_WS(X_WS.linear()),
        absolute(R_WS.cwiseAbs()) {}
};

/// By separating axes (Gottschalk, Lin and Manocha, "OBBTree", SIGGRAPH 1996).
bool Touches(const PosedBox& box, const AlignedBox3d& other) {
  const Vector3d half = ((other.max() - other.min()).array() / 2 + kTouching).matrix();
  const Vector3d apart = box.center - (other.min() + other.max()) / 2;
  if (((apart.cwiseAbs() - half - box.absolute * box.half_size).array() > 0).any()) return false;
  const Vector3d turned = box.R_WS.transpose() * apart;
  if (((turned.cwiseAbs() - box.half_size - box.absolute.transpose() * half).array() > 0).any()) {
    return false;
  }
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      // Along the cross product of axis i of W and axis j of the box.
      const double reach = half[i1] * box.absolute(i2, j) + half[i2] * box.absolute(i1, j) +
                           box.half_size[j1] * box.absolute(i, j2) +
                           box.half_size[j2] * box.absolute(i, j1);
      const double distance = apart[i2] * box.R_WS(i1, j) - apart[i1] * box.R_WS(i2, j);
      if (std::abs(distance) > reach + kTouching) return false;
    }
  }
  return true;
}

/// Whether horizontal planes cut the same out of a solid, wherever they cut it.
template <typename Solid>
bool IsUpright(const Solid& /*solid*/) {
  return false;
}
bool IsUpright(const PosedBox& box) {
  const auto row = box.absolute.row(2);
  return row.sum() - row.maxCoeff() < kUpright;
}
bool IsUpright(const Posed<Cylinder>& cylinder) {
  return cylinder.X_WS.linear().col(2).head<2>().norm() < kUpright;
}

struct PosedHalfSpace {
  Vector3d normal;
  double offset;  // normal . p of the points of the plane

  PosedHalfSpace(const HalfSpace&, const Isometry3d& X_WS)
      : normal(X_WS.linear().col(2)), offset(normal.dot(X_WS.translation())) {}
};

bool Touches(const PosedHalfSpace& half_space, const AlignedBox3d& box) {
  const Vector3d lowest = (half_space.normal.array() > 0).select(box.min(), box.max());
  return half_space.normal.dot(lowest) <= half_space.offset + kTouching;
}

// Whether a point is in a solid.

bool Contains(const PosedSphere& sphere, const Vector3d& p) {
  return (p - sphere.center).squaredNorm() < sphere.radius * sphere.radius;
}

bool Contains(const PosedBox& box, const Vector3d& p) {
  const Vector3d p_B = box.R_WS.transpose() * (p - box.center);
  return (p_B.cwiseAbs().array() < box.half_size.array()).all();
}

bool Contains(const PosedHalfSpace& half_space, const Vector3d& p) {
  return half_space.normal.dot(p) < half_space.offset;
}

template <typename S>
bool Contains(const Posed<S>& solid, const Vector3d& p) {
  const Vector3d p_S = solid.X_SW * p;
  return NearestPoint(solid.shape, p_S) == p_S;
}

/// Whether a convex solid holds all of a box.
template <typename Solid>
bool Holds(const Solid& solid, const AlignedBox3d& box) {
  for (int i = 0; i < 8; ++i) {
    if (!Contains(solid, box.corner(static_cast<AlignedBox3d::CornerType>(i)))) return false;
  }
  return true;
}

struct Triangle {
  Vector3d a, b, c;
};

bool Contains(const Triangle& /*triangle*/, const Vector3d& /*p*/) { return false; }

/// By separating axes.
bool Touches(const Triangle& triangle, const AlignedBox3d& box) {
  const Vector3d half = (box.sizes().array() / 2 + kTouching).matrix();
  const Vector3d a = triangle.a - box.center();
  const Vector3d b = triangle.b - box.center();
  const Vector3d c = triangle.c - box.center();
  const auto separates = [&](const Vector3d& axis) {
    const auto [low, high] = std::minmax({axis.dot(a), axis.dot(b), axis.dot(c)});
    const double reach = half.dot(axis.cwiseAbs());
    return low > reach || high < -reach;
  };
  for (int i = 0; i < 3; ++i) {
    if (separates(Vector3d::Unit(i))) return false;
  }
  if (separates((b - a).cross(c - a))) return false;
  for (const Vector3d& edge : {Vector3d(b - a), Vector3d(c - b), Vector3d(a - c)}) {
    for (int i = 0; i < 3; ++i) {
      if (separates(edge.cross(Vector3d::Unit(i)))) return false;
    }
  }
  return true;
}

template <typename S>
struct SolidOf {
  using Type = Posed<S>;
};
template <>
struct SolidOf<Box> {
  using Type = PosedBox;
};
template <>
struct SolidOf<Sphere> {
  using Type = PosedSphere;
};
template <>
struct SolidOf<HalfSpace> {
  using Type = PosedHalfSpace;
};

}  // namespace

VoxelGrid::VoxelGrid(const VoxelSettings& settings)
    : origin_(settings.lower),
      resolution_(settings.resolution_m),
      hollow_(settings.hollow),
      size_(NumVoxels(settings)),
      cells_(Index(0, 0, size_[2])) {}

void VoxelGrid::Clear() { std::fill(cells_.begin(), cells_.end(), std::uint8_t{0}); }

VoxelGrid::Range VoxelGrid::CellsAround(const AlignedBox3d& box) const {
  Range range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double from = (box.min()[a] - kTouching - origin_[a]) / resolution_;
    const double to = (box.max()[a] + kTouching - origin_[a]) / resolution_;
    const double end = size_[axis];
    range.first[axis] = static_cast<int>(std::clamp(std::floor(from) - 1, 0.0, end));
    range.last[axis] = static_cast<int>(std::clamp(std::floor(to) + 1, -1.0, end - 1));
  }
  return range;
}

AlignedBox3d VoxelGrid::BoxOf(int first, int last, int j, int k) const {
  return {origin_ + resolution_ * Vector3d(first, j, k),
          origin_ + resolution_ * Vector3d(last + 1, j + 1, k + 1)};
}

// The cells of a row that a convex solid meets stand together: both ends are found by bisection. Of
// an upright one they are the same in all planes that it meets.
template <typename Solid>
void VoxelGrid::MarkConvex(const Solid& solid, const AlignedBox3d& around) {
  const Range range = CellsAround(around);
  const int left = range.first[0];
  const int right = range.last[0];
  if (left > right) return;
  const bool is_upright = IsUpright(solid);
  for (int j = range.first[1]; j <= range.last[1]; ++j) {
    std::optional<Cells> known;  // of an upright one
    for (int k = range.first[2]; k <= range.last[2]; ++k) {
      Cells cells = known.value_or(Cells{left, right});
      if (!Touches(solid, BoxOf(cells.first, cells.last, j, k))) continue;
      if (!known) {
        cells = CellsMet(solid, j, k, cells);
        if (is_upright) known = cells;
      }
      for (int i = cells.first; i <= cells.last; ++i) {
        if (!hollow_ || !Holds(solid, BoxOf(i, i, j, k))) cells_[Index(i, j, k)] = 1;
      }
    }
  }
}

// Those cells of a row that a convex solid meets, of some of which it meets one.
template <typename Solid>
VoxelGrid::Cells VoxelGrid::CellsMet(const Solid& solid, int j, int k, const Cells& of) const {
  int first = of.first;  // the first cell met is among [first, beyond]
  for (int beyond = of.last; first < beyond;) {
    const int middle = (first + beyond) / 2;
    if (Touches(solid, BoxOf(first, middle, j, k))) {
      beyond = middle;
    } else {
      first = middle + 1;
    }
  }
  int last = of.last;
  for (int before = first; before < last;) {
    const int middle = (before + last + 1) / 2;
    if (Touches(solid, BoxOf(middle, last, j, k))) {
      before = middle;
    } else {
      last = middle - 1;
    }
  }
  return {first, last};
}

void VoxelGrid::MarkMesh(const TriangleMesh& mesh, const Isometry3d& X_WS) {
  AlignedBox3d all;
  for (const auto& t : mesh.triangles) {
    const Triangle triangle{X_WS * mesh.vertices[t[0]], X_WS * mesh.vertices[t[1]],
                            X_WS * mesh.vertices[t[2]]};
    AlignedBox3d around(triangle.a);
    around.extend(triangle.b).extend(triangle.c);
    MarkConvex(triangle, around);
    all.extend(around);
  }
  if (hollow_) return;
  const SolidMesh solid(mesh);
  if (!solid.has_inside()) return;
  const Isometry3d X_SW = X_WS.inverse();
  const Range range = CellsAround(all);
  for (int k = range.first[2]; k <= range.last[2]; ++k) {
    for (int j = range.first[1]; j <= range.last[1]; ++j) {
      // From a cell without surface to the next no surface is crossed: both are in or out.
      bool known = false;
      bool inside = false;
      for (int i = range.first[0]; i <= range.last[0]; ++i) {
        std::uint8_t& cell = cells_[Index(i, j, k)];
        if (cell != 0) {
          known = false;
          continue;
        }
        if (!known) inside = solid.Contains(X_SW * Center(i, j, k));
        known = true;
        if (inside) cell = 1;
      }
    }
  }
}

void VoxelGrid::Mark(const Shape& shape, const Isometry3d& X_WS) {
  std::visit(
      [&](const auto& s) {
        using S = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<S, Mesh>) {
          MarkMesh(s.triangles, X_WS);
        } else {
          AlignedBox3d around(Vector3d::Constant(-kInfinity), Vector3d::Constant(kInfinity));
          if constexpr (!std::is_same_v<S, HalfSpace>) around = Around(BoxAround(shape), X_WS);
          MarkConvex(typename SolidOf<S>::Type(s, X_WS), around);
        }
      },
      shape);
}

void VoxelGrid::Mark(const Scene& scene) {
  for (const SceneObject& object : scene.objects) {
    for (const PlacedShape& placed : object.shapes) {
      RequireSolid(placed.shape, object.id);
      Mark(placed.shape, object.X_WO * placed.X_FS);
    }
  }
}

}  // namespace planbench
