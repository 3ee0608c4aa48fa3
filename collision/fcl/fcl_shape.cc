#include "collision/fcl/fcl_shape.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/primitive_shape_algorithm/sphere_box.h>
#include <fcl/narrowphase/detail/primitive_shape_algorithm/sphere_cylinder.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "collision/shape_check.h"
#include "geometry/degenerate_triangles.h"
#include "geometry/lexicographic_less.h"
#include "geometry/mesh_surface.h"
#include "geometry/solid_mesh.h"

namespace planbench {
namespace {

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

fcl::Transform3d Translation(const Eigen::Vector3d& p) {
  fcl::Transform3d X = fcl::Transform3d::Identity();
  X.translation() = p;
  return X;
}

double DistancePointToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                              const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length_squared = along.squaredNorm();
  const double t =
      length_squared > 0 ? std::clamp((p - a).dot(along) / length_squared, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

double CapsuleDistance(const Capsule& capsule, const Eigen::Vector3d& point) {
  const double beyond = std::max(std::abs(point.z()) - capsule.length / 2, 0.0);
  return std::hypot(point.head<2>().norm(), beyond) - capsule.radius;
}

/// Nearer than that to each other, m, what has no thickness touches, which rounding would deny.
constexpr double kTouchingLines = 1e-9;

/// A line between two points in either direction, as something to sort by; equal ones are a point.
using Line = std::array<double, 6>;

Line LineBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const auto& [from, to] = LexicographicLess(b, a) ? std::tie(b, a) : std::tie(a, b);
  return {from.x(), from.y(), from.z(), to.x(), to.y(), to.z()};
}

/// The triangles of a mesh, and apart those that are but lines or points: from these FCL's balls
/// are at distance 0 wherever they are, as it divides by the area, and triangles in their plane
/// collide.
struct SplitMesh {
  std::vector<fcl::Triangle> triangles;
  /// What they are (AsLine), as {a, b, a}. Those that are edges or corners of a triangle with an
  /// area, as most are that files have, are left out.
  std::vector<Corners> lines;
};

SplitMesh SplitTriangles(const TriangleMesh& mesh) {
  SplitMesh split;
  split.triangles.reserve(mesh.triangles.size());
  std::set<Line> lines;
  for (const auto& t : mesh.triangles) {
    if (const auto line = AsLine(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) {
      lines.insert(LineBetween(line->a, line->b));
    } else {
      split.triangles.emplace_back(t[0], t[1], t[2]);
    }
  }
  for (const fcl::Triangle& t : split.triangles) {
    if (lines.empty()) break;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& corner = mesh.vertices[t[k]];
      lines.erase(LineBetween(corner, corner));
      lines.erase(LineBetween(corner, mesh.vertices[t[(k + 1) % 3]]));
    }
  }
  for (const auto& [ax, ay, az, bx, by, bz] : lines) {
    const Eigen::Vector3d a(ax, ay, az);
    split.lines.push_back({a, Eigen::Vector3d(bx, by, bz), a});
  }
  return split;
}

/// Null without a triangle.
std::unique_ptr<fcl::CollisionGeometryd> MakeBvh(const std::vector<Eigen::Vector3d>& vertices,
                                                 const std::vector<fcl::Triangle>& triangles) {
  if (triangles.empty()) return nullptr;
  auto model = std::make_unique<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace

struct FclShape::Geometry {
  /// Null of half-spaces, and of meshes that are but lines and points.
  std::unique_ptr<fcl::CollisionGeometryd> fcl;
  std::variant<Box, Sphere, Cylinder, Cone, Capsule, HalfSpace, SolidMesh> shape;
  MeshSurface surface;  ///< Of a mesh.
  MeshSurface lines;    ///< What of it FCL is not given, see SplitMesh.

  bool IsHalfSpace() const { return std::holds_alternative<HalfSpace>(shape); }
  bool IsCapsule() const { return std::holds_alternative<Capsule>(shape); }
  bool IsMesh() const { return std::holds_alternative<SolidMesh>(shape); }
  const SolidMesh& mesh() const { return std::get<SolidMesh>(shape); }

  /// The least height, along z of a frame A, of the shape at pose X_AS.
  double LowestHeight(const Pose& X_AS) const {
    const Eigen::Vector3d up = X_AS.rotation.row(2);  // z of A in the shape's frame
    const double across = up.head<2>().norm();
    const double half_rise = std::abs(up.z()) / 2;  // by unit of length along the axis
    const double below = std::visit(
        Overloaded{
            [&](const Box& box) { return box.size.dot(up.cwiseAbs()) / 2; },
            [&](const Sphere& sphere) { return sphere.radius; },
            [&](const Cylinder& cylinder) {
              return cylinder.radius * across + cylinder.length * half_rise;
            },
            [&](const Cone& cone) {
              const double apex = -up.z() * cone.length / 2;
              return std::max(apex, cone.radius * across - apex);
            },
            [&](const Capsule& capsule) { return capsule.radius + capsule.length * half_rise; },
            [&](const HalfSpace&) {
              // Bounded below only if it is turned over.
              return across > 1e-12 || up.z() > 0 ? std::numeric_limits<double>::infinity() : 0.0;
            },
            [&](const SolidMesh&) {
              return -surface.Least(
                  std::numeric_limits<double>::infinity(),
                  [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high, double) {
                    return (up.dot(low + high) - up.cwiseAbs().dot(high - low)) / 2;
                  },
                  [&](const Corners& corners, double) {
                    return std::min({up.dot(corners[0]), up.dot(corners[1]), up.dot(corners[2])});
                  });
            },
        },
        shape);
    return X_AS.translation.z() - below;
  }
};

FclShape::FclShape(const Shape& shape, const std::string& owner)
    : geometry_(std::make_unique<Geometry>()), bounding_sphere_{Eigen::Vector3d::Zero(), 0} {
  RequireSolid(shape, owner);
  std::visit(
      Overloaded{
          [&](const Box& box) {
            geometry_->fcl = std::make_unique<fcl::Boxd>(box.size);
            geometry_->shape = box;
            box_half_size_ = box.size / 2;
          },
          [&](const Sphere& sphere) {
            geometry_->fcl = std::make_unique<fcl::Sphered>(sphere.radius);
            geometry_->shape = sphere;
            box_half_size_ = Eigen::Vector3d::Constant(sphere.radius);
          },
          [&](const Cylinder& cylinder) {
            geometry_->fcl = std::make_unique<fcl::Cylinderd>(cylinder.radius, cylinder.length);
            geometry_->shape = cylinder;
            box_half_size_ << cylinder.radius, cylinder.radius, cylinder.length / 2;
          },
          [&](const Cone& cone) {
            geometry_->fcl = std::make_unique<fcl::Coned>(cone.radius, cone.length);
            geometry_->shape = cone;
            box_half_size_ << cone.radius, cone.radius, cone.length / 2;
          },
          [&](const Capsule& capsule) {
            geometry_->fcl = std::make_unique<fcl::Capsuled>(capsule.radius, capsule.length);
            geometry_->shape = capsule;
            box_half_size_ << capsule.radius, capsule.radius, capsule.length / 2 + capsule.radius;
          },
          [&](const HalfSpace& half_space) {
            geometry_->shape = half_space;
            box_half_size_.setConstant(std::numeric_limits<double>::infinity());
          },
          [&](const Mesh& mesh) {
            SplitMesh split = SplitTriangles(mesh.triangles);
            geometry_->fcl = MakeBvh(mesh.triangles->vertices, split.triangles);
            geometry_->shape = SolidMesh(mesh.triangles);
            geometry_->surface = MeshSurface(mesh.triangles);
            geometry_->lines = MeshSurface(std::move(split.lines));
            box_center_ = mesh.triangles.box().center();
            box_half_size_ = mesh.triangles.box().sizes() / 2;
          },
      },
      shape);
  if (geometry_->fcl != nullptr) geometry_->fcl->computeLocalAABB();
  bounding_sphere_ = ComputeBoundingSphere(shape);
}

FclShape::~FclShape() = default;
FclShape::FclShape(FclShape&&) noexcept = default;

bool FclShape::TouchesBall(const Eigen::Vector3d& center, double radius) const {
  const auto identity = fcl::Transform3d::Identity();
  return std::visit(
      Overloaded{
          [&](const Box&) {
            return fcl::detail::sphereBoxIntersect<double>(
                fcl::Sphered(radius), Translation(center),
                static_cast<const fcl::Boxd&>(*geometry_->fcl), identity, nullptr);
          },
          [&](const Sphere& sphere) {
            const double reach = sphere.radius + radius;
            return center.squaredNorm() <= reach * reach;
          },
          [&](const Cylinder&) {
            return fcl::detail::sphereCylinderIntersect<double>(
                fcl::Sphered(radius), Translation(center),
                static_cast<const fcl::Cylinderd&>(*geometry_->fcl), identity, nullptr);
          },
          [&](const Cone& cone) { return ConeDistance(cone, center) <= radius; },
          [&](const Capsule& capsule) { return CapsuleDistance(capsule, center) <= radius; },
          [&](const HalfSpace&) { return center.z() <= radius; },
          [&](const SolidMesh& mesh) {
            return geometry_->surface.Distance(center, radius + kTouchingLines) <= radius ||
                   mesh.Contains(center);
          },
      },
      geometry_->shape);
}

double FclShape::BallDistance(const Eigen::Vector3d& center, double radius) const {
  const auto identity = fcl::Transform3d::Identity();
  return std::visit(
      Overloaded{
          [&](const Box&) {
            const fcl::Sphered ball(radius);
            const auto& box = static_cast<const fcl::Boxd&>(*geometry_->fcl);
            double distance = 0;
            if (fcl::detail::sphereBoxDistance<double>(ball, Translation(center), box, identity,
                                                       &distance, nullptr, nullptr)) {
              return distance;
            }
            std::vector<fcl::ContactPointd> contacts;
            fcl::detail::sphereBoxIntersect<double>(ball, Translation(center), box, identity,
                                                    &contacts);
            return contacts.empty() ? 0.0 : -contacts.front().penetration_depth;
          },
          [&](const Sphere& sphere) { return center.norm() - sphere.radius - radius; },
          [&](const Cylinder&) {
            const fcl::Sphered ball(radius);
            const auto& cylinder = static_cast<const fcl::Cylinderd&>(*geometry_->fcl);
            double distance = 0;
            if (fcl::detail::sphereCylinderDistance<double>(
                    ball, Translation(center), cylinder, identity, &distance, nullptr, nullptr)) {
              return distance;
            }
            std::vector<fcl::ContactPointd> contacts;
            fcl::detail::sphereCylinderIntersect<double>(ball, Translation(center), cylinder,
                                                         identity, &contacts);
            return contacts.empty() ? 0.0 : -contacts.front().penetration_depth;
          },
          [&](const Cone& cone) { return ConeDistance(cone, center) - radius; },
          [&](const Capsule& capsule) { return CapsuleDistance(capsule, center) - radius; },
          [&](const HalfSpace&) { return center.z() - radius; },
          [&](const SolidMesh& mesh) {
            const double distance = geometry_->surface.Distance(center);
            return (mesh.Contains(center) ? -distance : distance) - radius;
          },
      },
      geometry_->shape);
}

bool FclShape::Contains(const FclShape& other, const Pose& X_SO) const {
  if (!geometry_->IsMesh()) return false;  // FCL takes primitives as solid
  const SolidMesh& mesh = geometry_->mesh();
  if (!mesh.has_inside()) return false;
  if (!other.geometry_->IsMesh()) return mesh.Contains(X_SO.translation);
  const auto& points = other.geometry_->mesh().component_points();
  return std::any_of(points.begin(), points.end(),
                     [&](const Eigen::Vector3d& point) { return mesh.Contains(X_SO * point); });
}

double FclShape::SegmentDistance(const Segment& segment, double at_most) const {
  if (geometry_->IsMesh()) return geometry_->surface.Distance(segment, at_most);
  return LeastOnSegment(segment, at_most, [this](const Eigen::Vector3d& point) {
    return std::max(0.0, BallDistance(point, 0));
  });
}

double FclShape::LineDistance(const FclShape& other, const Pose& X_SO, double at_most) const {
  const auto nearest = [](const FclShape& of, const FclShape& to, const Pose& X_TF, double limit) {
    const Eigen::Matrix3d turned = X_TF.rotation.cwiseAbs();
    return of.geometry_->lines.Least(
        limit,
        [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high, double) {
          const Eigen::Vector3d apart = (X_TF * ((low + high) / 2) - to.box_center_).cwiseAbs();
          const Eigen::Vector3d halves = turned * ((high - low) / 2) + to.box_half_size_;
          return (apart - halves).cwiseMax(0).norm();
        },
        [&](const Corners& line, double best) {
          const double distance = to.SegmentDistance({X_TF * line[0], X_TF * line[1]}, best);
          return distance < kTouchingLines ? 0 : distance;  // nothing is nearer
        });
  };
  return nearest(other, *this, X_SO, nearest(*this, other, X_SO.Inverse(), at_most));
}

bool FclShape::Touches(const FclShape& other, const Pose& X_SO) const {
  if (const auto* sphere = std::get_if<Sphere>(&other.geometry_->shape)) {
    return TouchesBall(X_SO.translation, sphere->radius);
  }
  if (const auto* sphere = std::get_if<Sphere>(&geometry_->shape)) {
    return other.TouchesBall(X_SO.Inverse().translation, sphere->radius);
  }
  if (geometry_->IsHalfSpace()) return other.geometry_->LowestHeight(X_SO) <= 0;
  if (other.geometry_->IsHalfSpace()) return geometry_->LowestHeight(X_SO.Inverse()) <= 0;
  fcl::CollisionResultd result;
  if (geometry_->fcl != nullptr && other.geometry_->fcl != nullptr) {
    fcl::collide(geometry_->fcl.get(), fcl::Transform3d::Identity(), other.geometry_->fcl.get(),
                 X_SO.ToIsometry(), fcl::CollisionRequestd(), result);
  }
  return result.isCollision() || LineDistance(other, X_SO, kTouchingLines) <= 0 ||
         Contains(other, X_SO) || other.Contains(*this, X_SO.Inverse());
}

double FclShape::FaceDistance(const FclShape& other, const Pose& X_SO, double at_most) const {
  // Both of FCL's iterative solvers stop early in some poses, at a distance that is too large
  // (libccd by up to 5e-4 m, where faces are parallel; the other one by centimetres, seldom): the
  // smaller is right. Triangles against triangles need neither.
  double distance = at_most;
  if (geometry_->fcl == nullptr || other.geometry_->fcl == nullptr) return distance;
  for (const fcl::GJKSolverType solver : {fcl::GST_LIBCCD, fcl::GST_INDEP}) {
    fcl::DistanceRequestd request;
    request.gjk_solver_type = solver;
    request.distance_tolerance = 1e-12;  // of the last step, not of the result
    fcl::DistanceResultd result;
    result.min_distance = distance;  // FCL skips what is further
    distance = std::min(
        distance, fcl::distance(geometry_->fcl.get(), fcl::Transform3d::Identity(),
                                other.geometry_->fcl.get(), X_SO.ToIsometry(), request, result));
    if (geometry_->IsMesh() && other.geometry_->IsMesh()) break;
  }
  return distance;
}

double FclShape::Distance(const FclShape& other, const Pose& X_SO, double at_most) const {
  if (const auto* sphere = std::get_if<Sphere>(&other.geometry_->shape)) {
    return std::min(at_most, BallDistance(X_SO.translation, sphere->radius));
  }
  if (const auto* sphere = std::get_if<Sphere>(&geometry_->shape)) {
    return std::min(at_most, other.BallDistance(X_SO.Inverse().translation, sphere->radius));
  }
  if (at_most <= 0) return at_most;
  if (geometry_->IsHalfSpace()) {
    return std::clamp(other.geometry_->LowestHeight(X_SO), 0.0, at_most);
  }
  if (other.geometry_->IsHalfSpace()) return other.Distance(*this, X_SO.Inverse(), at_most);
  if (geometry_->IsCapsule() && !other.geometry_->IsCapsule()) {
    return other.Distance(*this, X_SO.Inverse(), at_most);
  }
  double distance = at_most;
  if (const auto* capsule = std::get_if<Capsule>(&other.geometry_->shape)) {
    // FCL's libccd ends the process where a capsule just touches something.
    const Eigen::Vector3d to_end = X_SO.rotation.col(2) * (capsule->length / 2);
    const Segment axis{X_SO.translation - to_end, X_SO.translation + to_end};
    distance = SegmentDistance(axis, at_most + capsule->radius) - capsule->radius;
  } else {
    distance = LineDistance(other, X_SO, FaceDistance(other, X_SO, at_most));
  }
  // Where shapes almost touch the verdict decides the sign, so that the two never disagree.
  constexpr double kAlmostTouching = 1e-5;
  const bool touches = distance < kAlmostTouching
                           ? Touches(other, X_SO)
                           : Contains(other, X_SO) || other.Contains(*this, X_SO.Inverse());
  if (touches) return 0;
  return std::min(at_most, std::max(distance, std::numeric_limits<double>::min()));
}

double FclShape::Depth(const FclShape& other, const Pose& X_SO) const {
  if (std::holds_alternative<Sphere>(geometry_->shape) ||
      std::holds_alternative<Sphere>(other.geometry_->shape)) {
    return std::max(0.0, -Distance(other, X_SO, 0));
  }
  constexpr double kPrecision = 1e-6;  // m
  constexpr double kFirstStep = 1e-3;  // m
  constexpr double kFarthest = 1e3;    // m: from half-spaces few directions lead away
  double depth = kFarthest;
  Eigen::Vector3d best = Eigen::Vector3d::UnitZ();
  const auto try_direction = [&](const Eigen::Vector3d& direction) {
    const auto touches_after = [&](double distance) {
      Pose moved = X_SO;
      moved.translation += distance * direction;
      return Touches(other, moved);
    };
    double touching = 0;
    double free = std::min(depth - kPrecision, kFirstStep);
    while (touches_after(free)) {
      if (free >= depth - kPrecision) return;
      touching = free;
      free = std::min(depth - kPrecision, 2 * free);
    }
    while (free - touching > kPrecision) {
      const double middle = (free + touching) / 2;
      (touches_after(middle) ? touching : free) = middle;
    }
    depth = free;
    best = direction;
  };
  // Faces, edges and corners of a cube along the axes of either shape.
  for (const Eigen::Matrix3d& axes :
       {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Matrix3d(X_SO.rotation)}) {
    for (int code = 0; code < 27; ++code) {
      const int x = code % 3 - 1, y = code / 3 % 3 - 1, z = code / 9 - 1;
      const Eigen::Vector3d corner(x, y, z);
      if (code != 13) try_direction(axes * corner.normalized());
    }
  }
  for (double tilt = 0.3; tilt > 0.01; tilt /= 2) {
    // NOLINTNEXTLINE(performance-unnecessary-copy-initialization): try_direction changes `best`
    const Eigen::Vector3d around = best;
    const Eigen::Vector3d side = around.unitOrthogonal();
    const Eigen::Vector3d other_side = around.cross(side);
    for (const Eigen::Vector3d& to : {side, other_side}) {
      for (const double sign : {-1.0, 1.0}) try_direction((around + sign * tilt * to).normalized());
    }
  }
  return depth;
}

double ConeDistance(const Cone& cone, const Eigen::Vector3d& point) {
  // In the half-plane through the axis the cone is the triangle of apex, rim and centre of the
  // base.
  const Eigen::Vector2d p(point.head<2>().norm(), point.z());
  const Eigen::Vector2d apex(0, cone.length / 2);
  const Eigen::Vector2d rim(cone.radius, -cone.length / 2);
  const Eigen::Vector2d base(0, -cone.length / 2);
  const double distance =
      std::min(DistancePointToSegment(p, apex, rim), DistancePointToSegment(p, rim, base));
  const Eigen::Vector2d side = rim - apex;
  const bool inside =
      p.y() >= base.y() && side.x() * (p.y() - apex.y()) - side.y() * (p.x() - apex.x()) <= 0;
  return inside ? -distance : distance;
}

}  // namespace planbench
