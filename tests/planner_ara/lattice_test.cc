#include "planner_ara/lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "common/numbers.h"
#include "planner_ara/default_primitives.h"
#include "support/expect_input_error.h"

namespace planbench {
namespace {

using Coordinates = std::vector<Lattice::Coordinate>;

JointSpace LatticeSpace() {
  return JointSpace({{"lift", false, true, 0.0, 0.38, 0.1},
                     {"elbow", false, false, -1.0, 2.0, 1.0},
                     {"roll", true, false, -kPi, kPi, 1.0}});
}

TEST(Lattice, DefaultCellsOfWideRangesAreNotTooMany) {
  const JointSpace space({{.name = "rail", .prismatic = true, .lower = -1000, .upper = 1000},
                          {.name = "winch", .lower = -1e4, .upper = 1e4},
                          {.name = "bend", .lower = -3, .upper = 3}});
  std::vector<double> cells;
  for (const JointSpace::Joint& joint : space.joints()) cells.push_back(DefaultCell(joint));
  EXPECT_NEAR(cells[2], kPi / 180, 1e-15);
  EXPECT_NO_THROW(Lattice(space, std::vector<double>{0, 0, 0}, cells));
}

TEST(Lattice, AnchorIsAPointOfIt) {
  const std::vector<double> anchor{0.1234, 0.5, 3.0};
  const Lattice lattice(LatticeSpace(), anchor, std::vector<double>{0.005, 0.1, 0.1});
  ASSERT_EQ(lattice.num_joints(), 3);
  for (int j = 0; j < 3; ++j) {
    EXPECT_EQ(lattice.Value(j, lattice.anchor()[static_cast<std::size_t>(j)]),
              anchor[static_cast<std::size_t>(j)]);
  }
}

TEST(Lattice, CoversTheLimitsAndNothingBeyond) {
  const JointSpace space = LatticeSpace();
  const std::vector<double> anchor{0.1234, 0.5, 3.0};
  const Lattice lattice(space, anchor, std::vector<double>{0.005, 0.1, 0.1});
  // lift: 24 cells below (0.1234 / 0.005 = 24.7), 51 above (0.2566 / 0.005 = 51.3), and the anchor.
  EXPECT_EQ(lattice.num_cells(0), 24 + 1 + 51);
  // elbow: whole steps to both limits, which belong to it.
  EXPECT_EQ(lattice.num_cells(1), 31);
  EXPECT_NEAR(lattice.Value(1, 0), -1, 1e-9);
  EXPECT_NEAR(lattice.Value(1, 30), 2, 1e-9);
  for (int j = 0; j < 2; ++j) {
    const Lattice::Coordinate last = static_cast<Lattice::Coordinate>(lattice.num_cells(j) - 1);
    EXPECT_GE(lattice.Value(j, 0), space.joint(j).lower - JointSpace::kLimitTolerance);
    EXPECT_LE(lattice.Value(j, last), space.joint(j).upper + JointSpace::kLimitTolerance);
    EXPECT_LT(lattice.Value(j, 0) - lattice.step(j), space.joint(j).lower);
    EXPECT_GT(lattice.Value(j, last) + lattice.step(j), space.joint(j).upper);
  }
}

TEST(Lattice, AnchorAtOrJustBeyondALimitStillHasItsCell) {
  const std::vector<double> anchor{0.38 + 5e-7, -1.0, 0.0};
  const Lattice lattice(LatticeSpace(), anchor, std::vector<double>{0.005, 0.1, 0.1});
  EXPECT_EQ(lattice.anchor()[0], lattice.num_cells(0) - 1);
  EXPECT_EQ(lattice.Value(0, lattice.anchor()[0]), anchor[0]);
  EXPECT_EQ(lattice.anchor()[1], 0);
}

TEST(Lattice, ContinuousJointHasAWholeNumberOfCells) {
  const std::vector<double> anchor{0.1, 0.5, 3.0};
  const Lattice lattice(LatticeSpace(), anchor, std::vector<double>{0.005, 0.1, 0.1});
  EXPECT_EQ(lattice.num_cells(2), 63);  // 62.83
  EXPECT_DOUBLE_EQ(lattice.step(2), 2 * kPi / 63);
  EXPECT_EQ(lattice.anchor()[2], 0);
  for (int k = 0; k < 63; ++k) {
    const double value = lattice.Value(2, static_cast<Lattice::Coordinate>(k));
    EXPECT_GE(value, -kPi);
    EXPECT_LT(value, kPi);
    EXPECT_NEAR(WrapAngle(value - 3.0 - k * lattice.step(2)), 0, 1e-12);
  }
}

TEST(Lattice, MovesWrapOrStopAtTheLimits) {
  const Lattice lattice(LatticeSpace(), std::vector<double>{0.0, 0.5, 0.0},
                        std::vector<double>{0.005, 0.1, 0.1});
  Lattice::Coordinate moved = 0;
  EXPECT_TRUE(lattice.Move(2, 60, 5, &moved));
  EXPECT_EQ(moved, 2);
  EXPECT_TRUE(lattice.Move(2, 2, -5, &moved));
  EXPECT_EQ(moved, 60);
  EXPECT_TRUE(lattice.Move(2, 7, 63 * 2, &moved));
  EXPECT_EQ(moved, 7);
  EXPECT_TRUE(lattice.Move(1, 22, 8, &moved));
  EXPECT_EQ(moved, 30);
  EXPECT_FALSE(lattice.Move(1, 23, 8, &moved));
  EXPECT_FALSE(lattice.Move(1, 7, -8, &moved));
  EXPECT_TRUE(lattice.Move(1, 8, -8, &moved));
  EXPECT_EQ(moved, 0);
}

TEST(Lattice, NearestCellWrapsOrStopsAtTheLimits) {
  const JointSpace space = LatticeSpace();
  const Lattice lattice(space, std::vector<double>{0.1, 0.5, 3.0},
                        std::vector<double>{0.005, 0.1, 0.1});
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < lattice.num_cells(j); ++k) {
      const auto cell = static_cast<Lattice::Coordinate>(k);
      for (const double offset : {-0.4, 0.0, 0.4}) {
        const double value = lattice.Value(j, cell) + offset * lattice.step(j);
        EXPECT_EQ(lattice.Nearest(j, value), cell) << j << " " << value;
      }
    }
  }
  EXPECT_EQ(lattice.Nearest(0, -100), 0);
  EXPECT_EQ(lattice.Nearest(1, 1e300), lattice.num_cells(1) - 1);
}

TEST(Lattice, RefusesCellsOutOfProportion) {
  const std::vector<double> anchor{0.1, 0.5, 0.0};
  ExpectInputError(
      [&] {
        Lattice(LatticeSpace(), anchor, std::vector<double>{0.005, 1e-6, 0.1});
      },
      {"elbow", "65535"});
  ExpectInputError(
      [&] {
        Lattice(LatticeSpace(), anchor, std::vector<double>{0.005, 0.1, 4.0});
      },
      {"roll", "fewer than 3"});
}

TEST(Lattice, EveryCellOfTheTiniestHasACoordinate) {
  const JointSpace space({{"slide", false, true, 0, 0.0065535, 1}});
  // Positions may be beyond the limits by more than a cell of 1e-7.
  EXPECT_NE(Lattice::WhyNoAxis(space.joint(0), 1e-7), "");
  constexpr double kCell = 1.0001e-7 * (0.0065535 + 2e-6) / 0.0065535;
  EXPECT_EQ(Lattice::WhyNoAxis(space.joint(0), kCell), "");
  for (const double anchor : {-1e-6, 0.003, 0.0065535 + 1e-6}) {
    const Lattice lattice(space, std::vector{anchor}, std::vector{kCell});
    EXPECT_LE(lattice.num_cells(0), 65536);
  }
}

TEST(LatticePoints, OnePointOneNumberWhateverTheRoute) {
  const Lattice lattice(LatticeSpace(), std::vector<double>{0.2, 0.5, 0.0},
                        std::vector<double>{0.005, 0.1, 0.1});
  LatticePoints points(3);
  EXPECT_EQ(points.FindOrAdd(lattice.anchor()), 0U);
  std::mt19937 random(3);
  std::map<Coordinates, std::uint32_t> known{{lattice.anchor(), 0}};
  for (int walk = 0; walk < 50; ++walk) {
    Coordinates at = lattice.anchor();
    for (int step = 0; step < 1000; ++step) {
      const int j = static_cast<int>(random() % 3);
      const int cells = random() % 2 == 0 ? 1 : -1;
      Lattice::Coordinate& coordinate = at[static_cast<std::size_t>(j)];
      if (!lattice.Move(j, coordinate, cells, &coordinate)) continue;
      const std::uint32_t point = points.FindOrAdd(at);
      const auto [entry, is_new] = known.emplace(at, point);
      ASSERT_EQ(entry->second, point);
      if (is_new) {
        ASSERT_EQ(point, points.size() - 1);
      }
    }
  }
  EXPECT_EQ(points.size(), known.size());
  EXPECT_GT(known.size(), 10000U);  // the table has grown more than once
  for (const auto& [coordinates, point] : known) {
    const auto stored = points.Coordinates(point);
    ASSERT_EQ(Coordinates(stored.begin(), stored.end()), coordinates);
    ASSERT_EQ(points.FindOrAdd(coordinates), point);
  }
  EXPECT_GE(points.bytes(), known.size() * 3 * sizeof(Lattice::Coordinate));
}

}  // namespace
}  // namespace planbench
