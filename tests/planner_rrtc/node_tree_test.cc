#include "planner_rrtc/node_tree.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "common/numbers.h"

namespace planbench {
namespace {

JointSpace MakeSpace(const std::vector<bool>& continuous) {
  std::vector<JointSpace::Joint> joints;
  for (const bool c : continuous) {
    joints.push_back({fmt::format("j{}", joints.size()), c, false, c ? -kPi : -2, c ? kPi : 2, 1});
  }
  return JointSpace(std::move(joints));
}

class NodeTreeTest : public testing::TestWithParam<std::vector<bool>> {
 protected:
  std::vector<double> Random() {
    std::vector<double> q;
    for (const JointSpace::Joint& joint : space_.joints()) {
      q.push_back(std::uniform_real_distribution<double>(joint.lower, joint.upper)(generator_));
    }
    return q;
  }

  const JointSpace space_ = MakeSpace(GetParam());
  std::mt19937_64 generator_{1};
};

TEST_P(NodeTreeTest, FindsWhatBruteForceFinds) {
  NodeTree tree(space_);
  for (const int size : {1, 2, 15, 16, 17, 31, 100, 1000}) {
    while (tree.size() < size) tree.Add(Random(), tree.size() - 1);
    for (int i = 0; i < 50; ++i) {
      const std::vector<double> q = Random();
      double nearest = 1e9;
      for (int node = 0; node < size; ++node) {
        nearest = std::min(nearest, space_.Distance(q, {tree.Positions(node), q.size()}));
      }
      const NodeTree::Neighbor found = tree.Nearest(q.data());
      ASSERT_GE(found.node, 0);
      ASSERT_LT(found.node, size);
      EXPECT_NEAR(found.distance, nearest, 1e-5);
      EXPECT_NEAR(space_.Distance(q, {tree.Positions(found.node), q.size()}), nearest, 1e-5);
    }
  }
}

TEST_P(NodeTreeTest, KeepsNodesAsTheyWereAdded) {
  NodeTree tree(space_);
  std::vector<std::vector<double>> added;
  for (int i = 0; i < 100; ++i) {
    added.push_back(Random());
    EXPECT_EQ(tree.Add(added.back(), i == 0 ? NodeTree::kNoParent : i / 2), i);
  }
  for (int i = 0; i < 100; ++i) {
    const std::vector<double>& q = added[static_cast<std::size_t>(i)];
    EXPECT_EQ(std::vector<double>(tree.Positions(i), tree.Positions(i) + q.size()), q);
    EXPECT_EQ(tree.Parent(i), i == 0 ? NodeTree::kNoParent : i / 2);
    EXPECT_EQ(tree.Nearest(q.data()).node, i);
  }
}

TEST_P(NodeTreeTest, OfEquallyNearNodesTheFirstIsFound) {
  NodeTree tree(space_);
  const std::vector<double> twin = Random();
  const std::vector<double> other = Random();
  for (int i = 0; i < 5; ++i) tree.Add(other, NodeTree::kNoParent);
  for (int i = 0; i < 60; ++i) tree.Add(twin, 0);
  EXPECT_EQ(tree.Nearest(twin.data()).node, 5);
  EXPECT_EQ(tree.Nearest(other.data()).node, 0);
}

TEST_P(NodeTreeTest, IsEmptyAfterClearing) {
  NodeTree tree(space_);
  const std::vector<double> before = Random();
  for (int i = 0; i < 40; ++i) tree.Add(before, i - 1);
  tree.Clear();
  EXPECT_EQ(tree.size(), 0);
  const std::vector<double> after = Random();
  EXPECT_EQ(tree.Add(after, NodeTree::kNoParent), 0);
  EXPECT_NEAR(tree.Nearest(before.data()).distance, space_.Distance(before, after), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Spaces, NodeTreeTest,
                         testing::Values(std::vector<bool>{false}, std::vector<bool>{true},
                                         std::vector<bool>{true, false, false},
                                         std::vector<bool>{false, false, false, true, false, true,
                                                           false, true}));

TEST(NodeTree, LooksTheShortWayRound) {
  NodeTree tree(MakeSpace({true}));
  tree.Add(std::vector<double>{-3.0}, NodeTree::kNoParent);
  tree.Add(std::vector<double>{1.0}, 0);
  const double q = 3.1;
  EXPECT_EQ(tree.Nearest(&q).node, 0);
  EXPECT_NEAR(tree.Nearest(&q).distance, 2 * kPi - 6.1, 1e-5);
}

}  // namespace
}  // namespace planbench
