#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "messaging/wire.h"
#include "tests/messaging/codec_fixture.h"

namespace planbench {
namespace {

// What EveryMessage (codec_test.cc), which goes field by field, does not find.

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

TEST_F(CodecValues, MessagesOfErrors) {
  ExpectAllRefused<PlanRequest, lcmt_plan_request>({
      {"request_id: is empty", [](auto& m) { m.request_id.clear(); }},
      {"start.joint_name[0]: is empty", [](auto& m) { m.start.joint_name[0] = ""; }},
      {"goal[0].tolerance_above: -1 is negative", [](auto& m) { m.goal[0].tolerance_above = -1; }},
      {"direction: no such value: 2", [](auto& m) { m.direction = 2; }},
      {"time_limit_s: nan is not a finite number", [](auto& m) { m.time_limit_s = NAN; }},
      {"collision_model: expected spheres, voxels, meshes or enclosing, found 'magic'",
       [](auto& m) { m.collision_model = "magic"; }},
      {"edge_check: expected fixed or certified, found 'magic'",
       [](auto& m) { m.edge_check = "magic"; }},
      {"anytime: 2 is no boolean", [](auto& m) { m.anytime = 2; }},
      {"parameter[1].key: 'range' occurs twice",
       [](auto& m) { m.parameter[0].key = m.parameter[1].key = "range"; }},
  });
  ExpectAllRefused<NodeStatusMessage, lcmt_node_status>(
      {{"name: 'has space' cannot name a node: ", [](auto& m) { m.name = "has space"; }}});
  ExpectAllRefused<ProblemSetsMessage, lcmt_problem_sets>({
      {"edge_resolution_m: 0 is not greater than 0", [](auto& m) { m.edge_resolution_m = 0; }},
      {"set[0].problem_index[1]: 0 is not ascending",
       [](auto& m) {
         m.set[0].problem_index = {0, 0};
       }},
  });
  ExpectAllRefused<CollisionReplyMessage, lcmt_collision_reply>(
      {{"edge[0].fraction: 1.5 is not in [0, 1]", [](auto& m) { m.edge[0].fraction = 1.5; }}});
  ExpectAllRefused<RunRecordMessage, lcmt_run_record>({
      {"trial: 0 is less than 1", [](auto& m) { m.trial = 0; }},
      {"result.path.position[1][0]: nan is not a finite number",
       [](auto& m) { m.result.path.position[1][0] = NAN; }},
  });
  ExpectAllRefused<PlanResultMessage, lcmt_plan_result>({
      {"status: NO_ANSWER is the driver's to say", [](auto& m) { m.status = 7; }},
      {"status: INVALID_PATH is the driver's to say", [](auto& m) { m.status = 8; }},
      {"planning_time_s: 1e+308 s is more than 1000000000",
       [](auto& m) { m.planning_time_s = 1e308; }},
      {"epsilon: 0.5 is no bound: 0 (none) or at least 1", [](auto& m) { m.epsilon = 0.5; }},
      {"progress[1].epsilon: 0.1 is no bound", [](auto& m) { m.progress[1].epsilon = 0.1; }},
      {"peak_memory_mb: 1e+300 MiB is more than 1000000000",
       [](auto& m) { m.peak_memory_mb = 1e300; }},
  });
  EXPECT_EQ(DecodeError<PlanRequest>({}).request_id(), "");
}

TEST_F(CodecValues, CountersOfThings) {
  PlanResultMessage message = Example<PlanResultMessage>();
  const auto decode_with = [&](const std::string& name, double value) {
    message.result.counters = {{name, value}};
    return Decode<PlanResultMessage>(Encode(message), "CH");
  };
  for (const std::string name : {"edges_checked", "configurations_checked"}) {
    EXPECT_TRUE(decode_with(name, 0) == message);
    EXPECT_TRUE(decode_with(name, 3e15) == message);
    for (const double bad : {-5.0, 2.5, kInfinity}) {
      message.result.counters = {{name, bad}};
      EXPECT_THAT(DecodeError<PlanResultMessage>(Encode(message)).what(),
                  testing::StartsWith("CH: counter: " + name + ": "));
    }
  }
  EXPECT_TRUE(decode_with("tries_a_goal", -2.5) == message);
  message.result.counters = {{"tries_a_goal", INFINITY}};
  EXPECT_THAT(DecodeError<PlanResultMessage>(Encode(message)).what(),
              testing::StrEq("CH: counter: tries_a_goal: inf is not a finite number"));
}

TEST_F(CodecValues, ImprovementsImprove) {
  PlanResultMessage message = Example<PlanResultMessage>();
  // An equal time, a cost that is equal, none, or rounded otherwise.
  message.result.progress = {
      {1, 0, 3, 1}, {1, 2, 3, 1}, {2, 2, 0, 1}, {3, 2, 3.0000000001, 1}, {4, 1, -1, 1}};
  EXPECT_TRUE(Decode<PlanResultMessage>(Encode(message), "CH") == message);
  message.result.progress = {{1, 0, 3, 1}, {2, 0, 0, 1}, {3, 0, 9, 1}};
  EXPECT_THAT(DecodeError<PlanResultMessage>(Encode(message)).what(),
              testing::StrEq("CH: progress: cost rises from 3 to 9"));
  message.result.progress = {{0.5, 0, 3, 1}, {0.25, 0, 2, 1}};
  EXPECT_THAT(DecodeError<PlanResultMessage>(Encode(message)).what(),
              testing::StrEq("CH: progress: elapsed_s falls from 0.5 to 0.25"));
}

TEST_F(CodecValues, ReasonsAreCutAndOtherTextsRefusedIfTheyAreTooLong) {
  constexpr std::size_t kMost = rules::Reason::kMost;
  PlanResultMessage result = Example<PlanResultMessage>();
  result.result.message = std::string(kMost, 'm');
  EXPECT_TRUE(Decode<PlanResultMessage>(Encode(result), "CH") == result);
  result.result.message = std::string(3'000'000, 'm');
  const auto cut = Decode<PlanResultMessage>(Encode(result), "CH");
  EXPECT_LE(cut.result.message.size(), kMost);
  EXPECT_THAT(cut.result.message, testing::EndsWith("m...(2996040 bytes more)"));
  EXPECT_TRUE(Decode<PlanResultMessage>(Encode(cut), "CH") == cut);

  NodeStatusMessage status = Example<NodeStatusMessage>();
  status.settings = {{"moves", std::string(rules::kLongestField, 'v')}};
  EXPECT_TRUE(Decode<NodeStatusMessage>(Encode(status), "CH") == status);
  status.settings["moves"] += 'v';
  EXPECT_THAT(
      DecodeError<NodeStatusMessage>(Encode(status)).what(),
      testing::StrEq("CH: setting[0].value: 10000001 bytes; a text holds at most 10000000"));
  status.settings.clear();
  status.collision_models = {"spheres", std::string(rules::kLongestField + 1, 'v')};
  EXPECT_THAT(DecodeError<NodeStatusMessage>(Encode(status)).what(),
              testing::StartsWith("CH: collision_model[1]: 10000001 bytes"));
  status.collision_models.assign(2, std::string(3'000'000, 'v'));
  EXPECT_LE(std::string_view(DecodeError<NodeStatusMessage>(Encode(status)).what()).size(),
            kMost + 100)
      << "what an error quotes is cut, too";
}

TEST_F(CodecValues, InfinityIsADistance) {
  CollisionReplyMessage message = Example<CollisionReplyMessage>();
  message.states[0].distance_m = INFINITY;
  EXPECT_TRUE(Decode<CollisionReplyMessage>(Encode(message), "CH") == message);
}

TEST_F(CodecValues, IdsAreNeededUnlessTheMessageStandsInAnother) {
  RunRecordMessage record = Example<RunRecordMessage>();
  record.result.request_id.clear();
  EXPECT_TRUE(Decode<RunRecordMessage>(Encode(record), "CH") == record);
}

TEST_F(CodecValues, Paths) {
  ExpectAllRefused<PlanResultMessage, lcmt_plan_result>({
      {"path.num_joints: waypoints without joints",
       [](auto& m) {
         m.path.num_joints = 0;
         m.path.joint_name.clear();
         for (auto& waypoint : m.path.position) waypoint.clear();
       }},
      {"simplified_path.joint_name: other joints",
       [](auto& m) { std::swap(m.path.joint_name[0], m.path.joint_name[1]); }},
      {"simplified_path: there is no path", [](auto& m) { m.path = lcmt_path{}; }},
  });
}

TEST_F(CodecValues, CollisionRequests) {
  ExpectAllRefused<CollisionRequestMessage, lcmt_collision_request>({
      {"truncated or damaged lcmt_collision_request: a count (num_...) or the length of a text "
       "does "
       "not match what follows, or rows hold 0 numbers",
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
}

TEST_F(CodecValues, WhatIsCutBehindItsIdIsRefusedByIt) {
  PlanResultMessage result = Example<PlanResultMessage>();
  result.request_id = "an id\n";
  std::vector<std::uint8_t> bytes = Encode(result);
  bytes.pop_back();
  EXPECT_EQ(DecodeError<PlanResultMessage>(bytes).request_id(), "an id\\n");
  bytes.insert(bytes.end(), 2, 0);
  EXPECT_EQ(DecodeError<PlanResultMessage>(bytes).request_id(), "an id\\n");
  EXPECT_EQ(DecodeError<PlanResultMessage>(std::span(bytes).first(20)).request_id(), "");
  bytes[0] ^= 1;
  EXPECT_EQ(DecodeError<PlanResultMessage>(bytes).request_id(), "");
}

TEST_F(CodecValues, RefusalsOfProblemsNeedNoProblem) {
  auto wire = wire::Unpack<lcmt_problem>(Encode(Example<ProblemMessage>()), "CH");
  wire.scene_id.clear();
  wire.ok = 0;
  EXPECT_NO_THROW(Decode<ProblemMessage>(wire::Pack(wire), "CH"));
  wire.ok = 1;
  EXPECT_THAT(DecodeError<ProblemMessage>(wire::Pack(wire)).what(),
              testing::StrEq("CH: scene_id: is empty"));
}

TEST_F(CodecValues, Scenes) {
  ExpectAllRefused<SceneMessage, lcmt_scene>({
      {"scene_id: the content is ", [](auto& m) { m.scene_id = "5c"; }},
      {"scene_id: the content is ", [](auto& m) { m.object[0].pose.position[0] += 1e-12; }},
      {"attached: 'table' is the name of an object of the world, too",
       [](auto& m) { m.attached[0].object.id = "table"; }},
      {"object[0].pose.orientation_wxyz: length 0 instead of 1",
       [](auto& m) { std::fill_n(m.object[0].pose.orientation_wxyz, 4, 0.0); }},
      {"object[0].shape[0].type: no such value: 7", [](auto& m) { m.object[0].shape[0].type = 7; }},
      {"object[0].shape[0].type: no such value: -1",
       [](auto& m) { m.object[0].shape[0].type = -1; }},
      {"object[0].shape[5].num_dimensions: 0 instead of 2",
       [](auto& m) { m.object[0].shape[5].type = lcmt_shape::CAPSULE; }},
      {"object[0].shape[4].num_dimensions: 2 instead of 0",
       [](auto& m) { m.object[0].shape[4].type = lcmt_shape::HALF_SPACE; }},
      {"object[0].shape[0].num_dimensions: 3 instead of 1",
       [](auto& m) { m.object[0].shape[0].type = lcmt_shape::SPHERE; }},
      {"object[1].shape[0].mesh_resource: is empty",
       [](auto& m) { m.object[1].shape[0].mesh_resource = ""; }},
      {"object[1].shape[0].mesh_resource: mesh 'package://a/b.obj': not a file:// URI",
       [](auto& m) { m.object[1].shape[0].mesh_resource = "package://a/b.obj"; }},
      {"object[1].shape[0].mesh_resource: /no/such/file.obj: no such mesh file",
       [](auto& m) { m.object[1].shape[0].mesh_resource = "file:///no/such/file.obj"; }},
      {"object[1].shape[0].mesh_id: ", [](auto& m) { m.object[1].shape[0].mesh_id = "12"; }},
  });
}

}  // namespace
}  // namespace planbench
