#include "collision/fcl/sphere_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace planbench {
namespace {

class SphereTreeTest : public testing::Test {
 protected:
  std::vector<Ball> RandomBalls(int num) {
    std::vector<Ball> balls;
    for (int i = 0; i < num; ++i) balls.push_back({RandomPoint(), 0.01 + 0.2 * Unit()});
    return balls;
  }
  Eigen::Vector3d RandomPoint() { return {Unit() * 2 - 1, Unit() * 2 - 1, Unit() * 2 - 1}; }
  double Unit() { return std::uniform_real_distribution<double>()(generator_); }

  std::mt19937_64 generator_{5};
};

TEST_F(SphereTreeTest, AnswersAsAllSpheresDo) {
  for (int num : {0, 1, 2, 3, 17, 100}) {
    SCOPED_TRACE(num);
    const auto balls = RandomBalls(num);
    const SphereTree tree(balls);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d center = 2 * RandomPoint();
      const double radius = 0.3 * Unit();
      double expected = std::numeric_limits<double>::infinity();
      for (const auto& ball : balls) {
        expected = std::min(expected, (ball.center - center).norm() - ball.radius - radius);
      }
      EXPECT_EQ(tree.Touches(center, radius), expected <= 0);
      EXPECT_DOUBLE_EQ(tree.Distance(center, radius, std::numeric_limits<double>::infinity()),
                       expected);
      EXPECT_DOUBLE_EQ(tree.Distance(center, radius, 0.2), std::min(expected, 0.2));
    }
  }
}

TEST_F(SphereTreeTest, NodesAndBoxEncloseTheirSpheres) {
  const SphereTree tree = SphereTree(RandomBalls(60));
  EXPECT_EQ(tree.num_spheres(), 60);
  const auto nodes = tree.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = i; k < static_cast<std::size_t>(nodes[i].next); ++k) {
      if (!nodes[k].leaf) continue;
      EXPECT_LE((nodes[k].center - nodes[i].center).norm() + nodes[k].radius,
                nodes[i].radius * (1 + 1e-9));
      EXPECT_TRUE((((nodes[k].center - tree.box_center()).cwiseAbs().array() + nodes[k].radius) <=
                   tree.box_half_size().array() + 1e-12)
                      .all());
    }
  }
}

TEST_F(SphereTreeTest, MovesToAnotherFrame) {
  const auto balls = RandomBalls(20);
  const SphereTree tree(balls);
  Pose X_AS;
  X_AS.rotation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  X_AS.translation << 1, -2, 0.5;
  const SphereTree moved = tree.Transformed(X_AS);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d center = RandomPoint();
    EXPECT_NEAR(moved.Distance(X_AS * center, 0.1, 10), tree.Distance(center, 0.1, 10), 1e-12);
  }
}

}  // namespace
}  // namespace planbench
