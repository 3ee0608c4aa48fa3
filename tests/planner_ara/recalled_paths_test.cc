#include "planner_ara/recalled_paths.h"

#include <gtest/gtest.h>

#include "common/numbers.h"

namespace planbench {
namespace {

constexpr int kNone = RecalledPaths::kNone;

class RecalledPathsTest : public testing::Test {
 protected:
  std::vector<Lattice::Coordinate> Point(const Configuration& q) const {
    return {lattice_.Nearest(0, q[0]), lattice_.Nearest(1, q[1])};
  }
  std::array<int, 2> NeighboursOf(const Configuration& q) const {
    return recalled_.NeighboursOf(Point(q), q);
  }

  const JointSpace space_{
      {{"elbow", false, false, -2.0, 2.0, 1.0}, {"roll", true, false, -kPi, kPi, 1.0}}};
  const Lattice lattice_{space_, std::vector{0.0, 0.0}, std::vector{0.1, kPi / 30}};
  // Waypoints 0 to 2, the second of which lies next to another, and 3 and 4.
  const std::vector<Path> paths_ = {{{0.02, 0}, {1.01, 0}, {0.98, 0}, {1.5, 0}},
                                    {{-1, 3}, {-5, -3}}};
  const RecalledPaths recalled_{space_, lattice_, {1, 1}, paths_};
};

TEST_F(RecalledPathsTest, WaypointsMoveToTheNearestPointOfTheLattice) {
  EXPECT_EQ(recalled_.ConfigurationOf(0)[0], 0);
  EXPECT_NEAR(recalled_.ConfigurationOf(1)[0], 1, 1e-12);
  EXPECT_NEAR(recalled_.ConfigurationOf(3)[1], 29 * kPi / 30, 1e-12);
  EXPECT_NEAR(recalled_.ConfigurationOf(4)[0], -2, 1e-12) << "its limit";
  for (int waypoint = 0; waypoint < 5; ++waypoint) {
    for (int j = 0; j < 2; ++j) {
      const auto i = static_cast<std::size_t>(j);
      EXPECT_EQ(lattice_.Value(j, recalled_.CoordinatesOf(waypoint)[i]),
                recalled_.ConfigurationOf(waypoint)[i]);
    }
  }
}

TEST_F(RecalledPathsTest, WaypointsAreJoinedAlongTheirPath) {
  EXPECT_EQ(NeighboursOf({0, 0}), (std::array{1, kNone}));
  EXPECT_EQ(NeighboursOf({1, 0}), (std::array{2, 0}));
  EXPECT_EQ(NeighboursOf({1.5, 0}), (std::array{1, kNone}));
  EXPECT_EQ(NeighboursOf({-1, 3}), (std::array{4, kNone}));
  EXPECT_EQ(NeighboursOf({-2, -3}), (std::array{3, kNone}));
}

TEST_F(RecalledPathsTest, OtherPointsAreJoinedToTheNearestWaypoint) {
  EXPECT_EQ(NeighboursOf({0.4, 0.1}), (std::array{0, kNone}));
  EXPECT_EQ(NeighboursOf({0.6, 0.1}), (std::array{1, kNone}));
  EXPECT_EQ(NeighboursOf({-1.4, -3.1}), (std::array{3, kNone})) << "the short way round";
  EXPECT_EQ(RecalledPaths(space_, lattice_, {1, 1}, {})
                .NeighboursOf(Point({0, 0}), std::vector{0.0, 0.0}),
            (std::array{kNone, kNone}));
}

}  // namespace
}  // namespace planbench
