#include "planner_ara/tip_distance.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <list>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "support/planning_problems.h"

namespace planbench {
namespace {

double Only(std::span<const double> distances) {
  EXPECT_EQ(distances.size(), 1u);
  return distances.front();
}

// The tip of the planar arm is 1.2 m from the axis when the arm is stretched.
class TipDistanceTest : public testing::Test {
 protected:
  TipDistance Distance(const Scene& scene, const Configuration& start, const Configuration& goal) {
    return TipDistance(Grid(scene, robot_, start, goal), goal);
  }
  std::shared_ptr<TipGrid> Grid(const Scene& scene, const Robot& robot, const Configuration& start,
                                const Configuration& goal) {
    scenes_.push_back(scene);
    return std::make_shared<TipGrid>(scenes_.back(), robot.model, robot.groups.front(), base_,
                                     start, goal);
  }

  std::list<Scene> scenes_;  // Grids refer to them.
  const Robot robot_ = LoadPlanarRobot();
  const std::vector<double> base_ = std::vector<double>(4, 0.0);
  const Configuration left_ = {0.4, 0, 0};
  const Configuration right_ = {-0.4, 0, 0};
};

TEST_F(TipDistanceTest, IsZeroAtTheGoalAndTheCrowsWayInFreeSpace) {
  TipDistance distance = Distance(EmptyPlanarScene(), left_, right_);
  EXPECT_EQ(Only(distance(right_)), 0);
  // The tips are 2 * 1.2 * sin(0.4) = 0.93 m apart along y; a cell is 0.07 m.
  EXPECT_NEAR(Only(distance(left_)), 0.93, 0.08);
  EXPECT_LT(Only(distance(Configuration{0, 0, 0})), Only(distance(left_)));
}

TEST_F(TipDistanceTest, LeadsRoundObstacles) {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "wall", {2.0, 0, 0}, {2.3, 0.05, 2});  // from 0.85 m ahead
  const Configuration left = {0.2, 0, 0};
  const Configuration right = {-0.2, 0, 0};
  TipDistance free = Distance(EmptyPlanarScene(), left, right);
  TipDistance round = Distance(scene, left, right);
  EXPECT_EQ(Only(round(right)), 0);
  EXPECT_GT(Only(round(left)), Only(free(left)) + 0.15);
}

TEST_F(TipDistanceTest, GoalsThatAreWalledInAreFarFromEverywhere) {
  Scene scene = EmptyPlanarScene();
  AddBox(&scene, "wall", {0, 0, 0}, {8, 0.05, 8});
  TipDistance distance = Distance(scene, left_, right_);
  EXPECT_EQ(Only(distance(right_)), 0);
  EXPECT_EQ(Only(distance(left_)), Only(distance(Configuration{0.5, 0, 0})));
  EXPECT_GT(Only(distance(left_)), Only(distance(Configuration{-0.6, 0, 0})));
}

TEST_F(TipDistanceTest, BeyondTheGridTheNearestCellCounts) {
  TipDistance distance = Distance(EmptyPlanarScene(), {0.1, 0, 0}, {0, 0, 0});
  EXPECT_GT(Only(distance(Configuration{3.1, 0, 0})), 0);
  EXPECT_LT(Only(distance(Configuration{3.1, 0, 0})), 2);
}

TEST_F(TipDistanceTest, DoesNotDependOnWhatWasAskedBefore) {
  TipDistance one = Distance(PostsScene(), left_, right_);
  TipDistance other = Distance(PostsScene(), left_, right_);
  std::vector<double> forward, backward;
  for (int k = 0; k <= 20; ++k) forward.push_back(Only(one(Configuration{-2 + 0.2 * k, 0.5, 0})));
  for (int k = 20; k >= 0; --k)
    backward.push_back(Only(other(Configuration{-2 + 0.2 * k, 0.5, 0})));
  EXPECT_EQ(forward, std::vector<double>(backward.rbegin(), backward.rend()));
}

TEST_F(TipDistanceTest, SeveralTipsAreAsFarAsEachAlone) {
  Robot two_tips = robot_;
  PlanningGroup& group = two_tips.groups.front();
  const int elbow = robot_.model.links()[static_cast<std::size_t>(group.tip_link)].parent_joint;
  group.more_tips = {robot_.model.joints()[static_cast<std::size_t>(elbow)].parent_link};
  Robot other_tip = robot_;
  other_tip.groups.front().tip_link = group.more_tips.front();
  TipDistance both(Grid(PostsScene(), two_tips, left_, right_), right_);
  TipDistance tip = Distance(PostsScene(), left_, right_);
  TipDistance other(Grid(PostsScene(), other_tip, left_, right_), right_);
  EXPECT_THAT(both(right_), testing::ElementsAre(0, 0));
  const std::span<const double> distances = both(left_);
  ASSERT_EQ(distances.size(), 2u);
  EXPECT_NEAR(distances[0], Only(tip(left_)), 0.08);  // the grids are not the same
  EXPECT_NEAR(distances[1], Only(other(left_)), 0.08);
}

TEST_F(TipDistanceTest, TwoDistancesShareAGridThatIsMarkedOnce) {
  const auto grid = Grid(PostsScene(), robot_, left_, right_);
  EXPECT_TRUE(grid->passages().empty());
  TipDistance there(grid, right_);
  TipDistance back(grid, left_);
  EXPECT_EQ(Only(there(left_)), Only(back(right_)));
  EXPECT_FALSE(grid->passages().empty());
  scenes_.back() = Scene();  // No longer read.
  TipDistance again(grid, right_);
  EXPECT_EQ(Only(again(left_)), Only(there(left_)));
}

// Steps from a cell to every other, cell by cell; where there is no way one more than to the last
// passage.
std::vector<int> StepsFrom(const TipGrid& grid, std::size_t goal) {
  const auto [nx, ny, nz] = grid.size();
  const auto passage = [&, width = nx](std::size_t cell) {
    const std::size_t x = cell % static_cast<std::size_t>(width);
    const std::size_t row = cell / static_cast<std::size_t>(width) * grid.words_a_row();
    return (grid.passages()[row + x / 64] >> x % 64 & 1) != 0;
  };
  std::vector<int> steps(grid.num_cells(), 0);
  std::vector<std::size_t> queue = {goal};
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const std::size_t from = queue[next];
    if (from != goal && !passage(from)) continue;
    for (int dk = -1; dk <= 1; ++dk) {
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          const std::size_t to = from + static_cast<std::size_t>((dk * ny + dj) * nx + di);
          if (to == goal || steps[to] != 0) continue;
          steps[to] = steps[from] + 1;
          queue.push_back(to);
        }
      }
    }
  }
  int longest = 0;
  for (const std::size_t cell : queue) {
    if (passage(cell)) longest = std::max(longest, steps[cell]);
  }
  std::replace(steps.begin(), steps.end(), 0, longest + 1);
  steps[goal] = 0;
  return steps;
}

// A gantry: grids more than 64 and more than 128 cells wide, which are several words a row.
TEST(TipDistance, IsThatOfASearchCellByCell) {
  const RobotModel model = RobotModel::FromUrdf(
      R"(<robot name="gantry"><link name="base"/><link name="x"/><link name="y"/><link name="z"/>
      <joint name="x" type="prismatic"><parent link="base"/><child link="x"/><axis xyz="1 0 0"/>
        <limit lower="0" upper="9" velocity="1" effort="1"/></joint>
      <joint name="y" type="prismatic"><parent link="x"/><child link="y"/><axis xyz="0 1 0"/>
        <limit lower="0" upper="1" velocity="1" effort="1"/></joint>
      <joint name="z" type="prismatic"><parent link="y"/><child link="z"/><axis xyz="0 0 1"/>
        <limit lower="0" upper="1" velocity="1" effort="1"/></joint></robot>)",
      "gantry.urdf");
  const PlanningGroup group = model.MakeGroup("all", {"x", "y", "z"}, "z");
  std::mt19937 random(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (const double length : {1.0, 4.5, 9.0}) {
    SCOPED_TRACE(length);
    Scene scene;
    scene.world_frame = "base";
    for (int i = 0; i < 12; ++i) {
      AddBox(&scene, "box" + std::to_string(i), {between(0, length), between(0, 1), between(0, 1)},
             {between(0.05, 0.4), between(0.2, 1.2), between(0.2, 1.2)});
    }
    const Configuration start = {0, 0, 0};
    const Configuration goal = {length, 1, 1};
    const auto grid =
        std::make_shared<TipGrid>(scene, model, group, std::vector<double>(3, 0.0), start, goal);
    TipDistance distance(grid, goal);
    EXPECT_EQ(Only(distance(goal)), 0);
    EXPECT_EQ(grid->words_a_row(), static_cast<std::size_t>(grid->size()[0] + 63) / 64);
    const std::vector<int> steps = StepsFrom(*grid, grid->CellsOf(goal).front());
    for (int i = 0; i < 300; ++i) {
      const Configuration q = {between(-0.4, length + 0.4), between(-0.4, 1.4), between(-0.4, 1.4)};
      const std::size_t cell = grid->CellsOf(q).front();
      EXPECT_NEAR(Only(distance(q)), steps[cell] * grid->resolution(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace planbench
