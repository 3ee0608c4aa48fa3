#include "messaging/codec.h"

#include <gmock/gmock.h>

#include "scene/moveit_yaml.h"
#include "tests/messaging/codec_fixture.h"
#include "tests/messaging/message_text.h"
#include "tests/support/shared_data.h"

namespace planbench {
namespace {

using testing::HasSubstr;

template <typename Message>
class EveryMessage : public CodecTest {};
TYPED_TEST_SUITE(EveryMessage, AllMessages);

TYPED_TEST(EveryMessage, KeepsEveryField) {
  const TypeParam message = Example<TypeParam>();
  const auto decoded = Decode<TypeParam>(Encode(message), "CH");
  EXPECT_EQ(TextOf(decoded), TextOf(message));
}

TYPED_TEST(EveryMessage, EveryTruncationIsRefused) {
  const std::vector<std::uint8_t> bytes = Encode(Example<TypeParam>());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const MessageError error = DecodeError<TypeParam>(std::span(bytes).first(size), "SOME_CHANNEL");
    ASSERT_THAT(error.what(), HasSubstr("SOME_CHANNEL: ")) << size;
  }
}

TYPED_TEST(EveryMessage, ExcessIsRefused) {
  std::vector<std::uint8_t> bytes = Encode(Example<TypeParam>());
  bytes.push_back(0);
  EXPECT_THAT(DecodeError<TypeParam>(bytes).what(), HasSubstr("CH: 1 bytes after the end of"));
}

TYPED_TEST(EveryMessage, AnotherTypeIsRefused) {
  std::vector<std::uint8_t> bytes;
  if constexpr (std::is_same_v<TypeParam, AckMessage>) {
    bytes = Encode(Example<PlanCancelMessage>());
  } else {
    bytes = Encode(Example<AckMessage>());
  }
  EXPECT_THAT(DecodeError<TypeParam>(bytes).what(),
              testing::MatchesRegex("CH: not a lcmt_[a-z_]+ of this version"));
}

class Codec : public CodecTest {};

TEST_F(Codec, WhatNobodyAnsweredHasEmptyParts) {
  RunRecordMessage message;
  message.run_id = "session";
  message.request_id = "r";
  message.planner = "ara";
  EXPECT_EQ(TextOf(Decode<RunRecordMessage>(Encode(message), "CH")), TextOf(message));
}

TEST_F(Codec, RefusalsAreEmptyButForTheReason) {
  ProblemMessage problem;
  problem.request_id = "r";
  problem.ok = false;
  problem.message = "no such set";
  EXPECT_EQ(TextOf(Decode<ProblemMessage>(Encode(problem), "CH")), TextOf(problem));

  SceneMessage scene{"r", "5c", false, "no such scene", {}};
  EXPECT_EQ(TextOf(Decode<SceneMessage>(Encode(scene), "CH")), TextOf(scene));
}

TEST_F(Codec, ResultWithoutPathHasNoJointNames) {
  PlanResultMessage message = Example<PlanResultMessage>();
  message.result.status = PlanStatus::kTimedOut;
  message.result.path.clear();
  message.result.simplified_path.clear();
  const auto decoded = Decode<PlanResultMessage>(Encode(message), "CH");
  EXPECT_TRUE(decoded.joint_names.empty());
  EXPECT_TRUE(decoded.result.path.empty());
}

TEST_F(Codec, TextEndsAtItsFirstNul) {
  AckMessage message = Example<AckMessage>();
  message.message = std::string("a\0b", 3);
  EXPECT_EQ(Decode<AckMessage>(Encode(message), "CH").message, "a");
}

// The generated encoder reads as many elements as the counts say.
TEST_F(Codec, ListsOfDifferentLengthsAreNotEncoded) {
  PlanRequest request = Example<PlanRequest>();
  request.start.positions.pop_back();
  EXPECT_THROW(Encode(request), std::logic_error);

  PlanResultMessage result = Example<PlanResultMessage>();
  result.result.path[1].push_back(0);
  EXPECT_THROW(Encode(result), std::logic_error);
  result = Example<PlanResultMessage>();
  result.joint_names.pop_back();
  EXPECT_THROW(Encode(result), std::logic_error);

  PathCheckRequestMessage check = Example<PathCheckRequestMessage>();
  check.path.back().pop_back();
  EXPECT_THROW(Encode(check), std::logic_error);

  CollisionRequestMessage collision = Example<CollisionRequestMessage>();
  collision.states[2].push_back(0);
  EXPECT_THROW(Encode(collision), std::logic_error);
  collision = Example<CollisionRequestMessage>();
  collision.edges[0].to.pop_back();
  EXPECT_THROW(Encode(collision), std::logic_error);
}

TEST_F(Codec, SceneKeepsItsIdOverManyTrips) {
  SceneMessage message = Example<SceneMessage>();
  for (int trip = 0; trip < 3; ++trip) {
    message = Decode<SceneMessage>(Encode(message), "CH");
    EXPECT_EQ(SceneId(message.scene), Example<SceneMessage>().scene_id);
  }
}

class PublishedScenes : public CodecTest, public testing::WithParamInterface<std::string> {};

TEST_P(PublishedScenes, KeepTheirIds) {
  const std::string below = "problems/" + GetParam();
  PLANBENCH_NEED_SHARED_DATA(below);
  for (const ProblemFiles& files : ListProblemSet(SharedData(below)).problems) {
    const Problem problem = ReadProblem(files.scene, files.request, {});
    const SceneMessage message{"r", SceneId(problem.scene), true, "", problem.scene};
    const std::vector<std::uint8_t> bytes = Encode(message);
    EXPECT_LT(bytes.size(), 65499) << "does not fit one datagram";
    EXPECT_EQ(TextOf(Decode<SceneMessage>(bytes, "CH")), TextOf(message)) << files.scene;
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, PublishedScenes,
                         testing::Values("bookshelf_small_fetch", "box_fetch", "table_pick_fetch"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace planbench
