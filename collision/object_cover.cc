#include "collision/object_cover.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <utility>
#include <variant>

namespace planbench {
namespace {

/// A ball is small enough at so many times half of the shape's least extent: smaller ones would be
/// many, and reach out of it hardly less.
constexpr double kSmallRadius = 1.75;

/// A box, in the frame of a shape, that is to be covered as far as it is in the shape.
struct Cell {
  const PlacedShape* placed = nullptr;
  double small_radius = 0;  ///< m
  Eigen::AlignedBox3d box;
  Ball ball;  ///< In the shape's frame.

  bool operator<(const Cell& other) const { return ball.radius < other.ball.radius; }
};

/// Whether a box is beside a round shape, from whose axis (z) nothing is further than its radius.
bool IsBeside(const Shape& shape, const Eigen::AlignedBox3d& box) {
  double radius = std::numeric_limits<double>::infinity();
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) radius = cylinder->radius;
  if (const auto* cone = std::get_if<Cone>(&shape)) radius = cone->radius;
  if (const auto* capsule = std::get_if<Capsule>(&shape)) radius = capsule->radius;
  const Eigen::Vector3d axis(0, 0, box.center().z());
  return box.squaredExteriorDistance(axis) > radius * radius;
}

double Depth(const Box& box, const Eigen::Vector3d& p) {
  return (box.size / 2 - p.cwiseAbs()).minCoeff();
}
double Depth(const Sphere& sphere, const Eigen::Vector3d& p) { return sphere.radius - p.norm(); }
double Depth(const Cylinder& cylinder, const Eigen::Vector3d& p) {
  return std::min(cylinder.radius - p.head<2>().norm(), cylinder.length / 2 - std::abs(p.z()));
}
double Depth(const Capsule& capsule, const Eigen::Vector3d& p) {
  const double z = std::clamp(p.z(), -capsule.length / 2, capsule.length / 2);
  return capsule.radius - (p - Eigen::Vector3d(0, 0, z)).norm();
}
template <typename Other>
double Depth(const Other& /*shape*/, const Eigen::Vector3d& /*p*/) {
  return 0;
}

}  // namespace

Eigen::AlignedBox3d BoxAround(const Shape& shape) {
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  if (const auto* box = std::get_if<Box>(&shape)) half = box->size / 2;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) half.setConstant(sphere->radius);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    half << cylinder->radius, cylinder->radius, cylinder->length / 2;
  }
  if (const auto* cone = std::get_if<Cone>(&shape)) {
    half << cone->radius, cone->radius, cone->length / 2;
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    half << capsule->radius, capsule->radius, capsule->length / 2 + capsule->radius;
  }
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return mesh->triangles.box();
  return {-half, half};
}

std::vector<Ball> CoverOf(const SceneObject& object, std::size_t most) {
  std::priority_queue<Cell> open;
  std::vector<Cell> cells;
  const auto add = [&](Cell cell) {
    if (cell.ball.radius > cell.small_radius) {
      open.push(std::move(cell));
    } else {
      cells.push_back(std::move(cell));
    }
  };
  for (const PlacedShape& placed : object.shapes) {
    const BoundingSphere bound = ComputeBoundingSphere(placed.shape);
    const Eigen::AlignedBox3d box = BoxAround(placed.shape);
    const double small_radius = kSmallRadius * box.sizes().minCoeff() / 2;
    add({&placed, small_radius, box, {bound.center, bound.radius}});
  }
  while (!open.empty() && open.size() + cells.size() < most) {
    const Cell cell = open.top();
    open.pop();
    int axis = 0;
    cell.box.sizes().maxCoeff(&axis);
    for (const bool upper : {false, true}) {
      Cell half = cell;
      Eigen::Vector3d& end = upper ? half.box.min() : half.box.max();
      end[axis] = cell.box.center()[axis];
      if (IsBeside(cell.placed->shape, half.box)) continue;
      half.ball = {half.box.center(), half.box.sizes().norm() / 2};
      add(std::move(half));
    }
  }
  for (; !open.empty(); open.pop()) cells.push_back(open.top());
  std::vector<Ball> balls;
  for (const Cell& cell : cells) {
    balls.push_back({object.X_WO * (cell.placed->X_FS * cell.ball.center), cell.ball.radius});
  }
  return balls;
}

double DepthIn(const SceneObject& object, const Eigen::Vector3d& point) {
  double depth = 0;
  for (const PlacedShape& placed : object.shapes) {
    const Eigen::Vector3d p = (object.X_WO * placed.X_FS).inverse() * point;
    depth = std::max(depth,
                     std::visit([&](const auto& shape) { return Depth(shape, p); }, placed.shape));
  }
  return depth;
}

}  // namespace planbench
