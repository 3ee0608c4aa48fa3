#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "common/content_hash.h"
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

// Hash of the scene ids of a set, in order.
const std::map<std::string, std::string> kContent = {
    {"bookshelf_small_fetch", "a3d5f6e3ba00ef6630d3a2afa5e10be6"},
    {"box_fetch", "69ef147757406eb629c77da2d3f30672"},
    {"table_pick_fetch", "c8e36f62611d7aadcb7717c9f2aaa10c"},
    {"bookshelf_small_panda", "db5a9c03f939b33a0adfba22d03a6d9a"},
    {"box_panda", "d624db3f9798447c4e51a69516cc9790"},
    {"cage_panda", "bbec1ab1da117de34edb4ebd8365e2dc"},
};

class PublishedSet : public testing::TestWithParam<std::string> {};

TEST_P(PublishedSet, LoadsAndSurvivesTheRoundTrip) {
  const std::string below = "problems/" + GetParam();
  PLANBENCH_NEED_SHARED_DATA(below);
  const Robot fetch = LoadRobot(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "robots/fetch");
  const ProblemSet set = ListProblemSet(SharedData(below));
  EXPECT_EQ(set.name, GetParam());
  EXPECT_EQ(set.problems.size(), 100);
  std::set<std::string> ids;
  ContentHash all_ids;
  for (const ProblemFiles& files : set.problems) {
    SCOPED_TRACE(files.scene.string());
    const Problem problem = ReadProblem(files.scene, files.request, fetch);
    EXPECT_EQ(problem.index, files.index);
    EXPECT_EQ(problem.set, GetParam());
    CheckFetchProblem(problem);
    ids.insert(SceneId(problem.scene));
    all_ids.Add(SceneId(problem.scene));

    const std::string scene_yaml = SceneToYaml(problem);
    const std::string request_yaml = RequestToYaml(problem);
    const Problem again = ParseProblem(YamlNode::Parse(scene_yaml, "written scene"),
                                       YamlNode::Parse(request_yaml, "written request"), fetch, {});
    EXPECT_EQ(SceneId(again.scene), SceneId(problem.scene));
    EXPECT_EQ(again.scene.allowed_collisions, problem.scene.allowed_collisions);
    EXPECT_EQ(again.start.names, problem.start.names);
    EXPECT_EQ(again.start.positions, problem.start.positions);
    EXPECT_EQ(SceneToYaml(again), scene_yaml);
    EXPECT_EQ(RequestToYaml(again), request_yaml);
  }
  EXPECT_EQ(ids.size(), 100) << "two problems of a set have the same scene";
  EXPECT_EQ(all_ids.HexDigest(), kContent.at(GetParam())) << "recorded sessions name these scenes";
}

INSTANTIATE_TEST_SUITE_P(MotionBenchMaker, PublishedSet,
                         testing::Values("bookshelf_small_fetch", "box_fetch", "table_pick_fetch"),
                         [](const auto& info) { return info.param; });

// The Panda as the manufacturer describes it: the fingers fixed where the files say they are.
class PandaSet : public testing::TestWithParam<std::string> {};

TEST_P(PandaSet, Loads) {
  const std::string below = "problems/" + GetParam();
  PLANBENCH_NEED_SHARED_DATA(below);
  PLANBENCH_NEED_SHARED_DATA("panda_description/panda.urdf");
  const std::filesystem::path urdf = SharedData("panda_description/panda.urdf");
  std::ostringstream text;
  text << std::ifstream(urdf).rdbuf();
  Robot panda;
  panda.name = "panda";
  panda.model = RobotModel::FromUrdf(text.str(), urdf.string());
  panda.groups = {
      panda.model.MakeGroup("panda_arm",
                            {"panda_joint1", "panda_joint2", "panda_joint3", "panda_joint4",
                             "panda_joint5", "panda_joint6", "panda_joint7"},
                            "panda_hand")};
  ContentHash all_ids;
  for (const ProblemFiles& files : ListProblemSet(SharedData(below)).problems) {
    const Problem problem = ReadProblem(files.scene, files.request, panda);
    EXPECT_EQ(problem.scene.world_frame, "panda_link0");
    EXPECT_TRUE(problem.warnings.empty()) << problem.warnings.front();
    all_ids.Add(SceneId(problem.scene));
  }
  EXPECT_EQ(all_ids.HexDigest(), kContent.at(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(MotionBenchMaker, PandaSet,
                         testing::Values("bookshelf_small_panda", "box_panda", "cage_panda"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace planbench
