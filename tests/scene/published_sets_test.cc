#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "common/error.h"
#include "scene/moveit_yaml.h"
#include "tests/support/shared_data.h"

namespace planbench {
namespace {

// What holds for every problem of MotionBenchMaker's Fetch sets.
void CheckFetchProblem(const Problem& problem) {
  EXPECT_EQ(problem.scene.world_frame, "base_link");
  EXPECT_EQ(problem.scene.robot_name, "fetch");
  EXPECT_TRUE(problem.scene.fixed_frames.empty());
  EXPECT_TRUE(problem.scene.attached.empty());
  EXPECT_FALSE(problem.scene.objects.empty());
  for (const SceneObject& object : problem.scene.objects) EXPECT_EQ(object.shapes.size(), 1);

  EXPECT_EQ(problem.group, "arm_with_torso");
  EXPECT_EQ(problem.time_limit_s, 60);
  EXPECT_EQ(problem.goal.size(), 8);
  std::set<std::string> goal_joints;
  for (const JointGoal& goal : problem.goal) {
    goal_joints.insert(goal.joint);
    EXPECT_EQ(goal.tolerance_above, 0);
    EXPECT_EQ(goal.tolerance_below, 0);
    EXPECT_LE(std::abs(goal.position), 3.15);
  }
  EXPECT_TRUE(goal_joints.contains("torso_lift_joint"));
  EXPECT_TRUE(goal_joints.contains("wrist_roll_joint"));

  EXPECT_EQ(problem.start.names.size(), 15);
  EXPECT_EQ(problem.start.positions.size(), 15);
  EXPECT_EQ(problem.scene_state.names.size(), 15);
  const auto torso =
      std::find(problem.start.names.begin(), problem.start.names.end(), "torso_lift_joint");
  ASSERT_NE(torso, problem.start.names.end());
  EXPECT_GT(problem.start.positions[torso - problem.start.names.begin()], 0);

  ASSERT_TRUE(problem.workspace);
  EXPECT_EQ(problem.workspace->max_corner, Eigen::Vector3d(1, 1, 1));

  const AllowedCollisionMatrix& matrix = problem.scene.allowed_collisions;
  EXPECT_TRUE(matrix.Allowed("wrist_flex_link", "wrist_roll_link"));
  EXPECT_FALSE(matrix.Allowed("torso_lift_link", "shoulder_lift_link"));
}

class PublishedSet : public testing::TestWithParam<std::string> {};

TEST_P(PublishedSet, LoadsAndSurvivesTheRoundTrip) {
  const std::string below = "problems/" + GetParam();
  PLANBENCH_NEED_SHARED_DATA(below);
  const ProblemSet set = ListProblemSet(SharedData(below));
  EXPECT_EQ(set.name, GetParam());
  EXPECT_EQ(set.problems.size(), 100);
  std::set<std::string> ids;
  for (const ProblemFiles& files : set.problems) {
    SCOPED_TRACE(files.scene.string());
    const Problem problem = ReadProblem(files.scene, files.request, {});
    EXPECT_EQ(problem.index, files.index);
    EXPECT_EQ(problem.set, GetParam());
    CheckFetchProblem(problem);
    ids.insert(SceneId(problem.scene));

    const std::string scene_yaml = SceneToYaml(problem);
    const std::string request_yaml = RequestToYaml(problem);
    const YamlNode scene_node = YamlNode::Parse(scene_yaml, "written scene");
    Problem again;
    again.scene = ReadScene(scene_node, {});
    ReadRequest(YamlNode::Parse(request_yaml, "written request"), &again);
    EXPECT_EQ(SceneId(again.scene), SceneId(problem.scene));
    EXPECT_EQ(again.scene.allowed_collisions, problem.scene.allowed_collisions);
    EXPECT_EQ(again.start.names, problem.start.names);
    EXPECT_EQ(again.start.positions, problem.start.positions);
    again.scene_state = problem.scene_state;
    EXPECT_EQ(SceneToYaml(again), scene_yaml);
    EXPECT_EQ(RequestToYaml(again), request_yaml);
  }
  EXPECT_EQ(ids.size(), 100) << "two problems of a set have the same scene";
}

INSTANTIATE_TEST_SUITE_P(MotionBenchMaker, PublishedSet,
                         testing::Values("bookshelf_small_fetch", "box_fetch", "table_pick_fetch"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace planbench
