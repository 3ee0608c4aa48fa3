#include "robot_tools/sphere_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "common/error.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

// Cells finer by this from one try to the next.
constexpr double kRefinement = 0.93;

// Covers with cells of edge length up to `cell`, finer and finer, until the overshoot is small
// enough or the next would be too many.
SphereCover Refine(double cell, double overshoot_m, int most,
                   const std::function<SphereCover(double cell)>& cover) {
  SphereCover best = cover(cell);
  while (best.overshoot_m > overshoot_m) {
    cell *= kRefinement;
    SphereCover finer = cover(cell);
    if (static_cast<int>(finer.balls.size()) > most) break;
    if (finer.overshoot_m < best.overshoot_m) best = std::move(finer);
  }
  return best;
}

// The circumscribed spheres of the cells of a box that `meets` accepts, by centre and half edges.
SphereCover CoverCells(const Vector3d& size, double cell,
                       const std::function<bool(const Vector3d&, const Vector3d&)>& meets) {
  std::array<int, 3> n;
  Vector3d half;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    n[a] = std::max(1, static_cast<int>(std::ceil(size[axis] / cell)));
    half[axis] = size[axis] / n[a] / 2;
  }
  SphereCover cover;
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        const Vector3d center =
            -size / 2 + Vector3d(2 * i + 1, 2 * j + 1, 2 * k + 1).cwiseProduct(half);
        if (meets(center, half)) cover.balls.push_back({center, half.norm()});
      }
    }
  }
  // A point of a ball is beyond the box by no more than the ball is beyond one of its cell's faces.
  cover.overshoot_m = half.norm() - half.minCoeff();
  return cover;
}

SphereCover CoverBox(const Box& box, double overshoot_m, int most) {
  return Refine(box.size.maxCoeff(), overshoot_m, most, [&](double cell) {
    return CoverCells(box.size, cell, [](const Vector3d&, const Vector3d&) { return true; });
  });
}

// Slices along the axis, each within a ball about its middle.
SphereCover CoverRod(const Cylinder& cylinder, double cell) {
  const int n = std::max(1, static_cast<int>(std::ceil(cylinder.length / cell)));
  const double half = cylinder.length / n / 2;
  const double radius = std::hypot(cylinder.radius, half);
  SphereCover cover;
  for (int i = 0; i < n; ++i) {
    cover.balls.push_back({{0, 0, -cylinder.length / 2 + (2 * i + 1) * half}, radius});
  }
  // Beyond the caps, where the ball of the last slice bulges most, or beyond the mantle.
  cover.overshoot_m = radius - std::min(half, cylinder.radius);
  return cover;
}

// Cells of the box around it, as far as they meet it: for cylinders that are rather discs.
SphereCover CoverDisc(const Cylinder& cylinder, double cell) {
  const Vector3d size(2 * cylinder.radius, 2 * cylinder.radius, cylinder.length);
  SphereCover cover = CoverCells(size, cell, [&](const Vector3d& center, const Vector3d& half) {
    const Vector3d nearest = (center.cwiseAbs() - half).cwiseMax(0);
    return nearest.head<2>().norm() <= cylinder.radius;
  });
  // A cell at the mantle may meet the cylinder in a corner only.
  cover.overshoot_m = 2 * cover.balls.front().radius;
  return cover;
}

SphereCover CoverCylinder(const Cylinder& cylinder, double overshoot_m, int most) {
  const auto refine = [&](const auto& way) {
    return Refine(std::max(cylinder.length, 2 * cylinder.radius), overshoot_m, most,
                  [&](double cell) { return way(cylinder, cell); });
  };
  SphereCover rod = refine(CoverRod);
  SphereCover disc = refine(CoverDisc);
  const bool rod_serves = rod.overshoot_m <= overshoot_m;
  const bool disc_serves = disc.overshoot_m <= overshoot_m;
  if (rod_serves && disc_serves) return rod.balls.size() <= disc.balls.size() ? rod : disc;
  return rod.overshoot_m <= disc.overshoot_m ? rod : disc;
}

}  // namespace

SphereCover CoverWithSpheres(const Shape& shape, double overshoot_m, int most) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return {{{Vector3d::Zero(), sphere->radius}}, 0};
  }
  if (const auto* box = std::get_if<Box>(&shape)) return CoverBox(*box, overshoot_m, most);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return CoverCylinder(*cylinder, overshoot_m, most);
  }
  throw InputError("a " + ShapeTypeName(shape) + " cannot be covered with spheres");
}

}  // namespace planbench
