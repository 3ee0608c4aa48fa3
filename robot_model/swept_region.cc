#include "robot_model/swept_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/golden_section.h"

namespace planbench {

using Eigen::Vector3d;

// The square to be maximised over the unit disc x is |w + D x|^2 with D = r diag(1, s). Its
// Lagrange dual
//   g(l) = l + w_x^2 l / (l - r^2) + w_y^2 l / (l - r^2 s^2),   l > r^2,
// bounds it from above at every l, so that any l found gives a true bound, and its minimum is the
// maximum itself (S-lemma; Boyd and Vandenberghe, Convex Optimization, B.1). g is convex.
double MaxDistanceToEllipse(const Eigen::Vector2d& w, double r, double s) {
  const double distance = w.norm();
  if (r < 1e-12) return distance + r;  // Too small to square; the bound loses nothing by it.
  const double r2 = r * r;
  const double s2 = s * s;
  const double wx2 = w.x() * w.x();
  const double wy2 = w.y() * w.y();
  const auto dual = [&](double l) { return l + wx2 * l / (l - r2) + wy2 * l / (l - r2 * s2); };
  // The minimum lies where it does for s = 1 at the latest, l = r^2 + r |w|; towards r^2 the first
  // quotient grows without bound, unless w_x = 0.
  const double low = r2 * (1 + 1e-14);
  const double high = r2 + r * distance + r2 * 1e-13;
  const double best = LeastByGoldenSections(
      low, high, dual, [](double from, double to) { return to - from <= 1e-9 * to; });
  // The circle around the ellipse bounds it too (and exactly, where the ellipse is one).
  return std::min(std::sqrt(best), distance + r);
}

SweptRegion::SweptRegion(const Vector3d& point) : origin_(point) {}

void SweptRegion::Transform(const Eigen::Isometry3d& X_PC) {
  origin_ = X_PC * origin_;
  axis_ = X_PC.linear() * axis_;
  for (Vector3d& half : half_travels_) half = X_PC.linear() * half;
}

std::vector<Vector3d> SweptRegion::TravelCorners() const {
  std::vector<Vector3d> corners = {Vector3d::Zero()};
  for (const Vector3d& half : half_travels_) {
    const std::size_t count = corners.size();
    for (std::size_t i = 0; i < count; ++i) {
      corners.push_back(corners[i] - half);
      corners[i] += half;
    }
  }
  return corners;
}

double SweptRegion::Revolve(const Vector3d& origin, const Vector3d& axis) {
  const double along = axis_.dot(axis);  // Cosine between the two axes.
  const double across = std::sqrt(std::max(0.0, 1 - along * along));
  // Basis of the plane across the new axis: the old axis' circles show in it as ellipses with
  // semi-axes 1 along x and |along| along y.
  const Vector3d normal = axis_.cross(axis);
  const Vector3d x = normal.norm() > 1e-9 ? Vector3d(normal.normalized()) : axis.unitOrthogonal();
  const Vector3d y = axis.cross(x);

  double lower = std::numeric_limits<double>::infinity();
  double upper = -lower;
  double radius = 0;
  double ball_lower = lower;
  double ball_upper = upper;
  const std::vector<Vector3d> corners = TravelCorners();
  // Distances and coordinates are convex functions of the travel: corners bound them.
  for (const Vector3d& corner : corners) {
    for (const double end : {lower_, upper_}) {
      const Vector3d w = origin_ + corner + end * axis_ - origin;
      const double height = w.dot(axis);
      lower = std::min(lower, height - radius_ * across);
      upper = std::max(upper, height + radius_ * across);
      radius = std::max(radius, MaxDistanceToEllipse({w.dot(x), w.dot(y)}, radius_,
                                                     std::min(1.0, std::abs(along))));
    }
    const Vector3d center = origin_ + corner + ball_center_ * axis_ - origin;
    ball_lower = std::min(ball_lower, center.dot(axis));
    ball_upper = std::max(ball_upper, center.dot(axis));
  }

  // The new ball: about the point of the new axis nearest to the old ball.
  const double ball_center = (ball_lower + ball_upper) / 2;
  double ball_radius = 0;
  for (const Vector3d& corner : corners) {
    const Vector3d center = origin_ + corner + ball_center_ * axis_ - origin;
    ball_radius = std::max(ball_radius, (center - ball_center * axis).norm() + ball_radius_);
  }

  // Each description tightens the other.
  radius = std::min(radius, ball_radius);
  lower = std::max(lower, ball_center - ball_radius);
  upper = std::min(upper, ball_center + ball_radius);
  const double far_end = std::max(std::abs(lower - ball_center), std::abs(upper - ball_center));
  ball_radius = std::min(ball_radius, std::hypot(far_end, radius));

  origin_ = origin;
  axis_ = axis;
  lower_ = lower;
  upper_ = upper;
  radius_ = radius;
  ball_center_ = ball_center;
  ball_radius_ = ball_radius;
  half_travels_.clear();
  return radius;
}

void SweptRegion::Slide(const Vector3d& axis, double lower, double upper) {
  origin_ += axis * ((lower + upper) / 2);
  half_travels_.push_back(axis * ((upper - lower) / 2));
}

}  // namespace planbench
