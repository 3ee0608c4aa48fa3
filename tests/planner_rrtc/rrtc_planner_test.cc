#include "planner_rrtc/rrtc_planner.h"

#include <gtest/gtest.h>

#include "contract/planner_contract.h"
#include "scene/moveit_yaml.h"
#include "support/expect_input_error.h"
#include "support/shared_data.h"

namespace planbench {
namespace {

YamlNode Settings(const std::string& text) { return YamlNode::Parse(text, "rrtc.yaml"); }

std::unique_ptr<Planner> MakeForContract(const Robot& robot) {
  return MakeRrtcPlanner(robot, Settings("range: 1.0"));
}

INSTANTIATE_TEST_SUITE_P(Rrtc, PlannerContract,
                         testing::Values(PlannerFactory{"rrtc", MakeForContract}));

class RrtcPlannerTest : public testing::Test {
 protected:
  const Robot robot_ = LoadPlanarRobot();
};

TEST_F(RrtcPlannerTest, RefusesBadSettingsByFileLineAndKey) {
  ExpectInputError([&] { MakeRrtcPlanner(robot_, Settings("range: 0")); },
                   {"rrtc.yaml:1", "range"});
  ExpectInputError([&] { MakeRrtcPlanner(robot_, Settings("\nrange: far")); },
                   {"rrtc.yaml:2", "range", "far"});
  ExpectInputError([&] { MakeRrtcPlanner(robot_, Settings("range: 1\nrnage: 2")); },
                   {"rrtc.yaml:2", "rnage"});
  ExpectInputError([&] { MakeRrtcPlanner(robot_, Settings("[1, 2]")); }, {"rrtc.yaml"});
}

TEST_F(RrtcPlannerTest, TheFetchsOwnSettingsAreAccepted) {
  const Robot fetch = LoadFetch();
  const YamlNode settings = YamlNode::LoadFile(fetch.planner_settings.at("rrtc").string());
  EXPECT_EQ(MakeRrtcPlanner(fetch, settings)->Describe().settings.count("range"), 1u);
}

TEST_F(RrtcPlannerTest, NoSettingsMeanTheDefault) {
  EXPECT_EQ(MakeRrtcPlanner(robot_, Settings(""))->Describe().settings.at("range"), "1");
}

TEST_F(RrtcPlannerTest, Describes) {
  const PlannerDescription description = MakeForContract(robot_)->Describe();
  EXPECT_EQ(description.algorithm, "RRT-Connect");
  EXPECT_EQ(description.planner_class, PlannerClass::kSamplingGuided);
  EXPECT_TRUE(description.backward);
  EXPECT_FALSE(description.anytime);
  EXPECT_EQ(description.collision_models, AvailableCollisionModels());
}

TEST_F(RrtcPlannerTest, BadRangesOfARequestAreRefused) {
  const std::unique_ptr<Planner> planner = MakeForContract(robot_);
  for (const std::string text : {"0", "-1", "x", "", "[1]"}) {
    PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
    request.parameters["range"] = text;
    const PlanResult result = planner->Plan(request, PostsScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kInvalidRequest) << "range '" << text << "'";
    EXPECT_NE(result.message.find("range"), std::string::npos) << result.message;
  }
}

TEST_F(RrtcPlannerTest, ARangeHoldsForItsRequestOnly) {
  const std::unique_ptr<Planner> planner = MakeForContract(robot_);
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  const PlanResult before = planner->Plan(request, PostsScene(), nullptr);
  request.parameters["range"] = "0.1";
  const PlanResult with_short_range = planner->Plan(request, PostsScene(), nullptr);
  request.parameters.clear();
  const PlanResult after = planner->Plan(request, PostsScene(), nullptr);
  ASSERT_EQ(with_short_range.status, PlanStatus::kSolved);
  const JointSpace& space = robot_.groups.front().space;
  for (std::size_t i = 1; i < with_short_range.path.size(); ++i) {
    EXPECT_LE(space.Distance(with_short_range.path[i - 1], with_short_range.path[i]), 0.1 + 1e-9);
  }
  EXPECT_EQ(before.path, after.path);
}

TEST_F(RrtcPlannerTest, SeedsDecideThePath) {
  const std::unique_ptr<Planner> planner = MakeForContract(robot_);
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  const PlanResult one = planner->Plan(request, PostsScene(), nullptr);
  request.seed = 2;
  const PlanResult two = planner->Plan(request, PostsScene(), nullptr);
  request.seed = 1 + (std::uint64_t{1} << 32);
  const PlanResult far = planner->Plan(request, PostsScene(), nullptr);
  EXPECT_NE(one.path, two.path);
  EXPECT_NE(one.path, far.path);
}

TEST_F(RrtcPlannerTest, CountsItsTreesAndIterations) {
  const PlanResult result = MakeForContract(robot_)->Plan(
      MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0}), PostsScene(), nullptr);
  ASSERT_EQ(result.status, PlanStatus::kSolved);
  EXPECT_GE(result.counters.at("iterations"), 1);
  EXPECT_GE(result.counters.at("states_start_tree"), 1);
  EXPECT_GE(result.counters.at("states_goal_tree"), 1);
  EXPECT_GE(result.counters.at("states_start_tree") + result.counters.at("states_goal_tree"),
            static_cast<double>(result.path.size()));
  EXPECT_GT(result.phases.guidance_s, 0);
  EXPECT_NEAR(result.phases.setup_s + result.phases.collision_s + result.phases.guidance_s +
                  result.phases.search_s,
              result.planning_time_s, 1e-9);
}

TEST_F(RrtcPlannerTest, SolvesPublishedProblems) {
  PLANBENCH_NEED_SHARED_DATA("problems/table_pick_fetch");
  const Robot fetch = LoadFetch();
  const std::unique_ptr<Planner> planner = MakeForContract(fetch);
  const ProblemSet set = ListProblemSet(SharedData("problems/table_pick_fetch"));
  for (const int index : {1, 2, 3}) {
    const ProblemFiles* files = set.Find(index);
    ASSERT_NE(files, nullptr);
    const Problem problem = ReadProblem(files->scene, files->request, fetch.resources);
    PlanRequest request;
    request.group = problem.group;
    request.start = problem.start;
    request.goal = problem.goal;
    request.time_limit_s = 120;
    const PlanResult result = planner->Plan(request, problem.scene, nullptr);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << index << ": " << result.message;
  }
}

}  // namespace
}  // namespace planbench
