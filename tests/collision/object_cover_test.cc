#include "collision/object_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/random.h"
#include "geometry/shapes.h"

namespace planbench {
namespace {

/// Whether a point of a shape's frame is in the shape.
bool Contains(const Shape& shape, const Eigen::Vector3d& p) {
  const double rho = p.head<2>().norm();
  if (const auto* box = std::get_if<Box>(&shape)) {
    return (p.cwiseAbs().array() <= box->size.array() / 2).all();
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return p.norm() <= sphere->radius;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return rho <= cylinder->radius && std::abs(p.z()) <= cylinder->length / 2;
  }
  if (const auto* cone = std::get_if<Cone>(&shape)) {
    return std::abs(p.z()) <= cone->length / 2 &&
           rho <= cone->radius * (0.5 - p.z() / cone->length);
  }
  const auto& capsule = std::get<Capsule>(shape);
  const double z = std::clamp(p.z(), -capsule.length / 2, capsule.length / 2);
  return (p - Eigen::Vector3d(0, 0, z)).norm() <= capsule.radius;
}

TEST(ObjectCover, HoldsEveryPointOfTheObjectInBallsThatAreFewAndSmall) {
  const std::vector<Shape> shapes = {Box{{0.2, 0.3, 0.02}}, Box{{0.1, 0.1, 0.1}}, Sphere{0.1},
                                     Cylinder{0.02, 0.4},   Cylinder{0.2, 0.01},  Cone{0.1, 0.2},
                                     Capsule{0.03, 0.3},    Capsule{0.1, 0.0001}};
  std::mt19937_64 generator(1);
  const auto number = [&](double limit) { return limit * (2 * UniformFraction(&generator) - 1); };
  for (std::size_t first = 0; first < shapes.size(); ++first) {
    SCOPED_TRACE(first);
    SceneObject object{"held", Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3)), {}};
    object.X_WO.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
    for (const std::size_t i : {first, (first + 1) % shapes.size()}) {
      object.shapes.push_back({shapes[i], Eigen::Isometry3d(Eigen::Translation3d(0.1, 0, 0.2))});
    }
    const std::vector<Ball> one_each = CoverOf(object, 1);
    const std::vector<Ball> balls = CoverOf(object, 32);
    EXPECT_EQ(one_each.size(), object.shapes.size());
    EXPECT_LE(balls.size(), 32u);
    double volume = 0;
    double volume_of_one_each = 0;
    for (const Ball& ball : balls) volume += std::pow(ball.radius, 3);
    for (const Ball& ball : one_each) volume_of_one_each += std::pow(ball.radius, 3);
    EXPECT_LE(volume, volume_of_one_each);
    int num_inside = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Eigen::Vector3d p_S(number(0.2), number(0.2), number(0.25));
      for (const PlacedShape& placed : object.shapes) {
        const Eigen::Vector3d p = object.X_WO * (placed.X_FS * p_S);
        const double depth = DepthIn(object, p);
        if (!Contains(placed.shape, p_S)) continue;
        ++num_inside;
        EXPECT_TRUE(std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
          return (p - ball.center).norm() <= ball.radius + 1e-12;
        }));
        if (depth <= 0) continue;
        // What is that deep inside of the object is in one of its shapes.
        Eigen::Vector3d way(number(1), number(1), number(1));
        const Eigen::Vector3d q = p + way.normalized() * (depth * (1 - 1e-9));
        EXPECT_TRUE(
            std::any_of(object.shapes.begin(), object.shapes.end(), [&](const PlacedShape& other) {
              return Contains(other.shape, (object.X_WO * other.X_FS).inverse() * q);
            }));
      }
    }
    EXPECT_GT(num_inside, 20);
  }
}

}  // namespace
}  // namespace planbench
