#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/read_text.h"
#include "tests/scene_server/tiny_world.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class PathCheck : public ::testing::Test {
 protected:
  explicit PathCheck(bool with_mesh_robot = false, const std::string& below_mesh_robot = "")
      : world_(with_mesh_robot, below_mesh_robot) {}

  /// A path from start to goal over the can.
  PathCheckRequestMessage Request() {
    PathCheckRequestMessage request;
    request.request_id = "id";
    const ProblemMessage problem = world_.service().AnswerProblem({"id", "cans", 1}).problem;
    request.scene_id = problem.scene_id;
    request.group = problem.group;
    request.start = problem.start;
    request.goal = problem.goal;
    request.joint_names = {"swing", "lift"};
    request.path = {{kStartSwing, 0}, {kStartSwing, 0.4}, {kGoalSwing, 0.4}, {kGoalSwing, 0}};
    request.step_m = 0.01;
    return request;
  }
  PathCheckReplyMessage Check(const PathCheckRequestMessage& request) {
    return world_.service().AnswerPathCheck(request);
  }
  /// The verdict of a path that could be judged.
  PathVerdict Judge(const PathCheckRequestMessage& request) {
    const PathCheckReplyMessage reply = Check(request);
    EXPECT_TRUE(reply.ok) << reply.message;
    EXPECT_TRUE(reply.verdict.has_value());
    return reply.verdict.value_or(PathVerdict{});
  }
  /// The message of a refusal.
  std::string Refusal(const PathCheckRequestMessage& request) {
    const PathCheckReplyMessage reply = Check(request);
    EXPECT_FALSE(reply.ok);
    EXPECT_FALSE(reply.verdict.has_value());
    EXPECT_EQ(reply.request_id, "id");
    return reply.message;
  }

  TinyWorld world_;
};

// By a referee with the planning robot's root, and by one on a pedestal.
class MeshPathCheck : public PathCheck, public testing::WithParamInterface<std::string> {
 protected:
  MeshPathCheck() : PathCheck(/*with_mesh_robot=*/true, GetParam()) {}
};
INSTANTIATE_TEST_SUITE_P(Roots, MeshPathCheck, testing::Values("", kPedestal),
                         [](const auto& info) { return info.param.empty() ? "Same" : "Other"; });

TEST_F(PathCheck, AcceptsAValidPath) {
  const PathCheckReplyMessage reply = Check(Request());
  ASSERT_TRUE(reply.ok) << reply.message;
  EXPECT_EQ(reply.request_id, "id");
  EXPECT_FALSE(reply.engine.empty());
  EXPECT_EQ(reply.step_m, 0.01);
  ASSERT_TRUE(reply.verdict);
  EXPECT_TRUE(reply.verdict->valid) << reply.verdict->reason;
  EXPECT_NEAR(reply.verdict->measures.at("path_length"), 0.4 + 2 + 0.4, 1e-12);
  // The tip is the finger, 0.05 m out, as the scene's state has it.
  EXPECT_NEAR(reply.verdict->measures.at("tip_travel"), 0.4 + 2 * 0.55 + 0.4, 1e-3);
  EXPECT_GT(reply.verdict->num_samples, 100);
  EXPECT_FALSE(reply.verdict->measures.contains("clearance"));  // not asked for
  EXPECT_FALSE(reply.mesh_verdict);
}

TEST_F(PathCheck, APathMayEndInAnyAlternativeOfTheGoal) {
  PathCheckRequestMessage request = Request();
  request.path.pop_back();
  EXPECT_THAT(Judge(request).reason, HasSubstr("goal"));
  request.goal.insert(request.goal.end(), {{"swing", kGoalSwing, 0, 0}, {"lift", 0.4, 0, 0}});
  EXPECT_TRUE(Judge(request).valid);
  request.goal.pop_back();
  EXPECT_THAT(Refusal(request), AllOf(HasSubstr("alternative 2"), HasSubstr("'lift'")));
}

TEST_F(PathCheck, GivesClearanceWhenAsked) {
  PathCheckRequestMessage request = Request();
  request.with_clearance = true;
  const PathVerdict verdict = Judge(request);
  ASSERT_TRUE(verdict.valid) << verdict.reason;
  // Straight above the can: the arm's axis at 0.5 m, less the radius, over a can of 0.2 m.
  EXPECT_NEAR(verdict.measures.at("clearance"), 0.25, 1e-3);
  EXPECT_GT(verdict.measures.at("clearance_mean"), verdict.measures.at("clearance"));
}

TEST_F(PathCheck, FinerStepTakesMoreSamples) {
  PathCheckRequestMessage request = Request();
  const int coarse = Judge(request).num_samples;
  request.step_m = 0.001;
  EXPECT_GT(Judge(request).num_samples, 9 * coarse);
}

TEST_F(PathCheck, RejectsAPathThroughACan) {
  PathCheckRequestMessage request = Request();
  request.path = {{kStartSwing, 0}, {kGoalSwing, 0}};
  const PathVerdict verdict = Judge(request);
  EXPECT_FALSE(verdict.valid);
  EXPECT_EQ(verdict.segment, 0);
  EXPECT_NEAR(verdict.fraction, (1 - 2 * std::asin(0.1)) / 2, 0.02);
  ASSERT_TRUE(verdict.contact);
  EXPECT_EQ(verdict.contact->body_b, "can");
}

TEST_F(PathCheck, RejectsAWrongStartAndAWrongGoal) {
  PathCheckRequestMessage request = Request();
  request.path.front()[0] += 0.01;
  EXPECT_THAT(Judge(request).reason, HasSubstr("start"));
  request = Request();
  request.path.back()[0] += 0.01;
  EXPECT_THAT(Judge(request).reason, HasSubstr("goal"));
}

TEST_F(PathCheck, RejectsAWaypointOutsideTheLimits) {
  PathCheckRequestMessage request = Request();
  request.path[1][1] = 0.6;
  EXPECT_THAT(Judge(request).reason, AllOf(HasSubstr("waypoint 1"), HasSubstr("'lift'")));
  request.path[1][1] = 1e9;  // rejected, not refused for its samples
  EXPECT_THAT(Judge(request).reason, AllOf(HasSubstr("waypoint 1"), HasSubstr("'lift'")));
}

TEST_F(PathCheck, RejectsAnEmptyPath) {
  PathCheckRequestMessage request = Request();
  request.path.clear();
  request.joint_names.clear();
  EXPECT_THAT(Judge(request).reason, HasSubstr("empty"));
}

TEST_F(PathCheck, TakesJointsInAnyOrder) {
  PathCheckRequestMessage request = Request();
  request.joint_names = {"lift", "swing"};
  for (Configuration& q : request.path) std::swap(q[0], q[1]);
  const PathVerdict verdict = Judge(request);
  EXPECT_TRUE(verdict.valid) << verdict.reason;
  EXPECT_NEAR(verdict.measures.at("path_length"), 2.8, 1e-12);
}

TEST_F(PathCheck, RejectsWaypointsOfOtherJoints) {
  PathCheckRequestMessage request = Request();
  request.joint_names = {"swing", "elbow"};
  EXPECT_THAT(Judge(request).reason, HasSubstr("'elbow'"));
  request = Request();
  request.joint_names = {"swing"};
  for (Configuration& q : request.path) q.pop_back();
  EXPECT_THAT(Judge(request).reason, HasSubstr("does not name joint 'lift'"));
  request = Request();
  request.joint_names = {"swing", "swing"};
  EXPECT_THAT(Judge(request).reason, HasSubstr("'swing' twice"));
  EXPECT_FALSE(Judge(request).valid);
}

TEST_F(PathCheck, RejectsWaypointsOfTheWrongSize) {
  PathCheckRequestMessage request = Request();
  request.path[2].push_back(0);
  EXPECT_THAT(Judge(request).reason, HasSubstr("waypoint 2 has 3 positions"));
}

TEST_F(PathCheck, HoldsTheJointsOutsideTheGroup) {
  PathCheckRequestMessage request = Request();
  request.path = {{kStartSwing, 0}, {-3, 0}, {3, 0}, {kGoalSwing, 0}};  // past the post
  EXPECT_TRUE(Judge(request).valid) << Judge(request).reason;
  request.start.positions.back() = 0.3;  // the finger
  const PathVerdict verdict = Judge(request);
  EXPECT_FALSE(verdict.valid);
  ASSERT_TRUE(verdict.contact);
  EXPECT_EQ(verdict.contact->body_b, "post");
}

TEST_F(PathCheck, VoxelPathsAreJudgedWithSpheres) {
  PathCheckRequestMessage request = Request();
  request.collision_model = CollisionModel::kVoxels;
  EXPECT_TRUE(Judge(request).valid);
  request.path = {{kStartSwing, 0}, {kGoalSwing, 0}};
  EXPECT_FALSE(Judge(request).valid);
}

TEST_F(PathCheck, RefusesABadStep) {
  PathCheckRequestMessage request = Request();
  for (const double step_m : {0.0, -0.01, std::nan("")}) {
    request.step_m = step_m;
    EXPECT_THAT(Refusal(request), HasSubstr("step_m"));
  }
  request.step_m = 1e-9;
  EXPECT_THAT(Refusal(request), AllOf(HasSubstr("step_m"), HasSubstr("samples")));
}

TEST_F(PathCheck, RefusesWhatItDoesNotKnow) {
  PathCheckRequestMessage request = Request();
  request.scene_id = "0123";
  EXPECT_THAT(Refusal(request), HasSubstr("'0123'"));
  request = Request();
  request.group = "legs";
  EXPECT_THAT(Refusal(request), HasSubstr("'legs'"));
  request = Request();
  request.start.names[0] = "torso";
  EXPECT_THAT(Refusal(request), HasSubstr("'torso'"));
  request = Request();
  request.goal.pop_back();
  EXPECT_THAT(Refusal(request), HasSubstr("'lift'"));
}

TEST_P(MeshPathCheck, GivesBothVerdicts) {
  // The spheres pass above the can; the mesh, 1 m tall, does not.
  PathCheckReplyMessage reply = Check(Request());
  ASSERT_TRUE(reply.ok) << reply.message;
  EXPECT_TRUE(reply.verdict->valid) << reply.verdict->reason;
  ASSERT_TRUE(reply.mesh_verdict);
  EXPECT_FALSE(reply.mesh_verdict->valid);
  EXPECT_EQ(reply.mesh_verdict->segment, 1);
  ASSERT_TRUE(reply.mesh_verdict->contact);
  EXPECT_EQ(reply.mesh_verdict->contact->body_a, "arm");
  EXPECT_EQ(reply.mesh_verdict->contact->body_b, "can");

  PathCheckRequestMessage the_other_way = Request();
  the_other_way.path = {{kStartSwing, 0}, {-3, 0}, {3, 0}, {kGoalSwing, 0}};
  the_other_way.with_clearance = true;
  reply = Check(the_other_way);
  ASSERT_TRUE(reply.ok) << reply.message;
  ASSERT_TRUE(reply.mesh_verdict);
  EXPECT_TRUE(reply.mesh_verdict->valid) << reply.mesh_verdict->reason;
  EXPECT_EQ(reply.mesh_verdict->measures.at("path_length"),
            reply.verdict->measures.at("path_length"));
  EXPECT_GT(reply.verdict->measures.at("clearance"), 0);
  EXPECT_FALSE(reply.mesh_verdict->measures.contains("clearance"));
}

TEST_P(MeshPathCheck, RejectsWaypointsOfOtherJointsWithBoth) {
  PathCheckRequestMessage request = Request();
  request.joint_names = {"swing", "elbow"};
  const PathCheckReplyMessage reply = Check(request);
  ASSERT_TRUE(reply.ok);
  EXPECT_FALSE(reply.verdict->valid);
  ASSERT_TRUE(reply.mesh_verdict);
  EXPECT_FALSE(reply.mesh_verdict->valid);
}

TEST(MeshRobot, StandsWhereThePlanningRobotHasJointsFixed) {
  const TemporaryFolder folder;
  const std::filesystem::path planning = WriteTinyRobot(folder);
  const auto urdf_with = [text = ReadText(planning / "tiny.urdf")](
                             const std::vector<std::pair<std::string, std::string>>& changes) {
    std::string urdf = text;
    for (const auto& [from, to] : changes) urdf.replace(urdf.find(from), from.size(), to);
    return urdf;
  };
  folder.Write("judge/judge.urdf",
               urdf_with({{"<link name=\"finger\"/>",
                           "<link name='finger'><collision><geometry><sphere radius='0.05'/>"
                           "</geometry></collision></link>"}}));
  // Extended, so that it reaches the post.
  folder.Write("tiny/tiny.urdf",
               urdf_with({{"\"finger_joint\" type=\"prismatic\"", "'finger_joint' type='fixed'"},
                          {"0.5 0 0", "0.8 0 0"}}));
  Problem problem = TinyProblem();
  problem.start = {{"lift", "swing"}, {0, kStartSwing}};
  WriteTinyProblem(problem, folder / "cans", 1);
  const Robot robot = LoadRobot(planning);
  SceneService service(robot, LoadRefereeRobot(folder / "judge", robot), {folder / "cans"});
  const ProblemMessage served = service.AnswerProblem({"id", "cans", 1}).problem;
  EXPECT_EQ(served.message, "");
  PathCheckRequestMessage request;
  request.scene_id = served.scene_id;
  request.group = served.group;
  request.start = served.start;
  request.goal = served.goal;
  request.joint_names = {"swing", "lift"};
  request.path = {{kStartSwing, 0}, {-3, 0}, {3, 0}, {kGoalSwing, 0}};
  request.step_m = 0.01;
  const PathCheckReplyMessage reply = service.AnswerPathCheck(request);
  ASSERT_TRUE(reply.ok) << reply.message;
  ASSERT_TRUE(reply.mesh_verdict);
  ASSERT_TRUE(reply.mesh_verdict->contact) << "the finger is drawn in";
  EXPECT_EQ(reply.mesh_verdict->contact->body_a, "finger");
  EXPECT_EQ(reply.mesh_verdict->contact->body_b, "post");
}

TEST(MeshRobot, WithoutItsMeshFailsAtStart) {
  const TemporaryFolder folder;
  WriteTinyProblem(TinyProblem(), folder.path() / "cans", 1);
  const Robot robot = LoadRobot(WriteTinyRobot(folder));
  const std::filesystem::path mesh_folder = WriteTinyMeshRobot(folder);
  std::filesystem::remove(mesh_folder / "arm.obj");
  const Robot mesh_robot = LoadRefereeRobot(mesh_folder, robot);
  ExpectInputError([&] { SceneService(robot, mesh_robot, {folder.path() / "cans"}); },
                   {"tiny.urdf:", "link 'arm': collision mesh", "arm.obj"});
}

}  // namespace
}  // namespace planbench
