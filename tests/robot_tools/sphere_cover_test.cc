#include "robot_tools/sphere_cover.h"

#include <gtest/gtest.h>

#include <random>

#include "common/random.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

double Between(double lower, double upper, std::mt19937_64* random) {
  return lower + UniformFraction(random) * (upper - lower);
}

double DistanceToBox(const Vector3d& p, const Vector3d& half) {
  return (p.cwiseAbs() - half).cwiseMax(0).norm();
}

double DistanceToCylinder(const Vector3d& p, const Cylinder& cylinder) {
  return std::hypot(std::max(0.0, p.head<2>().norm() - cylinder.radius),
                    std::max(0.0, std::abs(p.z()) - cylinder.length / 2));
}

// Every point of the shape, drawn from its bounding box, is in a ball; no point of a ball is
// further from the shape than the cover says.
template <typename Distance>
void ExpectCovers(const SphereCover& cover, const Vector3d& half, const Distance& distance,
                  std::mt19937_64* random) {
  ASSERT_FALSE(cover.balls.empty());
  for (int i = 0; i < 200; ++i) {
    Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      // Faces, edges and corners as often as the inside.
      p[axis] = std::clamp(Between(-1.5, 1.5, random), -1.0, 1.0) * half[axis];
    }
    if (distance(p) > 0) continue;
    bool inside = false;
    for (const auto& ball : cover.balls) {
      inside = inside || (p - ball.center).norm() <= ball.radius + 1e-12;
    }
    EXPECT_TRUE(inside) << p.transpose();
  }
  for (int i = 0; i < 200; ++i) {
    const auto& ball = cover.balls[(*random)() % cover.balls.size()];
    const Vector3d direction(Between(-1, 1, random), Between(-1, 1, random),
                             Between(-1, 1, random));
    EXPECT_LE(distance(ball.center + ball.radius * direction.normalized()),
              cover.overshoot_m + 1e-12);
  }
}

TEST(CoverWithSpheres, EnclosesBoxes) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 30; ++i) {
    const Box box{
        {Between(0.01, 0.6, &random), Between(0.01, 0.6, &random), Between(0.01, 0.6, &random)}};
    const SphereCover cover = CoverWithSpheres(box, 0.05, 100);
    EXPECT_LE(cover.balls.size(), 100u);
    ExpectCovers(
        cover, box.size / 2, [&](const Vector3d& p) { return DistanceToBox(p, box.size / 2); },
        &random);
  }
}

TEST(CoverWithSpheres, EnclosesCylindersLongAndFlat) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 30; ++i) {
    const Cylinder cylinder{Between(0.01, 0.3, &random), Between(0.01, 0.8, &random)};
    const SphereCover cover = CoverWithSpheres(cylinder, 0.05, 100);
    EXPECT_LE(cover.balls.size(), 100u);
    ExpectCovers(
        cover, {cylinder.radius, cylinder.radius, cylinder.length / 2},
        [&](const Vector3d& p) { return DistanceToCylinder(p, cylinder); }, &random);
  }
}

TEST(CoverWithSpheres, MoreSpheresForLessOvershoot) {
  const Box box{{0.3, 0.1, 0.1}};
  const SphereCover coarse = CoverWithSpheres(box, 0.05, 100);
  const SphereCover fine = CoverWithSpheres(box, 0.02, 100);
  EXPECT_LE(coarse.overshoot_m, 0.05);
  EXPECT_LE(fine.overshoot_m, 0.02);
  EXPECT_LT(coarse.balls.size(), fine.balls.size());
  EXPECT_GT(CoverWithSpheres(box, 0.02, 5).overshoot_m, 0.02) << "five are too few";
}

TEST(CoverWithSpheres, SpheresAreTheirOwnCoverMeshesHaveNone) {
  const SphereCover cover = CoverWithSpheres(Sphere{0.2}, 0.01, 100);
  ASSERT_EQ(cover.balls.size(), 1u);
  EXPECT_EQ(cover.balls[0].radius, 0.2);
  EXPECT_EQ(cover.overshoot_m, 0);
  ExpectInputError(
      [] {
        CoverWithSpheres(Mesh{"a.stl", Vector3d::Ones(), {}}, 0.01, 100);
      },
      {"mesh"});
}

}  // namespace
}  // namespace planbench
