#include "scene_server/standing_contacts.h"

#include <gtest/gtest.h>

#include "scene_server/scene_service.h"
#include "tests/scene_server/tiny_world.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

// Far from all else, a post on the base and a sign that slides along it, and overlaps it.
constexpr char kPostAndSign[] = R"(
  <link name="post"><collision><origin xyz="0 3 0"/><geometry><box size="0.1 0.1 1"/></geometry>
  </collision></link>
  <link name="sign"><collision><origin xyz="0 3 0"/><geometry><box size="0.5 0.05 0.1"/></geometry>
  </collision></link>
  <joint name="plant" type="fixed"><parent link="base_link"/><child link="post"/></joint>
  <joint name="hang" type="prismatic"><parent link="base_link"/><child link="sign"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="3" velocity="1" effort="1"/></joint>)";

class StandingContactsTest : public testing::Test {
 protected:
  StandingContactsTest() : robot_(LoadRobot(WriteTinyRobot(folder_))) {}

  std::unique_ptr<SceneService> Serve(const Problem& problem, bool allow) {
    WriteTinyProblem(problem, folder_.path() / "cans", 1);
    return std::make_unique<SceneService>(
        robot_, LoadRefereeRobot(WriteTinyMeshRobot(folder_, kPostAndSign), robot_),
        std::vector{folder_.path() / "cans"}, allow);
  }

  TemporaryFolder folder_;
  Robot robot_;
};

TEST_F(StandingContactsTest, AreRefusedBeforeAnythingIsServed) {
  ExpectInputError([&] { Serve(TinyProblem(), false); },
                   {"--referee-robot", "tiny_meshes", "'post' and 'sign'", "'cans'",
                    "--allow-standing-contacts"});
}

TEST_F(StandingContactsTest, AreAllowedOnRequestWhichMakesAnotherReferee) {
  const auto service = Serve(TinyProblem(), true);
  const auto& pairs = service->mesh_robot()->allowed_pairs;
  ASSERT_EQ(pairs.size(), 1u);
  const RobotModel& model = service->mesh_robot()->model;
  EXPECT_EQ(std::minmax(pairs[0].first, pairs[0].second),
            std::minmax(model.FindLink("post"), model.FindLink("sign")));
  EXPECT_NE(service->mesh_robot()->content_id,
            LoadRefereeRobot(folder_.path() / "tiny_meshes", robot_).content_id);

  PathCheckRequestMessage request;
  request.scene_id = service->AnswerProblem({"id", "cans", 1}).problem.scene_id;
  request.group = "arm";
  const Problem problem = TinyProblem();
  request.start = problem.start;
  request.goal = problem.goal;
  request.joint_names = {"swing", "lift"};
  request.path = {{kStartSwing, 0}};
  request.step_m = 0.01;
  const PathCheckReplyMessage reply = service->AnswerPathCheck(request);
  ASSERT_TRUE(reply.ok) << reply.message;
  ASSERT_TRUE(reply.mesh_verdict);
  EXPECT_EQ(reply.mesh_verdict->reason.find("sign"), std::string::npos)
      << reply.mesh_verdict->reason;
}

TEST_F(StandingContactsTest, WhatTheSceneAllowsIsNone) {
  Problem problem = TinyProblem();
  problem.scene.allowed_collisions.SetEntry("post", "sign", true);
  EXPECT_TRUE(Serve(problem, false)->mesh_robot()->allowed_pairs.empty());
}

}  // namespace
}  // namespace planbench
