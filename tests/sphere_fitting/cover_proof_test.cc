#include "sphere_fitting/cover_proof.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "geometry/polyhedra.h"
#include "tests/sphere_fitting/in_one.h"
#include "tests/support/generated_meshes.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

LinkBody BodyOf(const TriangleMesh& mesh) {
  LinkBody body;
  body.Add({Mesh{"", Vector3d::Ones(), mesh}, Eigen::Isometry3d::Identity()});
  return body;
}

// Balls along the edges and over the faces of a cube of edge length 2; its middle is bare.
std::vector<Ball> BallsOnACube(double radius) {
  std::vector<Ball> balls;
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
          Vector3d center;
          center[axis] = side;
          center[(axis + 1) % 3] = 0.5 * i;
          center[(axis + 2) % 3] = 0.5 * j;
          balls.push_back({center, radius});
        }
      }
    }
  }
  return balls;
}

TEST(CoverProof, SeesThatTheInsideIsBare) {
  const LinkBody cube = BodyOf(BoxMesh({2, 2, 2}));
  const CoverProof proof(cube);
  std::vector<Ball> balls = BallsOnACube(0.5);
  EXPECT_FALSE(proof.Holds(balls));
  for (const Vector3d& p : proof.FindBarePoints(balls, 0.01, 0.01)) {
    EXPECT_LT(p.cwiseAbs().maxCoeff(), 0.9) << "the surface is covered";
    EXPECT_FALSE(InOne(balls, 0.999 * p));
  }
  balls.push_back({{0, 0, 0}, 1.2});
  EXPECT_TRUE(proof.Holds(balls));
  // A hollow cube does not need the middle.
  const LinkBody hollow =
      BodyOf(Joined(BoxMesh({2, 2, 2}), TurnedInsideOut(BoxMesh({1.8, 1.8, 1.8})), {0, 0, 0}));
  balls.pop_back();
  EXPECT_TRUE(CoverProof(hollow).Holds(balls));
}

TEST(CoverProof, ClosesVoidsAndGaps) {
  std::mt19937_64 random(1);
  const LinkBody cube = BodyOf(BoxMesh({2, 2, 2}));
  const CoverProof proof(cube);
  for (const double radius : {0.5, 0.34}) {
    std::vector<Ball> balls = BallsOnACube(radius);
    proof.Close(&balls);
    EXPECT_TRUE(proof.Holds(balls));
    for (int i = 0; i < 2000; ++i) {
      const Vector3d p(2 * UniformFraction(&random) - 1, 2 * UniformFraction(&random) - 1,
                       2 * UniformFraction(&random) - 1);
      EXPECT_TRUE(InOne(balls, p)) << p.transpose();
    }
  }
}

TEST(CoverProof, OneBallIsEnoughIfItIsLargeEnough) {
  const LinkBody cube = BodyOf(BoxMesh({2, 2, 2}));
  const CoverProof proof(cube);
  EXPECT_FALSE(proof.Holds({}));
  EXPECT_FALSE(proof.Holds({{{0, 0, 0}, 1.7320}}));
  EXPECT_TRUE(proof.Holds({{{0, 0, 0}, 1.7321}}));
  std::vector<Ball> balls = {{{0.1, 0, 0}, 0.1}};
  proof.Close(&balls);
  EXPECT_NEAR(balls[0].radius, Vector3d(1.1, 1, 1).norm(), 2e-6);
}

// Voids whose corners are all that betrays them: balls around a point that just miss it.
TEST(CoverProof, FindsTheSmallestVoids) {
  const LinkBody body = BodyOf(SphereMesh(0.5, 30, 20));
  const CoverProof proof(body);
  std::vector<Ball> balls;
  for (int corner = 0; corner < 8; corner += 1) {
    const Vector3d direction =
        Vector3d((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1)
            .normalized();
    balls.push_back({0.5 * direction, 0.5 - 1e-5});
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.45, 0.45}) balls.push_back({side * Vector3d::Unit(axis), 0.4});
  }
  EXPECT_FALSE(proof.Holds(balls)) << "the middle is bare by 0.01 mm";
  balls.push_back({{0, 0, 0}, 0.01});
  EXPECT_TRUE(proof.Holds(balls));
}

TEST(CoverProof, VoidsAreClosedFromTheirMiddle) {
  const LinkBody body = BodyOf(SphereMesh(0.5, 30, 20));
  const CoverProof proof(body);
  std::vector<Ball> balls;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d direction =
        Vector3d((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1)
            .normalized();
    balls.push_back({0.5 * direction, 0.47});
  }
  const auto bare = proof.FindBarePoints(balls, 0.01, 0.5);
  EXPECT_TRUE(std::any_of(bare.begin(), bare.end(), [](const Vector3d& p) {
    return p.norm() < 1e-3;
  })) << "none of the points is in the middle, where balls are farthest";
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.45, 0.45}) balls.push_back({side * Vector3d::Unit(axis), 0.42});
  }
  std::vector<Ball> closed = balls;
  proof.Close(&closed);
  EXPECT_TRUE(proof.Holds(closed));
  double grown = 0;
  for (std::size_t k = 0; k < balls.size(); ++k) {
    grown = std::max(grown, closed[k].radius - balls[k].radius);
  }
  EXPECT_LT(grown, 0.05) << "the void is 3 cm to each side";
}

}  // namespace
}  // namespace planbench
