#include "tests/contract/collision_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace planbench {
namespace {

using Eigen::Vector3d;

double BoxDistance(const Box& box, const Vector3d& p) {
  const Vector3d half = box.size / 2;
  const Vector3d nearest = p.cwiseMax(-half).cwiseMin(half);
  if (nearest != p) return (p - nearest).norm();
  return -(half - p.cwiseAbs()).minCoeff();
}

double CylinderDistance(const Cylinder& cylinder, const Vector3d& p) {
  const double outside_barrel = std::hypot(p.x(), p.y()) - cylinder.radius;
  const double outside_caps = std::abs(p.z()) - cylinder.length / 2;
  if (outside_barrel <= 0 && outside_caps <= 0) return std::max(outside_barrel, outside_caps);
  return std::hypot(std::max(outside_barrel, 0.0), std::max(outside_caps, 0.0));
}

double ConeDistanceByRegion(const Cone& cone, const Vector3d& p) {
  // Radius and height of the point, height counted down from the apex; the lateral line runs along
  // (sin, cos).
  const double rho = std::hypot(p.x(), p.y());
  const double down = cone.length / 2 - p.z();
  const double slant = std::hypot(cone.radius, cone.length);
  const double sine = cone.radius / slant;
  const double cosine = cone.length / slant;
  const double off_lateral = rho * cosine - down * sine;  // > 0 outside of the lateral line
  const double along_lateral = rho * sine + down * cosine;
  if (off_lateral <= 0 && down <= cone.length) return std::max(off_lateral, down - cone.length);
  if (down > cone.length && rho <= cone.radius) return down - cone.length;
  if (along_lateral <= 0) return std::hypot(rho, down);
  if (along_lateral <= slant) return off_lateral;
  return std::hypot(rho - cone.radius, down - cone.length);
}

double CapsuleDistance(const Capsule& capsule, const Vector3d& p) {
  const Vector3d end(0, 0, capsule.length / 2);
  if (p.z() > end.z()) return (p - end).norm() - capsule.radius;
  if (p.z() < -end.z()) return (p + end).norm() - capsule.radius;
  return std::hypot(p.x(), p.y()) - capsule.radius;
}

double TriangleDistance(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                        const Vector3d& c) {
  const Vector3d across = (b - a).cross(c - a);
  const bool has_face = across.norm() > 1e-9 * (b - a).norm() * (c - a).norm();
  const Vector3d normal = across.normalized();
  const Vector3d foot = p - normal * normal.dot(p - a);
  const bool over_face = has_face && (b - a).cross(foot - a).dot(normal) >= 0 &&
                         (c - b).cross(foot - b).dot(normal) >= 0 &&
                         (a - c).cross(foot - c).dot(normal) >= 0;
  if (over_face) return std::abs(normal.dot(p - a));
  double best = std::numeric_limits<double>::infinity();
  const std::pair<Vector3d, Vector3d> edges[] = {{a, b}, {b, c}, {c, a}};
  for (const auto& [from, to] : edges) {
    const Vector3d along = to - from;
    const double t =
        from == to ? 0.0 : std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (p - from - t * along).norm());
  }
  return best;
}

double MeshDistance(const TriangleMesh& mesh, const Vector3d& p) {
  double best = std::numeric_limits<double>::infinity();
  double solid_angle = 0;  // van Oosterom and Strackee
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]];
    const Vector3d b = mesh.vertices[t[1]];
    const Vector3d c = mesh.vertices[t[2]];
    best = std::min(best, TriangleDistance(p, a, b, c));
    const Vector3d u = a - p;
    const Vector3d v = b - p;
    const Vector3d w = c - p;
    solid_angle +=
        2 * std::atan2(u.dot(v.cross(w)), u.norm() * v.norm() * w.norm() + u.dot(v) * w.norm() +
                                              v.dot(w) * u.norm() + w.dot(u) * v.norm());
  }
  return std::abs(solid_angle) > 2 * std::numbers::pi ? -best : best;
}

/// One sphere or shape of a body, posed in the world.
struct Piece {
  bool is_sphere;
  Vector3d center;
  double radius;
  const Shape* shape;
  Eigen::Isometry3d X_WS;
};

struct Body {
  enum { kLink, kObject, kAttached } kind;
  std::string name;
  int link = -1;  // of a link or attached object
  const AttachedObject* attached = nullptr;
  std::vector<Piece> pieces;
};

void AddShapes(const Eigen::Isometry3d& X_WO, const std::vector<PlacedShape>& shapes, Body* body) {
  for (const PlacedShape& placed : shapes) {
    const Eigen::Isometry3d X_WS = X_WO * placed.X_FS;
    const auto* sphere = std::get_if<Sphere>(&placed.shape);
    body->pieces.push_back({sphere != nullptr, X_WS.translation(),
                            sphere != nullptr ? sphere->radius : 0, &placed.shape, X_WS});
  }
}

double PieceDistance(const Piece& a, const Piece& b) {
  if (a.is_sphere && b.is_sphere) return (a.center - b.center).norm() - a.radius - b.radius;
  if (a.is_sphere) return OracleDistance(*b.shape, b.X_WS.inverse() * a.center) - a.radius;
  if (b.is_sphere) return PieceDistance(b, a);
  throw std::logic_error("the oracle has no distance between two shapes that are not spheres");
}

// The outermost link towards the root with only fixed joints between.
int BodyOf(const RobotModel& model, int link) {
  for (const Joint& joint : model.joints()) {
    if (joint.child_link == link && joint.type == JointType::kFixed) {
      return BodyOf(model, joint.parent_link);
    }
  }
  return link;
}

bool MustCheck(const Robot& robot, const Scene& scene, const Body& a, const Body& b) {
  if (a.kind == Body::kObject && b.kind == Body::kObject) return false;
  if (scene.allowed_collisions.Allowed(a.name, b.name)) return false;
  if (a.kind == Body::kLink && b.kind == Body::kLink) {
    if (BodyOf(robot.model, a.link) == BodyOf(robot.model, b.link)) return false;
    const auto is_among = [&](const std::vector<std::pair<int, int>>& pairs) {
      for (const auto& [x, y] : pairs) {
        if ((x == a.link && y == b.link) || (x == b.link && y == a.link)) return true;
      }
      return false;
    };
    if (is_among(robot.allowed_pairs)) return false;
    if (is_among(robot.checked_pairs)) return true;
    for (const auto& [names, allowed] : scene.allowed_collisions.entries()) {
      if (names == std::pair(a.name, b.name) || names == std::pair(b.name, a.name)) return true;
    }
    for (const Joint& joint : robot.model.joints()) {
      if (joint.parent_link == a.link && joint.child_link == b.link) return false;
      if (joint.parent_link == b.link && joint.child_link == a.link) return false;
    }
  }
  if (a.kind == Body::kAttached && b.kind == Body::kAttached && a.link == b.link) return false;
  for (const auto& [attached, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    if (attached->kind != Body::kAttached || other->kind != Body::kLink) continue;
    if (attached->link == other->link) return false;
    for (const std::string& touch : attached->attached->touch_links) {
      if (touch == other->name) return false;
    }
  }
  return true;
}

}  // namespace

double OracleDistance(const Shape& shape, const Eigen::Vector3d& point) {
  if (const auto* box = std::get_if<Box>(&shape)) return BoxDistance(*box, point);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return point.norm() - sphere->radius;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return CylinderDistance(*cylinder, point);
  }
  if (const auto* cone = std::get_if<Cone>(&shape)) return ConeDistanceByRegion(*cone, point);
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return CapsuleDistance(*capsule, point);
  if (std::holds_alternative<HalfSpace>(shape)) return point.z();
  return MeshDistance(std::get<Mesh>(shape).triangles, point);
}

double OracleLeastAlong(const Vector3d& from, const Vector3d& to,
                        const std::function<double(const Vector3d&)>& convex) {
  constexpr int kSteps = 40;
  double least = convex(from);
  if (from == to) return least;
  double best = 0;  // where that is, as a fraction
  double low = 0;
  double high = 1;
  for (int level = 0; level < 5; ++level) {
    const double step = (high - low) / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
      const double value = convex(from + (low + i * step) * (to - from));
      if (value >= least) continue;
      least = value;
      best = low + i * step;
    }
    low = std::max(0.0, best - step);
    high = std::min(1.0, best + step);
  }
  return least;
}

std::vector<OraclePair> OraclePairs(const Robot& robot, const PlanningGroup& group,
                                    const Scene& scene, std::span<const double> base_positions,
                                    std::span<const double> q) {
  const auto poses = ComputeLinkPoses(robot.model, WithGroupAt(robot, group, base_positions, q));
  std::vector<Body> bodies;
  for (int link = 0; link < robot.model.num_links(); ++link) {
    Body body{
        Body::kLink, robot.model.links()[static_cast<std::size_t>(link)].name, link, nullptr, {}};
    for (const LinkSphere& sphere : robot.spheres) {
      if (sphere.link != link) continue;
      body.pieces.push_back({true, poses[static_cast<std::size_t>(link)] * sphere.p_LS,
                             sphere.radius, nullptr, Eigen::Isometry3d::Identity()});
    }
    bodies.push_back(body);
  }
  for (const SceneObject& object : scene.objects) {
    bodies.push_back({Body::kObject, object.id, -1, nullptr, {}});
    AddShapes(object.X_WO, object.shapes, &bodies.back());
  }
  for (const AttachedObject& attached : scene.attached) {
    const int link = robot.model.FindLink(attached.link);
    bodies.push_back({Body::kAttached, attached.object.id, link, &attached, {}});
    AddShapes(poses[static_cast<std::size_t>(link)] * attached.object.X_WO, attached.object.shapes,
              &bodies.back());
  }

  std::vector<OraclePair> pairs;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const Body& a = bodies[i];
      const Body& b = bodies[j];
      if (a.pieces.empty() || b.pieces.empty() || !MustCheck(robot, scene, a, b)) continue;
      double distance = std::numeric_limits<double>::infinity();
      for (const Piece& x : a.pieces) {
        for (const Piece& y : b.pieces) distance = std::min(distance, PieceDistance(x, y));
      }
      pairs.push_back({a.name, b.name, distance});
    }
  }
  return pairs;
}

double OracleClearance(const std::vector<OraclePair>& pairs) {
  double clearance = std::numeric_limits<double>::infinity();
  for (const OraclePair& pair : pairs) clearance = std::min(clearance, pair.distance_m);
  return clearance;
}

std::vector<double> WithGroupAt(const Robot& robot, const PlanningGroup& group,
                                std::span<const double> base_positions, std::span<const double> q) {
  std::vector<double> positions(base_positions.begin(), base_positions.end());
  for (std::size_t i = 0; i < group.joints.size(); ++i) {
    const Joint& joint = robot.model.joints()[static_cast<std::size_t>(group.joints[i])];
    positions[static_cast<std::size_t>(joint.position_index)] = q[i];
  }
  return positions;
}

std::vector<double> RandomConfiguration(const JointSpace& space, std::mt19937_64* generator) {
  std::vector<double> q;
  for (const JointSpace::Joint& joint : space.joints()) {
    q.push_back(std::uniform_real_distribution<double>(joint.lower, joint.upper)(*generator));
  }
  return q;
}

Eigen::Isometry3d RandomPose(std::mt19937_64* generator, double range_m) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-range_m, range_m);
  const auto w = normal(*generator);
  const auto x = normal(*generator);
  const auto y = normal(*generator);
  const auto z = normal(*generator);
  Eigen::Isometry3d X(Eigen::Quaterniond(w, x, y, z).normalized());
  for (int axis = 0; axis < 3; ++axis) X.translation()[axis] = uniform(*generator);
  return X;
}

}  // namespace planbench
