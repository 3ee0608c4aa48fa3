#include "sphere_fitting/outer_spheres.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "common/random.h"
#include "geometry/polyhedra.h"
#include "sphere_fitting/cover_proof.h"
#include "sphere_fitting/inner_spheres.h"
#include "tests/sphere_fitting/in_one.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/generated_meshes.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

const Vector3d kHere = Vector3d::Zero();

// A body as a mesh, and whether it is closed, so that its inside counts.
struct Case {
  std::string name;
  TriangleMesh mesh;
  bool closed = true;
};

std::ostream& operator<<(std::ostream& stream, const Case& c) { return stream << c.name; }

std::vector<Case> Cases() {
  TriangleMesh angle = Joined(BoxMesh({0.5, 0.1, 0.1}), BoxMesh({0.1, 0.4, 0.1}), {0.25, 0.2, 0});
  return {
      {"Ring", TorusMesh(0.2, 0.06, 50, 30)},
      {"Sphere", SphereMesh(0.15, 40, 30)},
      {"LongBox", BoxMesh({0.6, 0.1, 0.15})},
      {"TwoBoxesThatOverlap", angle},
      {"TurnedInsideOut", TurnedInsideOut(TorusMesh(0.2, 0.06, 40, 20))},
      {"Hollow", Joined(SphereMesh(0.2, 40, 20), TurnedInsideOut(SphereMesh(0.15, 40, 20)), kHere)},
      {"Sheet", SheetMesh(0.2, 0.4, 40, 40), false},
      {"ManyParts", Joined(Joined(SphereMesh(0.05, 20, 10), SphereMesh(0.03, 20, 10), {0.2, 0, 0}),
                           BoxMesh({0.01, 0.01, 0.3}), {0, 0.1, 0.1})}};
}

LinkBody BodyOf(const TriangleMesh& mesh, const Eigen::Isometry3d& pose) {
  LinkBody body;
  body.Add({Mesh{"", Vector3d::Ones(), mesh}, pose});
  return body;
}

Eigen::Isometry3d SomePose() {
  return Eigen::Translation3d(0.1, -0.2, 0.3) *
         Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
}

Vector3d RandomDirection(std::mt19937_64* random) {
  return Vector3d(UniformFraction(random) - 0.5, UniformFraction(random) - 0.5,
                  UniformFraction(random) - 0.5)
      .normalized();
}

// Fewer samples than a robot deserves: what is proven does not depend on them.
FitGoal Spheres(int spheres) {
  FitGoal goal;
  goal.spheres = spheres;
  goal.samples = 1000;
  return goal;
}
FitGoal Protrusion(double protrusion_m) {
  FitGoal goal;
  goal.protrusion_m = protrusion_m;
  goal.samples = 1000;
  return goal;
}

class SphereSets : public testing::TestWithParam<Case> {
 protected:
  SphereSets() : body_(BodyOf(GetParam().mesh, SomePose())), moved_(GetParam().mesh) {
    for (Vector3d& vertex : moved_.vertices) vertex = SomePose() * vertex;
  }
  // A point in the box around the mesh, or nothing if the mesh does not wind round it.
  std::optional<Vector3d> RandomInside() {
    const Vector3d& a = moved_.vertices[random_() % moved_.vertices.size()];
    const Vector3d& b = moved_.vertices[random_() % moved_.vertices.size()];
    const Vector3d p = a + UniformFraction(&random_) * (b - a);
    if (!GetParam().closed || !WindsRound(moved_, p)) return std::nullopt;
    return p;
  }

  LinkBody body_;
  TriangleMesh moved_;
  std::mt19937_64 random_{7};
};

TEST_P(SphereSets, OuterOnesHoldTheSurfaceAndTheInside) {
  const std::vector<Ball> balls = FitOuterSpheres({body_}, Spheres(9))[0].balls;
  EXPECT_EQ(balls.size(), 9u);
  EXPECT_TRUE(CoverProof(body_).Holds(balls));
  for (int i = 0; i < 5000; ++i) {
    const Vector3d p = RandomSurfacePoint(moved_, &random_);
    EXPECT_TRUE(InOne(balls, p)) << p.transpose();
  }
  for (const Vector3d& vertex : moved_.vertices) EXPECT_TRUE(InOne(balls, vertex));
  for (int i = 0; i < 300; ++i) {
    const auto p = RandomInside();
    EXPECT_TRUE(!p || InOne(balls, *p)) << p->transpose();
  }
}

TEST_P(SphereSets, OuterOnesReachNoFurtherThanTheySay) {
  const std::vector<Ball> balls = FitOuterSpheres({body_}, Protrusion(0.1))[0].balls;
  const double greatest = GreatestProtrusion(body_, balls);
  EXPECT_LE(greatest, 0.1);
  // Points of the surface stand for the body: no point of a ball is far from all of them, or it is
  // inside.
  std::vector<Vector3d> surface;
  for (int i = 0; i < 5000; ++i) surface.push_back(RandomSurfacePoint(moved_, &random_));
  for (int i = 0; i < 50; ++i) {
    const Ball& ball = balls[random_() % balls.size()];
    const Vector3d p = ball.center + ball.radius * RandomDirection(&random_);
    double distance = std::numeric_limits<double>::infinity();
    for (const Vector3d& s : surface) distance = std::min(distance, (s - p).norm());
    if (GetParam().closed && WindsRound(moved_, p)) continue;
    EXPECT_LE(distance, greatest + 0.02) << "5000 points are that dense";
  }
}

TEST_P(SphereSets, InnerOnesAreInside) {
  const std::vector<Ball> balls = FitInnerSpheres(body_, 9);
  EXPECT_EQ(balls.empty(), !GetParam().closed);
  EXPECT_LE(balls.size(), 9u);
  for (const Ball& ball : balls) {
    EXPECT_GT(ball.radius, 0.004);
    for (int i = 0; i < 30; ++i) {
      const Vector3d p = ball.center + ball.radius * RandomDirection(&random_);
      EXPECT_TRUE(WindsRound(moved_, p)) << p.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, SphereSets, testing::ValuesIn(Cases()),
                         [](const auto& info) { return info.param.name; });

TEST(FitOuterSpheres, MoreSpheresAreCloser) {
  const LinkBody box = BodyOf(BoxMesh({0.4, 0.2, 0.1}), SomePose());
  double before = std::numeric_limits<double>::infinity();
  for (const int spheres : {1, 2, 4, 12}) {
    const double reached =
        GreatestProtrusion(box, FitOuterSpheres({box}, Spheres(spheres))[0].balls);
    EXPECT_LT(reached, 0.9 * before);
    before = reached;
  }
  EXPECT_LT(before, 0.04);
}

TEST(FitOuterSpheres, GoWhereTheyAreNeeded) {
  const auto sets = FitOuterSpheres(
      {BodyOf(BoxMesh({0.05, 0.05, 0.05}), SomePose()), BodyOf(BoxMesh({1, 0.1, 0.1}), SomePose())},
      Spheres(12));
  EXPECT_EQ(sets[0].balls.size() + sets[1].balls.size(), 12u);
  EXPECT_LE(sets[0].balls.size(), 2u);
}

TEST(FitOuterSpheres, CylindersAndSpheresOfALink) {
  std::mt19937_64 random(3);
  LinkBody body;
  body.Add({Sphere{0.1}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1))});
  body.Add({Cylinder{0.08, 0.5}, SomePose()});
  const std::vector<Ball> balls = FitOuterSpheres({body}, Spheres(8))[0].balls;
  EXPECT_EQ(balls.size(), 8u);
  EXPECT_EQ(balls.front().radius, 0.1) << "a sphere is its own";
  for (int i = 0; i < 5000; ++i) {
    const double angle = 7 * UniformFraction(&random);
    const double rho = 0.08 * std::min(1.0, 1.5 * UniformFraction(&random));
    const double z = 0.25 * std::clamp(3 * UniformFraction(&random) - 1.5, -1.0, 1.0);
    EXPECT_TRUE(
        InOne(balls, SomePose() * Vector3d(rho * std::cos(angle), rho * std::sin(angle), z)));
  }
  const std::vector<Ball> inner = FitInnerSpheres(body, 4);
  EXPECT_EQ(inner.size(), 4u) << "its own sphere is one of them";
  EXPECT_EQ(inner.front().radius, 0.1);
  for (const Ball& ball : inner) {
    if (ball.radius == 0.1) continue;
    const Vector3d p = SomePose().inverse() * ball.center;
    EXPECT_LE(p.head<2>().norm() + ball.radius, 0.08);
    EXPECT_LE(std::abs(p.z()) + ball.radius, 0.25);
  }
}

TEST(FitOuterSpheres, SaysWhenSpheresAreTooFew) {
  const LinkBody box = BodyOf(BoxMesh({0.05, 0.05, 0.05}), SomePose());
  ExpectInputError(
      [&] {
        FitOuterSpheres({box, box, box}, Spheres(2));
      },
      {"2 spheres", "3 at least"});
}

TEST(FitOuterSpheres, StopsAtTheMostThatALinkMayHave) {
  FitGoal goal = Protrusion(1e-4);
  goal.most_a_link = 5;
  EXPECT_EQ(FitOuterSpheres({BodyOf(BoxMesh({0.1, 0.1, 0.3}), SomePose())}, goal)[0].balls.size(),
            5u);
}

TEST(FitOuterSpheres, TrianglesWithoutAreaAreHeldToo) {
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {0.1, 0, 0}, {0.4, 0, 0}};
  line.triangles = {{0, 1, 2}};
  const LinkBody body = BodyOf(line, Eigen::Isometry3d::Identity());
  const std::vector<Ball> balls = FitOuterSpheres({body}, Spheres(3))[0].balls;
  for (int i = 0; i <= 100; ++i) EXPECT_TRUE(InOne(balls, {0.004 * i, 0, 0}));
  EXPECT_TRUE(FitInnerSpheres(body, 3).empty());
  TriangleMesh point;
  point.vertices = {{1, 2, 3}};
  point.triangles = {{0, 0, 0}};
  const LinkBody small = BodyOf(point, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(InOne(FitOuterSpheres({small}, Spheres(1))[0].balls, {1, 2, 3}));
}

}  // namespace
}  // namespace planbench
