#include <gtest/gtest.h>

#include <filesystem>

#include "common/read_text.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

TEST(EmbeddedProblems, ShelfDemoLoadsAndIsCanonical) {
  const ProblemSet set =
      ListProblemSet(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "problems" / "shelf_demo");
  EXPECT_EQ(set.problems.size(), 6);
  const Robot fetch = LoadRobot(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "robots" / "fetch");
  for (const ProblemFiles& files : set.problems) {
    SCOPED_TRACE(files.scene.string());
    const Problem problem = ReadProblem(files.scene, files.request, fetch);
    EXPECT_TRUE(problem.warnings.empty());
    EXPECT_EQ(problem.set, "shelf_demo");
    EXPECT_EQ(problem.scene.world_frame, "base_link");
    EXPECT_EQ(problem.group, "arm_with_torso");
    EXPECT_EQ(problem.goal.size(), 8);
    EXPECT_EQ(problem.start.names.size(), 15);
    EXPECT_GE(problem.scene.objects.size(), 5);
    EXPECT_EQ(ReadText(files.scene), SceneToYaml(problem));
    EXPECT_EQ(ReadText(files.request), RequestToYaml(problem));
  }
}

}  // namespace
}  // namespace planbench
