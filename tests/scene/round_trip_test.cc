#include <gtest/gtest.h>

#include <filesystem>

#include "common/error.h"
#include "common/read_text.h"
#include "tests/scene/problem_texts.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {
namespace fs = std::filesystem;

void ExpectEqual(const Problem& a, const Problem& b) {
  EXPECT_EQ(SceneId(a.scene), SceneId(b.scene));
  EXPECT_EQ(a.scene.name, b.scene.name);
  EXPECT_EQ(a.scene.robot_name, b.scene.robot_name);
  EXPECT_EQ(a.scene.allowed_collisions, b.scene.allowed_collisions);
  ASSERT_EQ(a.scene.fixed_frames.size(), b.scene.fixed_frames.size());
  for (std::size_t i = 0; i < a.scene.fixed_frames.size(); ++i) {
    EXPECT_EQ(a.scene.fixed_frames[i].frame, b.scene.fixed_frames[i].frame);
    EXPECT_EQ(a.scene.fixed_frames[i].X_WF.matrix(), b.scene.fixed_frames[i].X_WF.matrix());
  }
  EXPECT_EQ(a.group, b.group);
  EXPECT_EQ(a.start.names, b.start.names);
  EXPECT_EQ(a.start.positions, b.start.positions);
  EXPECT_EQ(a.time_limit_s, b.time_limit_s);
  ASSERT_EQ(a.goal.size(), b.goal.size());
  for (std::size_t i = 0; i < a.goal.size(); ++i) {
    EXPECT_EQ(a.goal[i].joint, b.goal[i].joint);
    EXPECT_EQ(a.goal[i].position, b.goal[i].position);
    EXPECT_EQ(a.goal[i].tolerance_above, b.goal[i].tolerance_above);
    EXPECT_EQ(a.goal[i].tolerance_below, b.goal[i].tolerance_below);
  }
  ASSERT_EQ(a.workspace.has_value(), b.workspace.has_value());
  if (a.workspace) {
    EXPECT_EQ(a.workspace->frame, b.workspace->frame);
    EXPECT_EQ(a.workspace->min_corner, b.workspace->min_corner);
    EXPECT_EQ(a.workspace->max_corner, b.workspace->max_corner);
  }
}

class RoundTrip : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Writes, reads, writes again; expects equal problems and bytes.
  Problem Check(const Problem& problem, const Robot& robot = TextRobot()) {
    const fs::path scene = folder_ / "scene0042.yaml";
    const fs::path request = folder_ / "request0042.yaml";
    WriteProblem(problem, scene, request);
    const Problem again = ReadProblem(scene, request, robot);
    EXPECT_EQ(again.index, 42);
    EXPECT_EQ(again.set, folder_.filename().string());
    ExpectEqual(problem, again);
    EXPECT_EQ(ReadText(scene), SceneToYaml(again));
    EXPECT_EQ(ReadText(request), RequestToYaml(again));
    return again;
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) /
      (std::string("planbench_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(RoundTrip, EveryField) { Check(ParseProblem(kFullScene)); }

TEST_F(RoundTrip, AlternativesOfTheGoal) {
  Problem problem = ParseProblem(kFullScene);
  problem.goal.insert(problem.goal.end(), {{"a_joint", 1.0 / 3, 0, 0},
                                           {"b_joint", 1, 0.5, 0},
                                           {"a_joint", -2, 0, 0},
                                           {"b_joint", 0, 0, 0}});
  Check(problem);
}

TEST_F(RoundTrip, NearlyNothing) {
  Problem problem;
  problem.scene.world_frame = "base_link";
  problem.group = "arm";
  problem.start = {.names = {"a_joint", "b_joint"}, .positions = {0, 0}};
  problem.goal = {{.joint = "a_joint", .position = 1}, {.joint = "b_joint", .position = 1}};
  Check(problem);
}

TEST_F(RoundTrip, TextThatYamlWouldTakeForSomethingElse) {
  Problem problem = ParseProblem(kFullScene);
  constexpr const char* kUrdf = R"(<robot name="fetch">
  <link name="no"/><link name="gripper_link"/>
  <joint name="null" type="continuous"><parent link="no"/><child link="gripper_link"/></joint>
  <joint name="~" type="fixed"><parent link="gripper_link"/><child link="yes"/></joint>
  <link name="yes"/></robot>)";
  Robot robot;
  robot.model = RobotModel::FromUrdf(kUrdf, "text.urdf");
  robot.groups = {robot.model.MakeGroup("true", {"null"}, "yes")};
  problem.scene.world_frame = "no";
  problem.workspace->frame = "no";
  problem.group = "true";
  problem.start = {{"null", "~"}, {0.5, 0}};
  problem.goal = {{.joint = "null", .position = 1}};
  problem.scene.name = "two\nlines: \"quoted\" # \\ \t";
  problem.scene.objects[0].id = "1.5";
  problem.scene.objects[1].id = "- a: [b]";
  problem.scene.objects[2].id =
      "Dose n\xc3\xba"
      "mero";
  Check(problem, robot);
}

TEST_F(RoundTrip, NumbersThatNeedAllTheirDigits) {
  Problem problem = ParseProblem(kFullScene);
  problem.start.positions = {0.1 + 0.2, 5e-324};
  problem.goal[0].position = 1.7976931348623157e308;
  problem.goal[1].position = -1.0 / 3;
  problem.scene.objects[0].X_WO.translation() =
      Eigen::Vector3d(1e-17, -2.0 / 3, 123456789.123456789);
  Check(problem);
}

TEST_F(RoundTrip, MixedShapesOfOneObject) {
  Problem problem = ParseProblem(kFullScene);
  // A mesh before a primitive: files keep two lists, which must not change what the scene is.
  std::vector<PlacedShape>& shapes = problem.scene.objects[2].shapes;
  PlacedShape cone;
  cone.shape = Cone{.radius = 1, .length = 2};
  shapes.push_back(cone);
  Check(problem);
}

TEST_F(RoundTrip, Planes) {
  Problem problem = ParseProblem(kFullScene);
  // Before the mesh; files list planes apart.
  std::vector<PlacedShape>& shapes = problem.scene.objects[2].shapes;
  PlacedShape floor{HalfSpace{}, shapes.front().X_FS};
  floor.X_FS.translation().z() -= 0.1;
  shapes.insert(shapes.begin(), floor);
  problem.scene.objects[0].shapes = {{HalfSpace{}}};
  Check(problem);
}

TEST_F(RoundTrip, WorkspacesInAnyFrame) {
  Check(ParseProblem(kFullScene, Replaced(kFullRequest, "frame_id: base_link", "frame_id: shelf")));
}

TEST_F(RoundTrip, CapsulesCannotBeWritten) {
  Problem problem = ParseProblem(kFullScene);
  problem.scene.objects[2].shapes.push_back({Capsule{0.1, 0.2}});
  ExpectInputError([&] { SceneToYaml(problem); }, {problem.scene.objects[2].id, "no capsules"});
}

TEST_F(RoundTrip, OctomapsCannotBeWritten) {
  Problem problem = ParseProblem(kFullScene);
  problem.scene.objects[2].id = kOctomapId;
  ExpectInputError([&] { SceneToYaml(problem); }, {"'<octomap>': octomaps cannot be written"});
}

TEST_F(RoundTrip, PosesOfJoints) {
  constexpr const char* kUrdf = R"(<robot name="fetch">
  <link name="base_link"/><link name="cart"/><link name="gripper_link"/>
  <joint name="roll" type="planar"><parent link="base_link"/><child link="cart"/></joint>
  <joint name="turn" type="continuous"><parent link="cart"/><child link="gripper_link"/></joint>
</robot>)";
  Robot robot;
  robot.model = RobotModel::FromUrdf(kUrdf, "cart.urdf");
  robot.groups = {robot.model.MakeGroup("arm", {"turn"}, "gripper_link")};
  Problem problem;
  problem.scene.world_frame = "base_link";
  problem.group = "arm";
  problem.start = {robot.model.position_names(), {1, 2, 0, 0, 0, 0.6, 0.8, 0.5}};
  problem.goal = {{.joint = "turn", .position = 1}};
  Check(problem, robot);
}

TEST_F(RoundTrip, OnlyDefaultEntries) {
  Problem problem = ParseProblem(kFullScene);
  problem.scene.allowed_collisions = {};
  problem.scene.allowed_collisions.SetDefaultEntry("shelf", true);
  Check(problem);
}

TEST_F(RoundTrip, LinksThatAnEntryHasChecked) {
  Problem problem = ParseProblem(kFullScene);
  problem.scene.allowed_collisions.SetEntry("mast", "gripper_link", false);
  const Problem again = Check(problem);
  EXPECT_EQ(again.scene.allowed_collisions.Entry("mast", "gripper_link"), std::optional(false));
}

TEST_F(RoundTrip, UnwritableFolderIsNamed) {
  EXPECT_THROW(WriteProblem(ParseProblem(kFullScene), folder_ / "none" / "s.yaml",
                            folder_ / "none" / "r.yaml"),
               InputError);
}

}  // namespace
}  // namespace planbench
