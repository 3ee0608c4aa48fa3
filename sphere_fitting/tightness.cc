#include "sphere_fitting/tightness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sphere_fitting/outer_spheres.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

constexpr int kPointsOfABall = 500;
constexpr int kVolumePoints = 100'000;

bool InOneOf(const std::vector<Ball>& balls, const Vector3d& p, const Ball* but = nullptr) {
  return std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
    return &ball != but && (p - ball.center).squaredNorm() < ball.radius * ball.radius;
  });
}

void MeasureSurface(const LinkBody& link, const std::vector<Ball>& balls, Tightness* tightness) {
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  for (const Ball& ball : balls) {
    const double area =
        4 * std::numbers::pi * ball.radius * ball.radius / kPointsOfABall;  // of a point
    for (int i = 0; i < kPointsOfABall; ++i) {
      const double z = 1 - (2 * i + 1.0) / kPointsOfABall;
      const double rho = std::sqrt(1 - z * z);
      const double angle = golden_angle * i;
      const Vector3d p =
          ball.center + ball.radius * Vector3d(rho * std::cos(angle), rho * std::sin(angle), z);
      if (InOneOf(balls, p, &ball)) continue;
      tightness->area_m2 += area;
      tightness->area_distance_m3 += area * std::max(0.0, -link.Depth(p));
    }
  }
}

void MeasureVolumes(const LinkBody& link, const std::vector<Ball>& balls, Tightness* tightness) {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  const auto widen = [&](const Vector3d& p, double radius) {
    low = low.cwiseMin(p - Vector3d::Constant(radius));
    high = high.cwiseMax(p + Vector3d::Constant(radius));
  };
  for (const Ball& ball : balls) widen(ball.center, ball.radius);
  for (const Ball& ball : link.spheres()) widen(ball.center, ball.radius);
  for (const Solid* solid : link.hulls()) {
    for (const Vector3d& vertex : solid->mesh().vertices) widen(vertex, 0);
  }
  const Vector3d size = high - low;
  // Roberts's additive sequence, which no face of a body lines up with.
  const double root = 1.2207440846057596;  // x^4 = x + 1
  const Vector3d step(1 / root, 1 / (root * root), 1 / (root * root * root));
  Vector3d share = Vector3d::Constant(0.5);
  int in_balls = 0;
  int in_body = 0;
  for (int i = 0; i < kVolumePoints; ++i) {
    share += step;
    share = share.array() - share.array().floor();
    const Vector3d p = low + share.cwiseProduct(size);
    if (InOneOf(balls, p)) ++in_balls;
    if (link.Encloses(p)) ++in_body;
  }
  if (in_body == 0) return;
  tightness->balls_volume_m3 = size.prod() * in_balls / kVolumePoints;
  tightness->body_volume_m3 = size.prod() * in_body / kVolumePoints;
}

}  // namespace

void Tightness::Add(const Tightness& other) {
  balls += other.balls;
  greatest_m = std::max(greatest_m, other.greatest_m);
  area_m2 += other.area_m2;
  area_distance_m3 += other.area_distance_m3;
  balls_volume_m3 += other.balls_volume_m3;
  body_volume_m3 += other.body_volume_m3;
}

Tightness MeasureTightness(const LinkBody& link, const std::vector<Ball>& balls) {
  Tightness tightness;
  tightness.balls = static_cast<int>(balls.size());
  tightness.greatest_m = GreatestProtrusion(link, balls);
  MeasureSurface(link, balls, &tightness);
  MeasureVolumes(link, balls, &tightness);
  return tightness;
}

}  // namespace planbench
