#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "collision/collision_checker.h"
#include "collision/edge_checker.h"
#include "common/error.h"
#include "robot_model/full_positions.h"
#include "scene/moveit_yaml.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/shared_data.h"

namespace planbench {
namespace {
namespace fs = std::filesystem;

using testing::HasSubstr;
using testing::Not;

// What files that people use must come to, for a planar arm of 1.2 m along x that turns to y.
enum class Outcome { kFree, kStartInvalid, kGoalInvalid, kRefused };

struct Case {
  const char* folder;  // Below cases/.
  Outcome outcome;
  std::vector<std::string> says;  // Parts of the refusal, or of one of the warnings.
  int index = 1;
};

void PrintTo(const Case& each, std::ostream* out) { *out << each.folder; }

Problem Read(const Case& each, const Robot& robot) {
  const fs::path folder = SharedData("cases") / each.folder;
  const std::string number = "000" + std::to_string(each.index) + ".yaml";
  return ReadProblem(folder / ("scene" + number), folder / ("request" + number), robot);
}

void ExpectOutcome(const Problem& problem, const Robot& robot, Outcome expected) {
  const PlanningGroup& group = robot.Group(problem.group);
  const std::vector<double> positions =
      FullPositions(robot.model, problem.start.names, problem.start.positions, "start");
  std::vector<double> start;
  std::vector<double> goal;
  for (const int joint : group.joints) {
    const Joint& each = robot.model.joints()[static_cast<std::size_t>(joint)];
    start.push_back(positions[static_cast<std::size_t>(each.position_index)]);
    for (const JointGoal& of_joint : problem.goal) {
      if (of_joint.joint == each.name) goal.push_back(of_joint.position);
    }
  }
  for (const bool exact : {false, true}) {
    const std::unique_ptr<CollisionChecker> checker =
        exact ? MakeReferenceChecker(robot, group, CollisionModel::kSpheres)
              : MakeCollisionChecker(robot, group, CollisionModel::kSpheres);
    checker->SetScene(problem.scene, positions);
    for (const auto& [q, invalid] :
         {std::pair(start, Outcome::kStartInvalid), std::pair(goal, Outcome::kGoalInvalid)}) {
      const std::optional<Contact> contact = checker->FindContact(q);
      EXPECT_EQ(contact.has_value(), expected == invalid);
      if (!contact) continue;
      EXPECT_GE(contact->depth_m, 0);
      EXPECT_THAT(Describe(*contact), Not(HasSubstr("-0")));
    }
    if (expected != Outcome::kFree) continue;
    EdgeChecker edges(checker.get(), robot.edge_resolution_m, robot.edge_check);
    EXPECT_TRUE(edges.IsValidEdge(start, goal));
  }
}

class SharedCase : public testing::TestWithParam<Case> {};

TEST_P(SharedCase, ComesOutAsItIsMeant) {
  const Case& each = GetParam();
  PLANBENCH_NEED_SHARED_DATA(std::string("cases/") + each.folder);
  const Robot robot = LoadRobot(SharedData("cases/robot"));
  if (each.outcome == Outcome::kRefused) {
    try {
      Read(each, robot);
      FAIL() << "accepted";
    } catch (const InputError& error) {
      const std::string message = error.what();
      for (const std::string& part : each.says) EXPECT_THAT(message, HasSubstr(part));
      EXPECT_THAT(message, HasSubstr(SharedData("cases").string())) << "names the file";
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_LT(message.size(), 400u) << message;
    }
    return;
  }
  const Problem problem = Read(each, robot);
  const std::string warnings = testing::PrintToString(problem.warnings);
  EXPECT_EQ(problem.warnings.empty(), each.says.empty()) << warnings;
  for (const std::string& part : each.says) EXPECT_THAT(warnings, HasSubstr(part));
  ExpectOutcome(problem, robot, each.outcome);
}

INSTANTIATE_TEST_SUITE_P(
    All, SharedCase,
    testing::Values(
        Case{"01-fixed-frames/a", Outcome::kStartInvalid, {}},
        Case{"01-fixed-frames/b", Outcome::kFree, {}},
        Case{"01-fixed-frames/c", Outcome::kStartInvalid, {}},
        Case{"02-link-frame/a", Outcome::kGoalInvalid, {}},
        Case{"02-link-frame/b", Outcome::kGoalInvalid, {}},
        Case{"04-merge-keys/a", Outcome::kStartInvalid, {}},
        Case{"05-degrees/a", Outcome::kFree, {}}, Case{"05-degrees/b", Outcome::kFree, {}},
        Case{"05-degrees/c", Outcome::kFree, {}}, Case{"05-degrees/d", Outcome::kFree, {}},
        Case{"06-rostopic-echo/a", Outcome::kStartInvalid, {}},
        Case{"06-rostopic-echo/b", Outcome::kStartInvalid, {}},
        Case{"06-rostopic-echo/c", Outcome::kRefused, {"scene0001.yaml:", "second YAML document"}},
        Case{"06-rostopic-echo/d", Outcome::kFree, {}},
        Case{"06-rostopic-echo/e", Outcome::kStartInvalid, {}},
        Case{"07-multi-dof/a", Outcome::kStartInvalid, {}},
        Case{"07-multi-dof/b",
             Outcome::kRefused,
             {"robot_state.multi_dof_joint_state.transforms[0]", "'base'"}},
        Case{"08-attach-by-id/a", Outcome::kGoalInvalid, {}},
        Case{
            "08-attach-by-id/b", Outcome::kGoalInvalid, {"scene0001.yaml:5", "'tool' is left out"}},
        Case{"08-attach-by-id/c", Outcome::kGoalInvalid, {}},
        Case{"09-object-named-as-link/a",
             Outcome::kRefused,
             {"world.collision_objects[0].id", "'fore'"}},
        Case{"09-object-named-as-link/b", Outcome::kStartInvalid, {}},
        Case{"11-octomap/a", Outcome::kRefused, {"scene0001.yaml"}},
        Case{"11-octomap/b", Outcome::kRefused, {"world.octomap", "unknown field"}},
        Case{"11-octomap/c", Outcome::kRefused, {"world.octomap.octomap.data"}},
        Case{"11-octomap/d", Outcome::kRefused, {"octomap", "its place is world.octomap"}},
        Case{"12-misplaced-objects/a", Outcome::kRefused, {"its place is world.collision_objects"}},
        Case{"50-one-bad-problem/set", Outcome::kFree, {}, 1},
        Case{"50-one-bad-problem/set", Outcome::kRefused, {"world.octomap.octomap"}, 2},
        Case{"50-one-bad-problem/set", Outcome::kFree, {}, 3},
        Case{"51-slash-frame/a", Outcome::kStartInvalid, {}},
        Case{"51-slash-frame/b", Outcome::kStartInvalid, {}},
        Case{"56-zero-quaternion/a", Outcome::kStartInvalid, {"all zero"}},
        Case{"56-zero-quaternion/b", Outcome::kStartInvalid, {"all zero"}},
        Case{"56-zero-quaternion/c", Outcome::kStartInvalid, {"has length 2"}},
        Case{"58-inside/a", Outcome::kStartInvalid, {}},
        Case{"58-inside/b", Outcome::kStartInvalid, {}},
        Case{"58-inside/c", Outcome::kStartInvalid, {}}, Case{"58-inside/d", Outcome::kFree, {}}),
    [](const auto& info) {
      std::string name = info.param.folder + std::string("_") + std::to_string(info.param.index);
      for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
      }
      return name;
    });

TEST(SharedCases, AnglesInDegrees) {
  PLANBENCH_NEED_SHARED_DATA("cases/05-degrees");
  const Robot robot = LoadRobot(SharedData("cases/robot"));
  const auto goal = [&](const char* folder, std::size_t joint) {
    return Read({folder, Outcome::kFree, {}}, robot).goal.at(joint).position;
  };
  EXPECT_NEAR(goal("05-degrees/a", 0), 1.5707963267948966, 1e-15);
  EXPECT_NEAR(goal("05-degrees/b", 0), 1.5707963267948966, 1e-15);
  EXPECT_EQ(goal("05-degrees/c", 0), 1.5);
  EXPECT_NEAR(goal("05-degrees/d", 1), 1.5707963267948966, 1e-15);
}

TEST(SharedCases, TheSecondFingerFollowsTheFirst) {
  PLANBENCH_NEED_SHARED_DATA("cases/16-mimic");
  const Robot robot = LoadRobot(SharedData("cases/16-mimic/robot"));
  ExpectOutcome(Read({"16-mimic/set", Outcome::kFree, {}}, robot), robot, Outcome::kFree);
  const auto poses =
      ComputeLinkPoses(robot.model, FullPositions(robot.model, {"f1"}, {0.03}, "test"));
  const auto y = [&](const char* link) {
    return poses[static_cast<std::size_t>(robot.model.FindLink(link))].translation().y();
  };
  EXPECT_NEAR(y("finger1"), 0.03, 1e-12);
  EXPECT_NEAR(y("finger2"), -0.03, 1e-12);
}

TEST(SharedCases, XacroIsToBeExpanded) {
  PLANBENCH_NEED_SHARED_DATA("cases/17-xacro");
  ExpectInputError([] { LoadRobot(SharedData("cases/17-xacro/robot")); }, {"probe.urdf:", "xacro"});
}

TEST(SharedCases, MeshesThatCannotBeFoundAreNamedWithTheirPlace) {
  PLANBENCH_NEED_SHARED_DATA("cases/54-mesh-uri");
  const Robot robot = LoadRobot(SharedData("cases/robot"));
  for (const auto& [folder, says] :
       {std::pair("find", "$(find arm)"), std::pair("model", "'model://arm/meshes/hand.dae'"),
        std::pair("slash3", "'package:///meshes/hand.stl'")}) {
    SCOPED_TRACE(folder);
    ExpectInputError(
        [&, folder = folder] {
          const Robot referee = LoadRefereeRobot(SharedData("cases/54-mesh-uri") / folder, robot);
          MakeReferenceChecker(referee, referee.groups.front(), CollisionModel::kMeshes);
        },
        {"probe.urdf:", "'hand'", says});
  }
}

TEST(SharedCases, FixedJointsMayBeNamedAtZero) {
  PLANBENCH_NEED_SHARED_DATA("cases/61-gripper-joints");
  const fs::path folder = SharedData("cases/61-gripper-joints");
  const auto text = [&](const char* file) {
    std::ostringstream contents;
    contents << std::ifstream(folder / file).rdbuf();
    return contents.str();
  };
  Robot ur5;
  ur5.name = "ur5_robotiq85";
  ur5.model = RobotModel::FromUrdf(text("ur5.urdf"), "ur5.urdf");
  ur5.groups = {ur5.model.MakeGroup("manipulator",
                                    {"shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint",
                                     "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"},
                                    "ee_link")};
  const Problem problem = ReadProblem(folder / "scene0001.yaml", folder / "request0001.yaml", ur5);
  EXPECT_EQ(problem.goal.size(), 6u);
  std::string request = text("request0001.yaml");
  const std::string zeros = "3.14, 0, 0";
  const std::size_t at = request.find(zeros);
  ASSERT_NE(at, std::string::npos);
  request.replace(at, zeros.size(), "3.14, 0.1, 0");
  ExpectInputError(
      [&] {
        ParseProblem(YamlNode::LoadFile((folder / "scene0001.yaml").string()),
                     YamlNode::Parse(request, "request.yaml"), ur5, {});
      },
      {"request.yaml:", "'robotiq_85_left_inner_knuckle_joint' is fixed", "0.1"});
}

}  // namespace
}  // namespace planbench
