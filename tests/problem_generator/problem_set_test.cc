#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "collision/collision_checker.h"
#include "collision/edge_checker.h"
#include "common/read_text.h"
#include "problem_generator/problem_set_maker.h"
#include "problem_generator/query_sampler.h"
#include "robot_model/full_positions.h"
#include "tests/problem_generator/generator_support.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/two_arm_robot.h"

namespace planbench {
namespace {

std::vector<int> FirstIndices(int count) {
  std::vector<int> indices(static_cast<std::size_t>(count));
  std::iota(indices.begin(), indices.end(), 1);
  return indices;
}

std::vector<std::string> Texts(const std::vector<Problem>& problems) {
  std::vector<std::string> texts;
  for (const Problem& problem : problems) {
    texts.push_back(SceneToYaml(problem) + RequestToYaml(problem));
  }
  return texts;
}

class ProblemSetTest : public testing::Test {
 protected:
  ProblemSpec Shipped(const std::string& name) {
    return LoadProblemSpec(ShippedProblems() / (name + ".yaml"), fetch_);
  }
  const Robot fetch_ = LoadFetch();
};

TEST_F(ProblemSetTest, SameSeedSameBytesWhateverTheThreadsAndTheOrder) {
  const ProblemSpec spec = Shipped("shelf_height_rot_test");
  const auto one = Texts(MakeProblems(spec, fetch_, 1, FirstIndices(6), 0, 1).problems);
  EXPECT_EQ(one, Texts(MakeProblems(spec, fetch_, 1, FirstIndices(6), 0, 3).problems));
  const auto some = Texts(MakeProblems(spec, fetch_, 1, {5, 2}, 0, 1).problems);
  EXPECT_EQ(some, (std::vector<std::string>{one[4], one[1]}));
  EXPECT_EQ(std::set<std::string>(one.begin(), one.end()).size(), one.size());
}

TEST_F(ProblemSetTest, OtherSeedsAttemptsAndSetsAreOtherProblems) {
  const ProblemSpec spec = Shipped("shelf_zero_test");
  const auto base = Texts(MakeProblems(spec, fetch_, 1, FirstIndices(3), 0, 1).problems);
  ProblemSpec renamed = spec;
  renamed.name = "another";
  for (const auto& others : {MakeProblems(spec, fetch_, 2, FirstIndices(3), 0, 1),
                             MakeProblems(spec, fetch_, 1, FirstIndices(3), 1, 1),
                             MakeProblems(renamed, fetch_, 1, FirstIndices(3), 0, 1)}) {
    const auto texts = Texts(others.problems);
    for (std::size_t i = 0; i < base.size(); ++i) EXPECT_NE(texts[i], base[i]);
  }
}

TEST_F(ProblemSetTest, WrittenSetsReadBackWithStartsAndGoalsAsSpecified) {
  for (const char* name : {"shelf_zero_test", "shelf_height_test", "shelf_height_rot_test", "box",
                           "cage", "table_pick", "table_under_pick", "shelf_thin"}) {
    SCOPED_TRACE(name);
    const ProblemSpec spec = Shipped(name);
    const TemporaryFolder folder;
    const MadeProblems made = MakeProblems(spec, fetch_, 1, FirstIndices(10), 0, 2);
    WriteProblemSet(made.problems, folder.path());

    const PlanningGroup& group = fetch_.Group(spec.group);
    const auto checker = MakeCollisionChecker(fetch_, group, CollisionModel::kSpheres);
    const ProblemSet set = ListProblemSet(folder.path());
    ASSERT_EQ(set.problems.size(), 10);
    for (const ProblemFiles& files : set.problems) {
      SCOPED_TRACE(files.index);
      const Problem problem = ReadProblem(files.scene, files.request, fetch_);
      const Problem& written = made.problems[static_cast<std::size_t>(files.index - 1)];
      EXPECT_EQ(SceneId(problem.scene), SceneId(written.scene));
      EXPECT_EQ(problem.scene.robot_name, "fetch");
      EXPECT_EQ(problem.scene.world_frame, "base_link");
      EXPECT_EQ(problem.group, "arm_with_torso");
      EXPECT_EQ(problem.time_limit_s, 60);
      ASSERT_EQ(problem.start.names.size(), 15);
      ASSERT_EQ(problem.goal.size(), 8);

      const std::vector<double> full =
          FullPositions(fetch_.model, problem.start.names, problem.start.positions, "start");
      std::vector<double> start, goal;
      for (const int joint : group.joints) {
        const Joint& moved = fetch_.model.joints()[static_cast<std::size_t>(joint)];
        start.push_back(full[static_cast<std::size_t>(moved.position_index)]);
      }
      for (int j = 0; j < group.space.size(); ++j) {
        EXPECT_EQ(problem.goal[static_cast<std::size_t>(j)].joint, group.space.joint(j).name);
        goal.push_back(problem.goal[static_cast<std::size_t>(j)].position);
      }
      checker->SetScene(problem.scene, full);
      for (const auto& end : {start, goal}) {
        EXPECT_EQ(group.space.FirstOutsideLimits(end), -1);
        EXPECT_TRUE(checker->IsFree(end));
        EXPECT_GE(checker->FindClosest(end).distance_m, spec.clearance_m - 1e-9);
      }
      EXPECT_GE(group.space.Distance(start, goal), spec.min_joint_distance);
      EXPECT_FALSE(EdgeChecker(checker.get(), fetch_.edge_resolution_m, EdgeCheck::kFixed)
                       .IsValidEdge(start, goal));
    }
  }
}

TEST(ShippedSets, OfOtherRobotsHaveFreeEndsFromTheRobotsOwnStates) {
  for (const std::string name : {"panda", "ur5e"}) {
    const Robot robot = LoadRobot(name);
    const PlanningGroup& group = robot.groups.front();
    const auto checker = MakeCollisionChecker(robot, group, CollisionModel::kSpheres);
    for (const std::string kind : {"shelf_", "table_"}) {
      if (name == "ur5e" && kind == "shelf_") continue;  // there is none
      SCOPED_TRACE(kind + name);
      const ProblemSpec spec = LoadProblemSpec(ShippedProblems() / (kind + name + ".yaml"), robot);
      const std::vector<double>& ready = group.states.at("ready");
      EXPECT_EQ(spec.queries[0].start.configuration, ready);
      for (const Problem& problem : MakeProblems(spec, robot, 1, FirstIndices(3), 0, 2).problems) {
        checker->SetScene(problem.scene, FullPositions(robot.model, problem.start.names,
                                                       problem.start.positions, "start"));
        EXPECT_TRUE(checker->IsFree(ready));
        std::vector<double> goal;
        for (const auto& joint : problem.goal) goal.push_back(joint.position);
        EXPECT_TRUE(checker->IsFree(goal));
      }
    }
  }
}

// The UR5e as its maker has it: its joints turn twice round.
Robot Ur5eThatTurnsTwice() {
  Robot robot = LoadRobot("ur5e");
  std::string urdf =
      ReadText(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "robots/ur5e/ur5e.urdf");
  const std::string pi = "\"3.141592653589793\" velocity";
  const std::string minus_pi = "lower=\"-3.141592653589793\"";
  for (std::size_t at = 0; (at = urdf.find(minus_pi, at)) != std::string::npos;) {
    urdf.replace(at, minus_pi.size(), "lower=\"-6.283185307179586\"");
    at = urdf.find(pi, at);
    urdf.replace(at, pi.size(), "\"6.283185307179586\" velocity");
  }
  robot.model = RobotModel::FromUrdf(urdf, "ur5e.urdf");
  PlanningGroup& group = robot.groups.front();
  std::vector<std::string> joints;
  for (const JointSpace::Joint& joint : group.space.joints()) joints.push_back(joint.name);
  const std::string& tip = robot.model.links()[static_cast<std::size_t>(group.tip_link)].name;
  const auto states = group.states;
  group = robot.model.MakeGroup(group.name, joints, tip);
  group.states = states;
  return robot;
}

TEST(MadeProblems, HaveEndsAtTheTurnsNearestToEachOther) {
  const Robot robot = Ur5eThatTurnsTwice();
  const JointSpace& space = robot.groups.front().space;
  ASSERT_GT(space.joint(0).upper, 6);
  const ProblemSpec spec = LoadProblemSpec(ShippedProblems() / "table_ur5e.yaml", robot);
  const std::vector<double>& ready = *spec.queries[0].start.configuration;
  int starts = 0;
  int goals = 0;
  for (const Problem& problem : MakeProblems(spec, robot, 1, FirstIndices(12), 0, 2).problems) {
    std::vector<double> goal;
    for (const JointGoal& joint : problem.goal) goal.push_back(joint.position);
    const std::vector<double>& start = problem.start.positions;  // There are no other joints.
    ASSERT_EQ(start.size(), goal.size());
    std::vector<double> nearest = start == ready ? goal : start;
    ++(start == ready ? goals : starts);
    space.ToNearestTurn(ready, nearest);
    EXPECT_EQ(nearest, start == ready ? goal : start) << problem.index;
  }
  EXPECT_GT(starts, 0);
  EXPECT_GT(goals, 0);
}

TEST_F(ProblemSetTest, GripperIsWhereTheQuerySaysWithinTolerances) {
  const ProblemSpec spec = Shipped("shelf_height_rot_test");
  const PlanningGroup& group = fetch_.Group(spec.group);
  int approaches = 0, take_outs = 0;
  for (const Problem& problem : MakeProblems(spec, fetch_, 3, FirstIndices(20), 0, 2).problems) {
    std::vector<double> start(8), goal(8);
    const auto& tuck = *spec.queries[0].start.configuration;
    for (std::size_t j = 0; j < 8; ++j) {
      goal[j] = problem.goal[j].position;
      for (std::size_t i = 0; i < problem.start.names.size(); ++i) {
        if (problem.start.names[i] == problem.goal[j].joint) start[j] = problem.start.positions[i];
      }
    }
    ASSERT_TRUE((start == tuck) != (goal == tuck));
    ++(start == tuck ? approaches : take_outs);
    InverseKinematics kinematics(
        fetch_.model, group,
        FullPositions(fetch_.model, problem.start.names, problem.start.positions, "start"));
    const Eigen::Isometry3d X_BT = kinematics.TipPose(start == tuck ? goal : start);
    bool near_one = false;
    for (const SceneObject& object : problem.scene.objects) {
      // One upright primitive each, so that its pose is the object's.
      if (!object.id.starts_with("can") && !object.id.starts_with("box")) continue;
      const Eigen::Isometry3d X_OT = object.shapes[0].X_FS.inverse() * X_BT;
      const Eigen::Vector3d off = X_OT.translation() - Eigen::Vector3d(-0.0335, 0, 0.03);
      const Eigen::AngleAxisd turn(X_OT.linear());
      near_one = near_one || (off.cwiseAbs().maxCoeff() <= 0.01 + 1e-5 &&
                              (turn.angle() * turn.axis()).cwiseAbs().maxCoeff() <= 0.01 + 1e-5);
    }
    EXPECT_TRUE(near_one) << problem.index;
  }
  EXPECT_GT(approaches, 0);
  EXPECT_GT(take_outs, 0);
}

TEST(MadeProblems, HaveTheTipThatIsNamedAtThePoseAndTheOtherArmAtRest) {
  const Robot robot = MakeTwoArmRobot(/*with_torso=*/true);
  const TemporaryFolder folder;
  const ProblemSpec spec = LoadProblemSpec(WriteTwoArmSpec(folder), robot);
  for (const Problem& problem : MakeProblems(spec, robot, 1, FirstIndices(4), 0, 2).problems) {
    JointState goal;
    for (const JointGoal& joint : problem.goal) {
      goal.names.push_back(joint.joint);
      goal.positions.push_back(joint.position);
    }
    ASSERT_EQ(goal.names[1], "left_shoulder");
    EXPECT_EQ(goal.positions[1], 1.2);
    ASSERT_EQ(goal.names[2], "left_elbow");
    EXPECT_EQ(goal.positions[2], -0.5);
    const auto poses = ComputeLinkPoses(
        robot.model, FullPositions(robot.model, goal.names, goal.positions, "goal"));
    const auto hand = static_cast<std::size_t>(robot.model.FindLink("right_hand"));
    EXPECT_TRUE(poses[hand].translation().isApprox(Eigen::Vector3d(0.7, -0.35, 0), 1e-5));
    EXPECT_TRUE(poses[hand].linear().isIdentity(1e-5));
  }
}

TEST(MadeProblems, OfPosesThatAreMissedByLittleItIsToldByHowMuch) {
  const Robot robot = MakeTwoArmRobot(/*with_torso=*/true);
  const TemporaryFolder folder;
  // Planar arms cannot roll.
  const ProblemSpec spec =
      LoadProblemSpec(WriteTwoArmSpec(folder, "tip: right_hand, rpy: [0.00001, 0, 0], "), robot);
  ExpectInputError([&] { MakeProblems(spec, robot, 1, FirstIndices(1), 0, 1); },
                   {"reach goal: no inverse kinematics solution 5 (nearest: ",
                    " m and 1e-05 rad off; 1e-06 m and 1e-06 rad are allowed)"});
}

TEST(DrawTipPose, TurnsAboutTheObjectBeforeItMovesAndStaysWithinTolerances) {
  GripperSpec gripper;
  gripper.around = {1.5707963267948966, 1.5707963267948966};
  gripper.position = {Range{-0.2, -0.2}, Range{0, 0}, Range{0.1, 0.1}};
  gripper.rpy = {Range{0, 0}, Range{1.5707963267948966, 1.5707963267948966}, Range{0, 0}};
  Eigen::Isometry3d X_BO = Eigen::Isometry3d::Identity();
  X_BO.translation() = Eigen::Vector3d(1, 2, 3);
  RandomStream random("set", 1, 1, 0);
  const Eigen::Isometry3d exact = DrawTipPose(gripper, X_BO, &random);
  EXPECT_TRUE(exact.translation().isApprox(Eigen::Vector3d(1, 1.8, 3.1)));
  // x down, y along the base's -x.
  EXPECT_TRUE((exact.linear() * Eigen::Vector3d::UnitX()).isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE((exact.linear() * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitX()));

  gripper.position_tolerance_m = 0.01;
  gripper.orientation_tolerance_rad = 0.05;
  double most_off = 0, most_turned = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Isometry3d X_error = exact.inverse() * DrawTipPose(gripper, X_BO, &random);
    const Eigen::AngleAxisd turn(X_error.linear());
    most_off = std::max(most_off, X_error.translation().cwiseAbs().maxCoeff());
    most_turned = std::max(most_turned, (turn.angle() * turn.axis()).cwiseAbs().maxCoeff());
  }
  EXPECT_LE(most_off, 0.01);
  EXPECT_GT(most_off, 0.009);
  EXPECT_LE(most_turned, 0.05 + 1e-9);
  EXPECT_GT(most_turned, 0.045);
}

TEST(DrawTipPose, DrawsTheErrorBeforeThePlace) {
  GripperSpec gripper;
  gripper.position = {Range{0, 1}, Range{0, 1}, Range{0, 1}};
  gripper.position_tolerance_m = 0.01;
  RandomStream random("set", 1, 1, 0), same("set", 1, 1, 0);
  same.Draw(gripper.around);
  const Range tolerance{-0.01, 0.01};
  const Eigen::Vector3d error = same.Draw(Range3{tolerance, tolerance, tolerance});
  const Eigen::Vector3d place = same.Draw(gripper.position);
  const Eigen::Isometry3d X_BT = DrawTipPose(gripper, Eigen::Isometry3d::Identity(), &random);
  EXPECT_TRUE(X_BT.translation().isApprox(place + error));
}

class UnsatisfiableTest : public ProblemSetTest {
 protected:
  void ExpectGivesUp(const std::string& text, const std::vector<std::string>& message) {
    const ProblemSpec spec = folder_.Load(text, fetch_);
    for (const int threads : {1, 3}) {
      ExpectInputError([&] { MakeProblems(spec, fetch_, 1, FirstIndices(5), 0, threads); },
                       message);
    }
  }
  const SpecFolder folder_;
};

TEST_F(UnsatisfiableTest, TheSpecificationItselfIsNot) {
  const ProblemSpec spec = folder_.Load(kCanOnTable, fetch_);
  EXPECT_EQ(MakeProblems(spec, fetch_, 1, FirstIndices(3), 0, 1).problems.size(), 3);
}

TEST_F(UnsatisfiableTest, UnreachableQueryNamesItsEnd) {
  ExpectGivesUp(CanOnTableWith("position: [1.0, 0, [0.6, 0.8]]", "position: [4.0, 0, 0.7]"),
                {"spec.yaml:19: queries[0].goal", "problem 1 ('approach')", "20 scenes",
                 "approach goal: no inverse kinematics solution 40"});
}

TEST_F(UnsatisfiableTest, QueryInsideAnObjectNamesItsEnd) {
  ExpectGivesUp(CanOnTableWith("position: [-0.0335, 0, 0.03]", "position: [0, 0, -0.03]"),
                {"spec.yaml:19: queries[0].goal", "approach goal: in collision"});
}

TEST_F(UnsatisfiableTest, SceneThatHitsTheTuckedArmNamesTheStart) {
  ExpectGivesUp(CanOnTableWith("position: [1.0, 0, [0.6, 0.8]]", "position: [0.6, 0, 0.7]"),
                {"spec.yaml:18: queries[0].start", "approach start: in collision 20"});
}

TEST_F(UnsatisfiableTest, PlacementOffTheSupportNamesTheObject) {
  ExpectGivesUp(CanOnTableWith("position: [-0.3, [-0.2, 0.2]]", "position: [-0.49, [-0.2, 0.2]]"),
                {"spec.yaml:12: objects[1]", "can does not stand wholly on its support 20"});
}

TEST_F(UnsatisfiableTest, OverlapNamesTheObject) {
  ExpectGivesUp(CanOnTableWith("  - id: can\n",
                               "  - id: brick\n    position: [0.7, 0, 0.8]\n"
                               "    parts: [{box: [0.2, 0.8, 0.3]}]\n  - id: can\n"),
                {"spec.yaml:12: objects[1]", "brick too near to table"});
}

TEST_F(UnsatisfiableTest, ProblemsThatAreNoneAreNotMade) {
  ExpectGivesUp(CanOnTableWith("min_joint_distance: 1", "min_joint_distance: 30"),
                {"spec.yaml:19: queries[0].goal", "approach: goal too near to the start"});
}

TEST_F(UnsatisfiableTest, ClearanceThatCannotBeKept) {
  ExpectGivesUp(CanOnTableWith("clearance: 0.005", "clearance: 0.5"),
                {"spec.yaml:18: queries[0].start", "approach start: too little clearance 20"});
}

TEST_F(ProblemSetTest, WritingReplacesProblemsAndNothingElse) {
  const TemporaryFolder folder;
  folder.Write("set/scene0007.yaml", "old");
  folder.Write("set/request0007.yaml", "old");
  folder.Write("set/notes.txt", "keep");
  ExpectInputError([&] { RequireProblemFolder(folder / "set", false); }, {"set", "--replace"});
  ExpectInputError([&] { RequireProblemFolder(folder / "set/notes.txt", true); }, {"notes.txt"});
  RequireProblemFolder(folder / "set", true);
  RequireProblemFolder(folder / "new/set", false);

  const auto made = MakeProblems(Shipped("box"), fetch_, 1, {1, 2}, 0, 1);
  for (const char* name : {"set", "new/set"}) {
    WriteProblemSet(made.problems, folder / name);
    const ProblemSet set = ListProblemSet(folder / name);
    ASSERT_EQ(set.problems.size(), 2);
    EXPECT_EQ(set.problems[1].index, 2);
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "set/notes.txt"));
}

}  // namespace
}  // namespace planbench
