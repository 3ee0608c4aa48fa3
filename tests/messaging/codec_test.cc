#include "messaging/codec.h"

#include <gmock/gmock.h>

#include <regex>

#include "messaging/any_message.h"
#include "messaging/node_announcer.h"
#include "messaging/wire.h"
#include "scene/moveit_yaml.h"
#include "tests/messaging/codec_fixture.h"
#include "tests/support/shared_data.h"

namespace planbench {
namespace {

using testing::HasSubstr;

/// All fields as text, without the moment of sending.
template <typename Message>
std::string TextOf(const Message& message) {
  static const std::regex kUtime(" *utime: .*\n");
  return std::regex_replace(Print<Message>(Encode(message), "CH"), kUtime, "");
}

template <typename Message>
class EveryMessage : public CodecTest {};
TYPED_TEST_SUITE(EveryMessage, AllMessages);

TYPED_TEST(EveryMessage, KeepsEveryField) {
  const TypeParam message = Example<TypeParam>();
  const auto decoded = Decode<TypeParam>(Encode(message), "CH");
  EXPECT_EQ(TextOf(decoded), TextOf(message));
  if constexpr (std::equality_comparable<TypeParam>) {
    EXPECT_TRUE(decoded == message);
    EXPECT_FALSE(decoded == TypeParam{});
  }
}

TYPED_TEST(EveryMessage, IsKnownByItsFingerprint) {
  const std::vector<std::uint8_t> bytes = Encode(Example<TypeParam>());
  const auto printed = PrintAny(bytes, "CH");
  ASSERT_TRUE(printed);
  EXPECT_EQ(printed->type, Fields<TypeParam>::Wire::getTypeName());
  EXPECT_EQ(printed->text, Print<TypeParam>(bytes, "CH"));
  EXPECT_THROW(PrintAny(std::span(bytes).first(bytes.size() - 1), "CH"), MessageError);
}

TEST(PrintAny, LeavesWhatItDoesNotKnow) {
  EXPECT_FALSE(PrintAny({}, "CH"));
  EXPECT_FALSE(PrintAny(std::vector<std::uint8_t>(7, 0), "CH"));
  EXPECT_FALSE(PrintAny(std::vector<std::uint8_t>(100, 0x5a), "CH"));
}

TYPED_TEST(EveryMessage, WhatIsSpoiltIsRefusedWhereItStands) {
  using Wire = typename Fields<TypeParam>::Wire;
  const std::vector<std::uint8_t> good = Encode(Example<TypeParam>());
  int which = 0;
  for (;; ++which) {
    auto wire = wire::Unpack<Wire>(good, "CH");
    Spoiler spoiler(which);
    TypeParam unused;
    Fields<TypeParam>::List(spoiler, unused, wire);
    if (spoiler.place().empty()) break;
    const MessageError error = DecodeError<TypeParam>(wire::Pack(wire));
    EXPECT_THAT(error.what(), testing::StartsWith("CH: " + spoiler.place() + ": "));
    if constexpr (requires { wire.request_id; }) {
      EXPECT_EQ(error.request_id(), wire.request_id);
    }
  }
  EXPECT_EQ(which > 0, (!std::is_same_v<TypeParam, DiscoverMessage>));
}

// A count stands before its list, so the first byte that differs in a message with a longer list is
// the count's last.
TYPED_TEST(EveryMessage, EveryWrongCountIsRefused) {
  using Wire = typename Fields<TypeParam>::Wire;
  const std::vector<std::uint8_t> good = Encode(Example<TypeParam>());
  const auto original = wire::Unpack<Wire>(good, "CH");
  for (int which = 0;; ++which) {
    auto wire = original;
    Stretcher stretcher(which);
    TypeParam unused;
    Fields<TypeParam>::List(stretcher, unused, wire);
    if (!stretcher.done()) break;
    const auto longer = wire::Pack(wire);
    const auto difference = std::mismatch(good.begin(), good.end(), longer.begin()).first;
    const auto place = static_cast<std::size_t>(difference - good.begin());
    for (const std::uint32_t bad :
         {good[place] + 1U, good[place] - 1U, 0U, 0x7fffffffU, 0x80000000U, 0xffffffffU}) {
      std::vector<std::uint8_t> bytes = good;
      for (std::size_t j = 0; j < 4; ++j) {
        bytes[place - j] = static_cast<std::uint8_t>(bad >> (8 * j));
      }
      EXPECT_THROW(Decode<TypeParam>(bytes, "CH"), MessageError) << bad << " at byte " << place;
    }
  }
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

// A field that stands in lcmtypes/ and in no list would be sent as nothing.
template <typename Value>
class EveryList : public testing::Test {};
TYPED_TEST_SUITE(EveryList, AllMessages);

TYPED_TEST(EveryList, NamesEveryMember) {
  typename Fields<TypeParam>::Wire wire{};
  MemberCollector collector;
  TypeParam unused;
  Fields<TypeParam>::List(collector, unused, wire);
  EXPECT_EQ(collector.count(), NumMembers<typename Fields<TypeParam>::Wire>());
}

class Codec : public CodecTest {};

TEST_F(Codec, WhatNobodyAnsweredHasEmptyParts) {
  RunRecordMessage message;
  message.run_id = "session";
  message.request_id = "r";
  message.planner = message.contestant = "ara";
  EXPECT_TRUE(Decode<RunRecordMessage>(Encode(message), "CH") == message);
}

TEST_F(Codec, RefusalsAreEmptyButForTheReason) {
  ProblemMessage problem;
  problem.request_id = "r";
  problem.ok = false;
  problem.message = "no such set";
  EXPECT_TRUE(Decode<ProblemMessage>(Encode(problem), "CH") == problem);

  const SceneMessage scene{"r", "5c", false, "no such scene", {}};
  EXPECT_EQ(TextOf(Decode<SceneMessage>(Encode(scene), "CH")), TextOf(scene));
}

TEST_F(Codec, ResultWithoutPathHasNoJointNames) {
  PlanResultMessage message = Example<PlanResultMessage>();
  message.result.path.clear();
  message.result.simplified_path.clear();
  const auto decoded = Decode<PlanResultMessage>(Encode(message), "CH");
  message.joint_names.clear();
  EXPECT_TRUE(decoded == message);
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

  CollisionRequestMessage collision = Example<CollisionRequestMessage>();
  collision.states[1].push_back(0);
  EXPECT_THROW(Encode(collision), std::logic_error);
  collision = Example<CollisionRequestMessage>();
  collision.edges[0].to.pop_back();
  EXPECT_THROW(Encode(collision), std::logic_error);
}

TEST_F(Codec, PrintsFieldsAsTheyCame) {
  auto wire = wire::Unpack<lcmt_run_record>(Encode(Example<RunRecordMessage>()), "CH");
  wire.planner = "a\"\n";
  wire.trial = -5;
  wire.roundtrip_time_s = std::nan("");
  wire.result.status = 99;
  const std::string text = Print<RunRecordMessage>(wire::Pack(wire), "CH");
  for (const char* line :
       {"\nplanner: \"a\\\"\\n\"\n", "\ntrial: -5\n", "\nroundtrip_time_s: nan\n",
        "\nstatus: MEMORY_LIMIT\n", "\nrequest:\n  utime: ", "\n  status: 99\n",
        "\n  goal[1]:\n    joint_name: \"text-", "\n    position[1]: [0.0"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
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
  const Robot fetch = LoadRobot(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "robots/fetch");
  for (const ProblemFiles& files : ListProblemSet(SharedData(below)).problems) {
    const Problem problem = ReadProblem(files.scene, files.request, fetch);
    const SceneMessage message{"r", SceneId(problem.scene), true, "", problem.scene};
    const std::vector<std::uint8_t> bytes = Encode(message);
    EXPECT_LT(bytes.size(), 65499) << "does not fit one datagram";
    EXPECT_EQ(TextOf(Decode<SceneMessage>(bytes, "CH")), TextOf(message)) << files.scene;
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, PublishedScenes,
                         testing::Values("bookshelf_small_fetch", "box_fetch", "table_pick_fetch"),
                         [](const auto& test) { return test.param; });

TEST(CodecTest, TextsAreDecodedPrintable) {
  PlanAckMessage ack;
  ack.planner = "r\x1b[2Jrtc";
  ack.request_id = "a\nb";
  ack.message = "caf\xc3\xa9 caf\xe9 \xff\x7f end";
  const auto decoded = Decode<PlanAckMessage>(Encode(ack), "C");
  EXPECT_EQ(decoded.planner, "r\\x1b[2Jrtc");
  EXPECT_EQ(decoded.request_id, "a\\nb");
  EXPECT_EQ(decoded.message, "caf\xc3\xa9 caf\\xe9 \\xff\\x7f end");
  ack.message =
      "safe \xe2\x80\xae"
      "elif\xe2\x80\xa8 \xc2\x9b";
  EXPECT_EQ(Decode<PlanAckMessage>(Encode(ack), "C").message,
            "safe \\xe2\\x80\\xaeelif\\xe2\\x80\\xa8 \\xc2\\x9b");
  NodeStatusMessage status = MakeNodeStatus("arm", NodeKind::kPlanner);
  status.collision_models = {"sph\teres"};
  status.settings = {{"k\r", std::string(3000, 'x') + "\n"}};
  const auto heard = Decode<NodeStatusMessage>(Encode(status), "C");
  EXPECT_EQ(heard.collision_models[0], "sph\\teres");
  EXPECT_EQ(heard.settings.at("k\\r"), std::string(3000, 'x') + "\\n");  // as long as it was
}

}  // namespace
}  // namespace planbench
