#include "planning/resolve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "common/numbers.h"
#include "support/expect_input_error.h"
#include "support/planning_problems.h"

namespace planbench {
namespace {

class ResolveTest : public testing::Test {
 protected:
  ResolvedQuery Resolve(const JointState& start, const std::vector<JointGoal>& goal) const {
    return ResolveQuery(robot_, robot_.groups.front(), start, goal, "test");
  }

  const Robot robot_ = LoadPlanarRobot();
  const JointState start_ = {{"wrist", "lift", "shoulder", "elbow"}, {0.3, 0.5, 0.1, 0.2}};
  const std::vector<JointGoal> goal_ = {
      {"elbow", 1.2, 0.5, 0.25}, {"shoulder", 3.1, 0.2, 0.1}, {"wrist", 2.5, 0.3, 0.0}};
};

TEST_F(ResolveTest, PutsNamesIntoGroupOrder) {
  const ResolvedQuery query = Resolve(start_, goal_);
  EXPECT_EQ(query.start, (Configuration{0.1, 0.2, 0.3}));
  ASSERT_EQ(query.goals.size(), 1u);
  EXPECT_EQ(query.goals[0].nominal, (Configuration{3.1, 1.2, 2.5}));
  const int lift = robot_.model.FindJoint("lift");
  const int index = robot_.model.joints()[static_cast<std::size_t>(lift)].position_index;
  EXPECT_EQ(query.base_positions[static_cast<std::size_t>(index)], 0.5);
}

TEST_F(ResolveTest, CutsTheBoxAtTheLimits) {
  const GoalBox box = Resolve(start_, goal_).goals.at(0);
  EXPECT_NEAR(box.lower[0], 3.0, 1e-12);
  EXPECT_NEAR(box.upper[0], 3.3, 1e-12) << "continuous: no limits";
  EXPECT_NEAR(box.lower[1], 0.95, 1e-12);
  EXPECT_NEAR(box.upper[1], 1.7, 1e-12);
  EXPECT_NEAR(box.upper[2], 2.6, 1e-12) << "the wrist's limit";
}

TEST_F(ResolveTest, KeepsANominalGoalOutsideTheLimits) {
  std::vector<JointGoal> goal = goal_;
  goal[0] = {"elbow", 3.0, 0.1, 0.1};
  const GoalBox box = Resolve(start_, goal).goals.at(0);
  EXPECT_EQ(box.nominal[1], 3.0);
  EXPECT_LE(box.lower[1], 3.0);
  EXPECT_GE(box.upper[1], 3.0);
}

TEST_F(ResolveTest, AlternativesFollowOneAnother) {
  std::vector<JointGoal> goal = goal_;
  goal.insert(goal.end(), {{"shoulder", 1, 0, 0}, {"wrist", 2, 0, 0}, {"elbow", 0.5, 0, 0}});
  const std::vector<GoalBox> goals = Resolve(start_, goal).goals;
  ASSERT_EQ(goals.size(), 2u);
  EXPECT_EQ(goals[0].nominal, (Configuration{3.1, 1.2, 2.5}));
  EXPECT_EQ(goals[1].nominal, (Configuration{1, 0.5, 2}));
  goal[4] = goal[3];
  ExpectInputError([&] { Resolve(start_, goal); },
                   {"test: alternative 2 of the goal: two goals for joint 'shoulder'"});
  goal.pop_back();
  goal.pop_back();
  ExpectInputError([&] { Resolve(start_, goal); },
                   {"test: alternative 2 of the goal: no goal for joint 'elbow' of group 'arm'"});
}

TEST_F(ResolveTest, RefusesBadInput) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    std::string what;
    std::function<void(JointState*, std::vector<JointGoal>*)> spoil;
    std::vector<std::string> parts;
  };
  const std::vector<Case> cases = {
      {"unknown start joint", [](auto* s, auto*) { s->names[1] = "knee"; }, {"knee"}},
      {"fixed start joint", [](auto* s, auto*) { s->names[1] = "tip_joint"; }, {"tip_joint"}},
      {"repeated start joint", [](auto* s, auto*) { s->names[1] = "elbow"; }, {"elbow"}},
      {"a position too many", [](auto* s, auto*) { s->positions.push_back(0); }, {"test"}},
      {"a position too few", [](auto* s, auto*) { s->positions.pop_back(); }, {"test"}},
      {"start NaN", [](auto* s, auto*) { s->positions[3] = kNan; }, {"elbow", "nan"}},
      {"start infinite", [](auto* s, auto*) { s->positions[1] = kInfinity; }, {"lift", "inf"}},
      {"start lacks a joint of the group",
       [](auto* s, auto*) {
         s->names.pop_back();
         s->positions.pop_back();
       },
       {"elbow"}},
      {"empty start", [](auto* s, auto*) { *s = {}; }, {"shoulder"}},
      {"no goal", [](auto*, auto* g) { g->clear(); }, {"shoulder"}},
      {"goal lacks a joint", [](auto*, auto* g) { g->pop_back(); }, {"wrist"}},
      {"goal repeats a joint", [](auto*, auto* g) { (*g)[1] = g->front(); }, {"elbow"}},
      {"goal outside the group", [](auto*, auto* g) { (*g)[0].joint = "lift"; }, {"lift", "arm"}},
      {"goal NaN", [](auto*, auto* g) { (*g)[0].position = kNan; }, {"elbow", "nan"}},
      {"goal infinite", [](auto*, auto* g) { (*g)[1].position = -kInfinity; }, {"shoulder"}},
      {"negative tolerance", [](auto*, auto* g) { (*g)[0].tolerance_above = -1; }, {"elbow", "-1"}},
      {"negative tolerance below",
       [](auto*, auto* g) { (*g)[2].tolerance_below = -0.1; },
       {"wrist"}},
      {"tolerance NaN", [](auto*, auto* g) { (*g)[0].tolerance_below = kNan; }, {"elbow"}},
      {"tolerance infinite",
       [](auto*, auto* g) { (*g)[0].tolerance_above = kInfinity; },
       {"elbow"}},
  };
  for (const Case& bad : cases) {
    SCOPED_TRACE(bad.what);
    JointState start = start_;
    std::vector<JointGoal> goal = goal_;
    bad.spoil(&start, &goal);
    std::vector<std::string> parts = bad.parts;
    parts.push_back("test");
    ExpectInputError([&] { Resolve(start, goal); }, parts);
  }
}

TEST(GoalBoxTest, ComparesContinuousJointsTheShortWay) {
  const Robot robot = LoadPlanarRobot();
  const JointSpace& space = robot.groups.front().space;
  const GoalBox box = {{3.1, 0, 0}, {3.0, 0, -0.1}, {3.3, 0, 0.1}};
  EXPECT_TRUE(box.Contains(space, Configuration{3.1, 0, 0}));
  EXPECT_TRUE(box.Contains(space, Configuration{-3.1, 0, 0.1}));
  EXPECT_TRUE(box.Contains(space, Configuration{3.1 - 4 * M_PI, 0, -0.1}));
  EXPECT_FALSE(box.Contains(space, Configuration{2.9, 0, 0}));
  EXPECT_FALSE(box.Contains(space, Configuration{-2.9, 0, 0}));
  EXPECT_TRUE(box.Contains(space, Configuration{3.1, 5e-10, 0}));
  EXPECT_FALSE(box.Contains(space, Configuration{3.1, 5e-9, 0}));
  EXPECT_FALSE(box.Contains(space, Configuration{std::nan(""), 0, 0}));
}

TEST_F(ResolveTest, AnInitialPathNamesItsJointsAndLeadsIntoTheGoal) {
  const PlanningGroup& group = robot_.groups.front();
  const ResolvedQuery query = Resolve(start_, goal_);
  std::vector<std::string> names = {"wrist", "shoulder", "elbow"};
  Path path = {{0.3, 0.1, 0.2}, {1, 1, 1}, {2.5, 3.1, 1.2}};
  const auto resolve = [&] { return ResolveInitialPath(group, query, names, path, "test"); };
  EXPECT_EQ(resolve(), (Path{{0.1, 0.2, 0.3}, {1, 1, 1}, {3.1, 1.2, 2.5}}));
  EXPECT_EQ(ResolveInitialPath(group, query, {}, {}, "test"), Path());
  path[0][1] += 5e-10;
  EXPECT_EQ(resolve().front(), query.start) << "but for rounding";

  const auto expect_refused = [&](const std::string& what) {
    ExpectInputError([&] { resolve(); }, {"test: initial_path", what});
  };
  path[2][1] += 1;
  expect_refused("does not end in a goal");
  path[0][1] += 1;
  expect_refused("does not begin at the start");
  path[1][2] = kInfinity;
  expect_refused("of joint 'elbow' is inf");
  path[1] = {1, 1};
  expect_refused("waypoints of 2");
  names[1] = "wrist";
  expect_refused("'wrist' twice");
  names[1] = "lift";
  expect_refused("'lift', which is not in group");
  names = {"wrist"};
  expect_refused("1 joints");
}

TEST_F(ResolveTest, AnInitialPathOfOneWaypointDoesNotBridgeTheGapBetweenStartAndGoal) {
  const PlanningGroup& group = robot_.groups.front();
  const std::vector<std::string> names = {"shoulder", "elbow", "wrist"};
  ResolvedQuery query = Resolve(start_, goal_);
  query.goals = {{query.start, query.start, query.start}};
  for (Configuration* q : {&query.goals[0].nominal, &query.goals[0].lower, &query.goals[0].upper}) {
    (*q)[1] += 1.8e-9;  // Either is within rounding of the middle, not of the other.
  }
  Configuration middle = query.start;
  middle[1] += 0.9e-9;
  ExpectInputError([&] { ResolveInitialPath(group, query, names, {middle}, "test"); },
                   {"does not end in a goal"});
  EXPECT_EQ(
      ResolveInitialPath(group, query, names, {middle, query.goals[0].nominal}, "test").size(), 2u);
}

}  // namespace
}  // namespace planbench
