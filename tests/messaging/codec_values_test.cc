#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "messaging/wire.h"
#include "planbench/lcmt_ack.hpp"
#include "planbench/lcmt_collision_reply.hpp"
#include "planbench/lcmt_collision_request.hpp"
#include "planbench/lcmt_path_check_request.hpp"
#include "planbench/lcmt_plan_ack.hpp"
#include "planbench/lcmt_problem_sets.hpp"
#include "planbench/lcmt_run_record.hpp"
#include "planbench/lcmt_scene.hpp"
#include "planbench/lcmt_session.hpp"
#include "tests/messaging/codec_fixture.h"

namespace planbench {
namespace {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A change to a good message that makes it bad, and what the error must say.
template <typename Wire>
struct Spoiled {
  std::string expected;
  std::function<void(Wire&)> spoil;
};

class CodecValues : public CodecTest {
 protected:
  /// Spoils the example of Message and expects the refusal "CH: <expected>...".
  template <typename Message, typename Wire>
  MessageError ExpectRefused(const Spoiled<Wire>& spoiled) {
    auto wire = wire::Unpack<Wire>(Encode(Example<Message>()), "CH");
    spoiled.spoil(wire);
    const MessageError error = DecodeError<Message>(wire::Pack(wire));
    EXPECT_THAT(error.what(), testing::StartsWith("CH: " + spoiled.expected));
    return error;
  }
  template <typename Message, typename Wire>
  void ExpectAllRefused(const std::vector<Spoiled<Wire>>& list) {
    for (const Spoiled<Wire>& spoiled : list) ExpectRefused<Message>(spoiled);
  }
};

TEST_F(CodecValues, PlanRequestNumbersMustBeFinite) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    ExpectAllRefused<PlanRequest, lcmt_plan_request>({
        {"start.position[1]: ", [=](auto& m) { m.start.position[1] = bad; }},
        {"goal[1].position: ", [=](auto& m) { m.goal[1].position = bad; }},
        {"goal[0].tolerance_above: ", [=](auto& m) { m.goal[0].tolerance_above = bad; }},
        {"goal[0].tolerance_below: ", [=](auto& m) { m.goal[0].tolerance_below = bad; }},
        {"time_limit_s: ", [=](auto& m) { m.time_limit_s = bad; }},
        {"edge_resolution_m: ", [=](auto& m) { m.edge_resolution_m = bad; }},
    });
  }
}

TEST_F(CodecValues, PlanRequestRanges) {
  ExpectAllRefused<PlanRequest, lcmt_plan_request>({
      {"request_id: is empty", [](auto& m) { m.request_id.clear(); }},
      {"scene_id: is empty", [](auto& m) { m.scene_id.clear(); }},
      {"start.joint_name[2]: 'lift' occurs twice", [](auto& m) { m.start.joint_name[2] = "lift"; }},
      {"start.joint_name[0]: is empty", [](auto& m) { m.start.joint_name[0] = ""; }},
      {"goal[1].joint_name: 'shoulder' occurs twice",
       [](auto& m) { m.goal[1].joint_name = "shoulder"; }},
      {"goal[0].tolerance_above: -1 is negative", [](auto& m) { m.goal[0].tolerance_above = -1; }},
      {"direction: no such value: 2", [](auto& m) { m.direction = 2; }},
      {"direction: no such value: -1", [](auto& m) { m.direction = -1; }},
      {"time_limit_s: -1 is negative", [](auto& m) { m.time_limit_s = -1; }},
      {"collision_model: no collision model 'magic'", [](auto& m) { m.collision_model = "magic"; }},
      {"edge_resolution_m: -1 is negative", [](auto& m) { m.edge_resolution_m = -1; }},
      {"anytime: 2 is no boolean", [](auto& m) { m.anytime = 2; }},
      {"parameter[0].key: is empty", [](auto& m) { m.parameter[0].key = ""; }},
      {"parameter[1].key: 'range' occurs twice",
       [](auto& m) { m.parameter[0].key = m.parameter[1].key = "range"; }},
  });
}

TEST_F(CodecValues, ErrorsCarryTheRequestId) {
  const Spoiled<lcmt_plan_request> spoiled{"direction", [](auto& m) { m.direction = 9; }};
  EXPECT_EQ((ExpectRefused<PlanRequest>(spoiled).request_id()), "r6");
  const Spoiled<lcmt_run_record> nested{"result.cost", [](auto& m) { m.result.cost = kNan; }};
  EXPECT_EQ((ExpectRefused<RunRecordMessage>(nested).request_id()), "r16");
  EXPECT_EQ(DecodeError<PlanRequest>({}).request_id(), "");
}

TEST_F(CodecValues, PlanResultNumbersMustBeFinite) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    ExpectAllRefused<PlanResultMessage, lcmt_plan_result>({
        {"planning_time_s: ", [=](auto& m) { m.planning_time_s = bad; }},
        {"total_time_s: ", [=](auto& m) { m.total_time_s = bad; }},
        {"setup_s: ", [=](auto& m) { m.setup_s = bad; }},
        {"collision_s: ", [=](auto& m) { m.collision_s = bad; }},
        {"guidance_s: ", [=](auto& m) { m.guidance_s = bad; }},
        {"search_s: ", [=](auto& m) { m.search_s = bad; }},
        {"simplification_s: ", [=](auto& m) { m.simplification_s = bad; }},
        {"path.position[2]: ", [=](auto& m) { m.path.position[2][1] = bad; }},
        {"simplified_path.position[0]: ", [=](auto& m) { m.simplified_path.position[0][0] = bad; }},
        {"epsilon: ", [=](auto& m) { m.epsilon = bad; }},
        {"cost: ", [=](auto& m) { m.cost = bad; }},
        {"progress[1].elapsed_s: ", [=](auto& m) { m.progress[1].elapsed_s = bad; }},
        {"progress[0].epsilon: ", [=](auto& m) { m.progress[0].epsilon = bad; }},
        {"progress[0].cost: ", [=](auto& m) { m.progress[0].cost = bad; }},
        {"counter[1].value: ", [=](auto& m) { m.counter[1].value = bad; }},
        {"peak_memory_mb: ", [=](auto& m) { m.peak_memory_mb = bad; }},
    });
  }
}

TEST_F(CodecValues, PlanResultRanges) {
  ExpectAllRefused<PlanResultMessage, lcmt_plan_result>({
      {"status: no such value: 10", [](auto& m) { m.status = 10; }},
      {"planning_time_s: -1 is negative", [](auto& m) { m.planning_time_s = -1; }},
      {"path.joint_name[1]: 'shoulder' occurs twice",
       [](auto& m) { m.path.joint_name[1] = "shoulder"; }},
      {"path.num_joints: waypoints without joints",
       [](auto& m) {
         m.path.num_joints = 0;
         m.path.joint_name.clear();
         for (auto& waypoint : m.path.position) waypoint.clear();
       }},
      {"simplified_path.joint_name: other joints",
       [](auto& m) { m.simplified_path.joint_name[0] = "elbow"; }},
      {"simplified_path.joint_name: other joints", [](auto& m) { m.path = lcmt_path{}; }},
      {"progress[0].expansions: -1 is less than 0", [](auto& m) { m.progress[0].expansions = -1; }},
      {"counter[1].name: 'edges_checked' occurs twice",
       [](auto& m) { m.counter[1].name = "edges_checked"; }},
  });
}

TEST_F(CodecValues, SceneNumbersMustBeFinite) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    ExpectAllRefused<SceneMessage, lcmt_scene>({
        {"object[0].pose.position[2]: ", [=](auto& m) { m.object[0].pose.position[2] = bad; }},
        {"object[1].pose.orientation_wxyz[0]: ",
         [=](auto& m) { m.object[1].pose.orientation_wxyz[0] = bad; }},
        {"object[0].shape[1].dimension[0]: ",
         [=](auto& m) { m.object[0].shape[1].dimension[0] = bad; }},
        {"object[0].shape[0].mesh_scale[0]: ",
         [=](auto& m) { m.object[0].shape[0].mesh_scale[0] = bad; }},
        {"object[2].shape[0].pose.position[1]: ",
         [=](auto& m) { m.object[2].shape[0].pose.position[1] = bad; }},
        {"frame_pose[0].orientation_wxyz[3]: ",
         [=](auto& m) { m.frame_pose[0].orientation_wxyz[3] = bad; }},
    });
  }
}

TEST_F(CodecValues, SceneRanges) {
  ExpectAllRefused<SceneMessage, lcmt_scene>({
      {"scene_id: the content is ", [](auto& m) { m.scene_id = "5c"; }},
      {"scene_id: the content is ", [](auto& m) { m.object[0].pose.position[0] += 1e-12; }},
      {"object[0].id: is empty", [](auto& m) { m.object[0].id = ""; }},
      {"object[2].id: 'table' occurs twice", [](auto& m) { m.object[2].id = "table"; }},
      {"object[0].pose.orientation_wxyz: length 0 instead of 1",
       [](auto& m) { std::fill_n(m.object[0].pose.orientation_wxyz, 4, 0.0); }},
      {"object[0].pose.orientation_wxyz: length ",
       [](auto& m) { m.object[0].pose.orientation_wxyz[0] += 1e-3; }},
      {"object[0].shape[0].type: no such value: 8", [](auto& m) { m.object[0].shape[0].type = 8; }},
      {"object[0].shape[5].num_dimensions: 0 instead of 2",
       [](auto& m) { m.object[0].shape[5].type = lcmt_shape::CAPSULE; }},
      {"object[0].shape[4].num_dimensions: 2 instead of 0",
       [](auto& m) { m.object[0].shape[4].type = lcmt_shape::HALF_SPACE; }},
      {"object[0].shape[0].num_dimensions: 3 instead of 1",
       [](auto& m) { m.object[0].shape[0].type = lcmt_shape::SPHERE; }},
      {"object[0].shape[3].dimension[1]: 0 is not greater than 0",
       [](auto& m) { m.object[0].shape[3].dimension[1] = 0; }},
      {"object[1].shape[0].mesh_scale[2]: is 0",
       [](auto& m) { m.object[1].shape[0].mesh_scale[2] = 0; }},
      {"object[1].shape[0].mesh_resource: is empty",
       [](auto& m) { m.object[1].shape[0].mesh_resource = ""; }},
      {"object[1].shape[0].mesh_resource: mesh 'package://a/b.obj': not a file:// URI",
       [](auto& m) { m.object[1].shape[0].mesh_resource = "package://a/b.obj"; }},
      {"object[1].shape[0].mesh_resource: /no/such/file.obj: no such mesh file",
       [](auto& m) { m.object[1].shape[0].mesh_resource = "file:///no/such/file.obj"; }},
      {"object[1].shape[0].mesh_id: ", [](auto& m) { m.object[1].shape[0].mesh_id = "12"; }},
      {"object[2].touch_link[1]: 'finger_l' occurs twice",
       [](auto& m) { m.object[2].touch_link[1] = "finger_l"; }},
      {"body_b[0]: is empty", [](auto& m) { m.body_b[0] = ""; }},
      {"allowed[1]: -1 is no boolean", [](auto& m) { m.allowed[1] = -1; }},
      {"default_body[0]: is empty", [](auto& m) { m.default_body[0] = ""; }},
      {"frame[0]: is empty", [](auto& m) { m.frame[0] = ""; }},
  });
}

TEST_F(CodecValues, MeshScaleAppliesToTheFile) {
  auto wire = wire::Unpack<lcmt_scene>(Encode(Example<SceneMessage>()), "CH");
  Scene scaled = ExampleScene();
  Mesh& mesh = std::get<Mesh>(scaled.objects[1].shapes[0].shape);
  for (auto& vertex : mesh.triangles.vertices)
    vertex = vertex.cwiseProduct(Eigen::Vector3d(2, 3, 4));
  lcmt_shape& shape = wire.object[1].shape[0];
  for (int i = 0; i < 3; ++i) shape.mesh_scale[i] = 2 + i;
  shape.mesh_id = MeshId(mesh.triangles);
  wire.scene_id = SceneId(scaled);
  EXPECT_EQ(SceneId(Decode<SceneMessage>(wire::Pack(wire), "CH").scene), SceneId(scaled));
}

TEST_F(CodecValues, NodesAndProblems) {
  ExpectAllRefused<NodeStatusMessage, lcmt_node_status>({
      {"name: ", [](auto& m) { m.name = "has space"; }},
      {"name: ", [](auto& m) { m.name = ""; }},
      {"kind: no such value: 4", [](auto& m) { m.kind = 4; }},
      {"state: no such value: 2", [](auto& m) { m.state = 2; }},
      {"can_backward: 7 is no boolean", [](auto& m) { m.can_backward = 7; }},
  });
  ExpectAllRefused<ProblemSetsMessage, lcmt_problem_sets>({
      {"set[0].problem_index[2]: 2 is not ascending",
       [](auto& m) { m.set[0].problem_index[2] = 2; }},
      {"set[0].problem_index[0]: -1 is less than 0",
       [](auto& m) { m.set[0].problem_index[0] = -1; }},
      {"set[1].name: 'shelf' occurs twice", [](auto& m) { m.set[1].name = "shelf"; }},
  });
  ExpectAllRefused<PlanAckMessage, lcmt_plan_ack>(
      {{"verdict: no such value: 3", [](auto& m) { m.verdict = 3; }}});
  ExpectAllRefused<AckMessage, lcmt_ack>({{"id: is empty", [](auto& m) { m.id = ""; }}});
  ExpectAllRefused<SessionMessage, lcmt_session>({
      {"run_id: is empty", [](auto& m) { m.run_id = ""; }},
      {"total_time_s: nan is not a finite number", [](auto& m) { m.total_time_s = kNan; }},
      {"node[0].kind: no such value: -3", [](auto& m) { m.node[0].kind = -3; }},
  });
}

TEST_F(CodecValues, ChecksAndRecords) {
  ExpectAllRefused<CollisionRequestMessage, lcmt_collision_request>({
      {"position[1]: nan is not a finite number", [](auto& m) { m.position[1][0] = kNan; }},
      {"edge_to[0]: inf is not a finite number", [](auto& m) { m.edge_to[0][1] = kInfinity; }},
      {"truncated or damaged lcmt_collision_request",
       [](auto& m) {
         m.num_joints = 0;
         m.num_edges = 0;
       }},
      {"num_joints: -1 is less than 0",
       [](auto& m) {
         m.num_joints = -1;
         m.num_states = m.num_edges = 0;
       }},
  });
  ExpectAllRefused<CollisionReplyMessage, lcmt_collision_reply>({
      {"state[1].distance_m: nan ", [](auto& m) { m.state[1].distance_m = kNan; }},
      {"state[1].distance_m: -inf ", [](auto& m) { m.state[1].distance_m = -kInfinity; }},
      {"edge[0].fraction: 1.5 is not in [0, 1]", [](auto& m) { m.edge[0].fraction = 1.5; }},
      {"edge[0].fraction: nan is not in [0, 1]", [](auto& m) { m.edge[0].fraction = kNan; }},
  });
  ExpectAllRefused<PathCheckRequestMessage, lcmt_path_check_request>({
      {"step_m: 0 is not greater than 0", [](auto& m) { m.step_m = 0; }},
      {"path.position[0]: nan of wrist is not a finite number",
       [](auto& m) { m.path.position[0][1] = kNan; }},
  });
  ExpectAllRefused<PathCheckReplyMessage, lcmt_path_check_reply>({
      {"verdict.segment: -2 is less than -1", [](auto& m) { m.verdict.segment = -2; }},
      {"mesh_verdict.clearance_min_m: nan ",
       [](auto& m) { m.mesh_verdict.clearance_min_m = kNan; }},
  });
  ExpectAllRefused<RunRecordMessage, lcmt_run_record>({
      {"status: no such value: -1", [](auto& m) { m.status = -1; }},
      {"trial: 0 is less than 1", [](auto& m) { m.trial = 0; }},
      {"request.time_limit_s: nan ", [](auto& m) { m.request.time_limit_s = kNan; }},
      {"result.path.position[0]: nan ", [](auto& m) { m.result.path.position[0][0] = kNan; }},
      {"simplified_check.verdict.length: nan ",
       [](auto& m) { m.simplified_check.verdict.length = kNan; }},
  });
}

}  // namespace
}  // namespace planbench
