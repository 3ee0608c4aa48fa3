// Starts and goals of published problems, which their authors made to be free.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "collision/collision_checker.h"
#include "robot_model/full_positions.h"
#include "scene/moveit_yaml.h"
#include "tests/support/shared_data.h"

namespace planbench {
namespace {

void ExpectEndsAreFree(const Robot& robot, CollisionModel model) {
  const PlanningGroup& group = robot.groups.front();
  const auto checker = MakeCollisionChecker(robot, group, model);
  int num_problems = 0;
  for (const auto& folder : std::filesystem::directory_iterator(SharedData("problems"))) {
    // Sets of other robots may lie beside them.
    if (!folder.path().filename().string().ends_with("_fetch")) continue;
    const ProblemSet set = ListProblemSet(folder.path());
    for (const ProblemFiles& files : set.problems) {
      const Problem problem = ReadProblem(files.scene, files.request, robot);
      const auto base = FullPositions(robot.model, problem.start.names, problem.start.positions,
                                      files.request.string());
      std::vector<double> start;
      std::vector<double> goal;
      for (const JointSpace::Joint& joint : group.space.joints()) {
        const auto index = static_cast<std::size_t>(robot.model.FindJoint(joint.name));
        start.push_back(base[static_cast<std::size_t>(robot.model.joints()[index].position_index)]);
        const auto wanted =
            std::find_if(problem.goal.begin(), problem.goal.end(),
                         [&](const JointGoal& each) { return each.joint == joint.name; });
        ASSERT_NE(wanted, problem.goal.end()) << files.request;
        goal.push_back(wanted->position);
      }
      checker->SetScene(problem.scene, base);
      for (const auto& q : {start, goal}) {
        const auto contact = checker->FindContact(q);
        EXPECT_FALSE(contact) << files.request << (q == start ? " start: " : " goal: ")
                              << contact->body_a << " against " << contact->body_b;
        EXPECT_TRUE(checker->IsFree(q)) << files.request;
      }
      ++num_problems;
    }
  }
  EXPECT_GT(num_problems, 0);
}

TEST(PublishedProblemsTest, StartsAndGoalsAreFreeForTheSpheres) {
  PLANBENCH_NEED_SHARED_DATA("problems");
  ExpectEndsAreFree(LoadRobot(PLANBENCH_SOURCE_DIR "/robots/fetch"), CollisionModel::kSpheres);
}

TEST(PublishedProblemsTest, StartsAndGoalsAreFreeForTheManufacturersMeshes) {
  PLANBENCH_NEED_SHARED_DATA("problems");
  PLANBENCH_NEED_SHARED_DATA("fetch_description");
  const Robot fetch = LoadRobot(PLANBENCH_SOURCE_DIR "/robots/fetch");
  ExpectEndsAreFree(LoadRefereeRobot(SharedData("fetch_description"), fetch),
                    CollisionModel::kMeshes);
}

}  // namespace
}  // namespace planbench
