#include "messaging/planner_node.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <thread>

#include "common/utime.h"
#include "tests/messaging/stranger.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/message_collector.h"
#include "tests/support/planning_problems.h"
#include "tests/support/private_bus.h"
#include "tests/support/scripted_planner.h"

namespace planbench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Verdict = PlanAckVerdict;

const Robot& PlanarRobot() {
  static const Robot robot = LoadPlanarRobot();
  return robot;
}

/// A planner node and everything it talks to, on a bus within this process.
class PlannerNodeTest : public testing::Test {
 protected:
  explicit PlannerNodeTest(const std::string& url = "memq://") : bus_(url) { bus_.Start(); }
  ~PlannerNodeTest() override { StopNode(); }

  void StartNode(PlannerDescription description = ScriptedPlanner::Able(),
                 const std::vector<CollisionModel>& models = EnumValues<CollisionModel>()) {
    node_ = std::make_unique<PlannerNode>(
        &bus_, "arm",
        std::make_unique<ScriptedPlanner>(
            PlanarRobot(), [this](SearchQuery& query) { return Search(query); },
            std::move(description)),
        models, std::string(), scene_timeout_);
    runner_ = std::thread([this] { node_->Run([this] { return stop_.load(); }); });
  }
  void StopNode() {
    stop_ = true;
    if (runner_.joinable()) runner_.join();
    node_.reset();
  }
  void StartSceneServer() {
    scene_server_ = bus_.Subscribe<SceneRequestMessage>(
        channel::kSceneRequest, [this](const SceneRequestMessage& request) {
          bus_.Publish(channel::kScene,
                       SceneMessage{request.request_id, request.scene_id, true, "", scene_});
        });
  }

  SearchResult Search(SearchQuery& query) {
    ++num_searches_;
    while (hold_ && !query.ShouldStop()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (query.Cancelled() && !has_path_) {
      SearchResult cancelled;
      cancelled.status = PlanStatus::kCancelled;
      cancelled.message = "cancelled";
      return cancelled;
    }
    if (query.anytime()) query.ReportSolution(6, 18, 5);
    return StraightLine(query);
  }

  PlanRequest Request(const std::string& id) const {
    PlanRequest request = MakeRequest(PlanarRobot(), {0.6, 0, 0}, {-0.6, 0, 0});
    request.run_id = "run";
    request.request_id = id;
    request.scene_id = SceneId(scene_);
    request.robot_id = PlanarRobot().content_id;
    request.time_limit_s = 3600;
    return request;
  }
  void Send(const PlanRequest& request) { bus_.Publish(channels_.request, request); }
  void Cancel(const std::string& id) { bus_.Publish(channels_.cancel, PlanCancelMessage{id}); }
  /// Sends a request and returns its first acknowledgement.
  PlanAckMessage SendForAck(const PlanRequest& request) {
    MessageCollector<PlanAckMessage> acks(&bus_, channels_.ack);
    Send(request);
    const auto of_it = [&](const PlanAckMessage& ack) {
      return ack.request_id == request.request_id;
    };
    EXPECT_TRUE(acks.WaitForOne(of_it)) << "no acknowledgement";
    for (const PlanAckMessage& ack : acks.messages()) {
      if (of_it(ack)) return ack;
    }
    return {};
  }
  /// The result of a request, which is awaited.
  PlanResultMessage ResultOf(const std::string& id, PlanStatus status = PlanStatus::kSolved) {
    const auto of_it = [&](const PlanResultMessage& result) {
      return result.request_id == id && result.result.status == status;
    };
    EXPECT_TRUE(results_.WaitForOne(of_it)) << "no result of " << id;
    for (const PlanResultMessage& result : results_.messages()) {
      if (of_it(result)) return result;
    }
    return {};
  }
  std::size_t NumResultsOf(const std::string& id) {
    return results_.Count([&](const PlanResultMessage& r) { return r.request_id == id; });
  }
  /// Also of one that is still on its way.
  bool HasResultOf(const std::string& id) {
    PlanResultMessage last;
    last.request_id = "after " + id;
    bus_.Publish(channels_.result, last);
    EXPECT_TRUE(WaitForResultsOf(last.request_id, 1));
    return NumResultsOf(id) > 0;
  }
  bool WaitForResultsOf(const std::string& id, std::size_t count) {
    return WaitUntil([&] { return NumResultsOf(id) >= count; });
  }

  Bus bus_;
  const PlannerChannels channels_{"arm"};
  const Scene scene_ = EmptyPlanarScene();
  std::atomic<int> num_searches_ = 0;
  std::chrono::milliseconds scene_timeout_ = PlannerNode::kSceneTimeout;
  std::atomic<bool> hold_ = false;
  std::atomic<bool> has_path_ = false;  // in hand when it is cancelled
  MessageCollector<PlanResultMessage> results_{&bus_, channels_.result};
  MessageCollector<SceneRequestMessage> scene_requests_{&bus_, channel::kSceneRequest};

 private:
  std::atomic<bool> stop_ = false;
  Subscription scene_server_;
  std::unique_ptr<PlannerNode> node_;
  std::thread runner_;
};

TEST_F(PlannerNodeTest, AnnouncesWhatItIsAndCan) {
  MessageCollector<NodeStatusMessage> statuses(&bus_, channel::kNodeStatus);
  PlannerDescription able = ScriptedPlanner::Able();
  able.collision_models.push_back(CollisionModel::kEnclosing);  // of which the robot has no spheres
  StartNode(able);
  const auto heard = statuses.WaitFor(1);
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard[0].name, "arm");
  EXPECT_EQ(heard[0].kind, NodeKind::kPlanner);
  EXPECT_EQ(heard[0].robot_name, "planar3");
  EXPECT_EQ(heard[0].robot_id, PlanarRobot().content_id);
  EXPECT_EQ(heard[0].algorithm, "scripted");
  EXPECT_EQ(heard[0].planner_class, "sample-then-search");
  EXPECT_TRUE(heard[0].can_backward);
  EXPECT_TRUE(heard[0].can_anytime);
  EXPECT_TRUE(heard[0].bidirectional);
  EXPECT_TRUE(heard[0].deterministic);
  EXPECT_EQ(heard[0].collision_models, std::vector<std::string>{"spheres"});
  ASSERT_EQ(heard[0].unusable_models.size(), 1u);
  EXPECT_THAT(heard[0].unusable_models.at("enclosing"), HasSubstr("enclosing_spheres"));
  EXPECT_EQ(heard[0].settings, (std::map<std::string, std::string>{{"key", "value"}}));
  EXPECT_FALSE(heard[0].busy);
}

TEST_F(PlannerNodeTest, OffersTheModelsThatItWasStartedForAlone) {
  MessageCollector<NodeStatusMessage> statuses(&bus_, channel::kNodeStatus);
  PlannerDescription able = ScriptedPlanner::Able();
  able.collision_models.push_back(CollisionModel::kVoxels);
  StartNode(able, {CollisionModel::kVoxels});
  StartSceneServer();
  const auto heard = statuses.WaitFor(1);
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard[0].collision_models, std::vector<std::string>{"voxels"});
  PlanRequest request = Request("a");
  const PlanAckMessage ack = SendForAck(request);
  EXPECT_EQ(ack.verdict, Verdict::kRefused);
  EXPECT_THAT(ack.message, HasSubstr("'spheres' is not offered here: not among"));
  request.request_id = "b";
  request.collision_model = CollisionModel::kVoxels;
  EXPECT_EQ(SendForAck(request).verdict, Verdict::kWorking);
  ResultOf("b");
}

TEST_F(PlannerNodeTest, TellsItsProgramWhateverItsName) {
  MessageCollector<NodeStatusMessage> statuses(&bus_, channel::kNodeStatus);
  const PlannerNode node(
      &bus_, "arm",
      std::make_unique<ScriptedPlanner>(PlanarRobot(), StraightLine, ScriptedPlanner::Able()),
      {CollisionModel::kSpheres}, "planner_scripted");
  const auto heard = statuses.WaitFor(1);
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard[0].settings, (std::map<std::string, std::string>{
                                   {"key", "value"}, {"program", "planner_scripted"}}));
}

TEST_F(PlannerNodeTest, TellsOfModelsThatItWasAskedForAndCannotUse) {
  PlannerDescription able = ScriptedPlanner::Able();
  able.collision_models.push_back(CollisionModel::kEnclosing);  // of which the robot has no spheres
  const auto told = [&](const std::vector<CollisionModel>& models) {
    testing::internal::CaptureStdout();  // Where messages go.
    const PlannerNode node(
        &bus_, "arm", std::make_unique<ScriptedPlanner>(PlanarRobot(), StraightLine, able), models);
    return testing::internal::GetCapturedStdout();
  };
  EXPECT_THAT(told({CollisionModel::kSpheres}), Not(HasSubstr("cannot be used")));
  EXPECT_THAT(told({CollisionModel::kSpheres, CollisionModel::kEnclosing}),
              AllOf(HasSubstr("info"), HasSubstr("models that cannot be used: 'enclosing': ")));
  EXPECT_THAT(told({CollisionModel::kEnclosing}),
              AllOf(HasSubstr("error"), HasSubstr("no collision model can be used"),
                    HasSubstr("'enclosing': "), Not(HasSubstr("'spheres'"))));
}

TEST_F(PlannerNodeTest, AcceptsSolvesAndSendsTheResult) {
  StartNode();
  StartSceneServer();
  const PlanAckMessage ack = SendForAck(Request("a"));
  EXPECT_EQ(ack.planner, "arm");
  EXPECT_EQ(ack.verdict, Verdict::kWorking);
  const PlanResultMessage result = ResultOf("a");
  EXPECT_EQ(result.planner, "arm");
  EXPECT_EQ(result.run_id, "run");
  EXPECT_EQ(result.joint_names, (std::vector<std::string>{"shoulder", "elbow", "wrist"}));
  EXPECT_EQ(result.result.path, (Path{{0.6, 0, 0}, {-0.6, 0, 0}}));
}

TEST_F(PlannerNodeTest, AsksForASceneItLacksAndOnlyThen) {
  StartNode();
  const PlanRequest request = Request("a");
  Send(request);
  const auto asked = scene_requests_.WaitFor(2);  // repeated until it comes
  ASSERT_GE(asked.size(), 2u);
  EXPECT_EQ(asked[0].scene_id, request.scene_id);
  EXPECT_FALSE(asked[0].request_id.empty());
  EXPECT_EQ(num_searches_, 0);

  // A scene that nobody has, and another one: neither serves.
  bus_.Publish(channel::kScene, SceneMessage{"x", request.scene_id, false, "no such scene", {}});
  bus_.Publish(channel::kScene, SceneMessage{"x", SceneId(PostsScene()), true, "", PostsScene()});
  EXPECT_GE(scene_requests_.WaitFor(3).size(), 3u);
  EXPECT_EQ(num_searches_, 0);

  bus_.Publish(channel::kScene, SceneMessage{"x", request.scene_id, true, "", scene_});
  ResultOf("a");
  const std::size_t num_asked = scene_requests_.messages().size();
  Send(Request("b"));
  ResultOf("b");
  PlanRequest among_posts = Request("c");
  among_posts.scene_id = SceneId(PostsScene());
  Send(among_posts);
  ResultOf("c");
  EXPECT_EQ(scene_requests_.messages().size(), num_asked);
}

TEST_F(PlannerNodeTest, IsBusyWithOneRequestAtATime) {
  hold_ = true;
  StartNode();
  StartSceneServer();
  Send(Request("a"));
  ASSERT_TRUE(WaitUntil([&] { return num_searches_ == 1; }));
  const PlanAckMessage ack = SendForAck(Request("b"));
  EXPECT_EQ(ack.verdict, Verdict::kBusy);
  EXPECT_THAT(ack.message, HasSubstr("a"));
  hold_ = false;
  ResultOf("a");
  EXPECT_EQ(SendForAck(Request("b")).verdict, Verdict::kWorking);
  ResultOf("b");
}

TEST_F(PlannerNodeTest, HeartbeatsGoOnWhileItSolves) {
  hold_ = true;
  StartNode();
  StartSceneServer();
  MessageCollector<NodeStatusMessage> statuses(&bus_, channel::kNodeStatus);
  Send(Request("a"));
  ASSERT_TRUE(WaitUntil([&] { return num_searches_ == 1; }));
  EXPECT_TRUE(WaitUntil([&] {
    return statuses.Count([](const NodeStatusMessage& status) {
      return status.busy && status.request_id == "a";
    }) >= 2;
  }));
  hold_ = false;
  ResultOf("a");
  const std::size_t before = statuses.messages().size();
  statuses.WaitFor(before + 2);
  EXPECT_FALSE(statuses.messages().back().busy);
  EXPECT_TRUE(statuses.messages().back().request_id.empty());
}

TEST_F(PlannerNodeTest, RefusesWhatItCannotDoAndSaysWhy) {
  PlannerDescription modest = ScriptedPlanner::Able();
  modest.backward = false;
  modest.anytime = false;
  StartNode(modest);
  const auto expect_refusal = [&](const PlanRequest& request, const std::string& why) {
    const PlanAckMessage ack = SendForAck(request);
    EXPECT_EQ(ack.verdict, Verdict::kRefused) << request.request_id;
    EXPECT_THAT(ack.message, HasSubstr(why));
  };
  PlanRequest request = Request("other robot");
  request.robot_id = "another";
  expect_refusal(request, "another");
  request = Request("meshes");
  request.collision_model = CollisionModel::kMeshes;
  expect_refusal(request, "'meshes'");
  request = Request("backward");
  request.direction = Direction::kBackward;
  expect_refusal(request, "backward");
  request = Request("anytime");
  request.anytime = true;
  expect_refusal(request, "anytime");

  request = Request("any robot");
  request.robot_id.clear();
  EXPECT_EQ(SendForAck(request).verdict, Verdict::kWorking);
}

TEST_F(PlannerNodeTest, RefusesAMalformedRequestByItsId) {
  StartNode();
  PlanRequest request = Request("a");
  request.time_limit_s = std::numeric_limits<double>::quiet_NaN();
  const PlanAckMessage ack = SendForAck(request);
  EXPECT_EQ(ack.verdict, Verdict::kRefused);
  EXPECT_THAT(ack.message, HasSubstr(channels_.request));
  EXPECT_THAT(ack.message, HasSubstr("time_limit_s"));
}

TEST_F(PlannerNodeTest, ASpoiledCopyOfARequestThatWasTakenChangesNothing) {
  hold_ = true;
  StartNode();
  StartSceneServer();
  MessageCollector<PlanAckMessage> acks(&bus_, channels_.ack);
  Send(Request("a"));
  ASSERT_TRUE(WaitUntil([&] { return num_searches_ == 1; }));
  PlanRequest spoiled = Request("a");
  spoiled.time_limit_s = std::numeric_limits<double>::quiet_NaN();
  Send(spoiled);
  EXPECT_EQ(SendForAck(Request("a")).verdict, Verdict::kWorking);
  hold_ = false;
  ResultOf("a");
  Send(spoiled);
  Send(Request("a"));
  ASSERT_TRUE(WaitForResultsOf("a", 2));
  for (const PlanAckMessage& ack : acks.messages()) EXPECT_EQ(ack.verdict, Verdict::kWorking);
}

TEST_F(PlannerNodeTest, DropsARequestWithoutIdAndGoesOn) {
  StartNode();
  StartSceneServer();
  MessageCollector<PlanAckMessage> acks(&bus_, channels_.ack);
  Send(Request(""));
  bus_.PublishBytes(channels_.request, std::vector<std::uint8_t>{1, 2, 3});
  Send(Request("a"));
  ResultOf("a");
  EXPECT_EQ(acks.messages().size(), 1u);
}

TEST_F(PlannerNodeTest, RequestThatCannotBeResolvedIsAResult) {
  StartNode();
  StartSceneServer();
  PlanRequest request = Request("a");
  request.group = "tail";
  Send(request);
  EXPECT_THAT(ResultOf("a", PlanStatus::kInvalidRequest).result.message, HasSubstr("tail"));
}

TEST_F(PlannerNodeTest, RepeatedRequestIsNoSecondSolve) {
  hold_ = true;
  StartNode();
  StartSceneServer();
  Send(Request("a"));
  ASSERT_TRUE(WaitUntil([&] { return num_searches_ == 1; }));
  EXPECT_EQ(SendForAck(Request("a")).verdict, Verdict::kWorking);
  EXPECT_EQ(NumResultsOf("a"), 0);
  hold_ = false;
  const PlanResultMessage result = ResultOf("a");
  Send(Request("a"));
  ASSERT_TRUE(WaitForResultsOf("a", 2));
  EXPECT_TRUE(results_.messages().back() == result);
  EXPECT_EQ(num_searches_, 1);
}

TEST_F(PlannerNodeTest, RemembersTheLastResults) {
  StartNode();
  StartSceneServer();
  const auto id = [](std::size_t i) { return std::to_string(i); };
  for (std::size_t i = 0; i <= AnswerMemory::kCapacity; ++i) {
    Send(Request(id(i)));
    ResultOf(id(i));
  }
  const int num_searches = num_searches_;
  Send(Request(id(1)));
  ASSERT_TRUE(WaitForResultsOf(id(1), 2));
  EXPECT_EQ(num_searches_, num_searches);
  Send(Request(id(0)));  // forgotten
  ASSERT_TRUE(WaitForResultsOf(id(0), 2));
  EXPECT_EQ(num_searches_, num_searches + 1);
}

TEST_F(PlannerNodeTest, ProgressIsPublished) {
  MessageCollector<PlanProgressMessage> progress(&bus_, channels_.progress);
  StartNode();
  StartSceneServer();
  PlanRequest request = Request("a");
  request.anytime = true;
  Send(request);
  const auto heard = progress.WaitFor(1);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].planner, "arm");
  EXPECT_EQ(heard[0].request_id, "a");
  EXPECT_EQ(heard[0].progress.epsilon, 3);
  EXPECT_EQ(heard[0].progress.cost, 18);
  EXPECT_EQ(heard[0].progress.expansions, 5);
  EXPECT_EQ(ResultOf("a").result.progress.size(), 1u);
}

TEST_F(PlannerNodeTest, CancelEndsTheSearch) {
  hold_ = true;
  StartNode();
  StartSceneServer();
  Send(Request("a"));
  ASSERT_TRUE(WaitUntil([&] { return num_searches_ == 1; }));
  Cancel("another");
  EXPECT_EQ(SendForAck(Request("b")).verdict, Verdict::kBusy);
  Cancel("a");
  EXPECT_TRUE(ResultOf("a", PlanStatus::kCancelled).result.path.empty());
}

TEST_F(PlannerNodeTest, CancelEndsTheWaitForTheScene) {
  StartNode();
  Send(Request("a"));
  ASSERT_FALSE(scene_requests_.WaitFor(1).empty());
  Cancel("a");
  EXPECT_THAT(ResultOf("a", PlanStatus::kCancelled).result.message, HasSubstr("scene"));
  EXPECT_EQ(num_searches_, 0);
}

TEST_F(PlannerNodeTest, SaysWhyItLacksTheScene) {
  StartNode();
  const auto lack = [&](const std::string& id, const SceneMessage& answer) {
    Send(Request(id));
    EXPECT_TRUE(scene_requests_.WaitForOne(
        [&](const SceneRequestMessage& request) { return request.request_id == "arm/" + id; }));
    bus_.Publish(channel::kScene, answer);
    Cancel(id);
    return ResultOf(id, PlanStatus::kCancelled).result.message;
  };
  Scene bad = scene_;
  AttachedObject& tool = bad.attached.emplace_back();
  tool.link = "hand";
  tool.object.id = "tool";
  tool.touch_links = {"finger", "finger"};
  const std::string scene_id = Request("").scene_id;
  EXPECT_THAT(lack("a", {"arm/a", scene_id, true, "", bad}),
              HasSubstr("scene: SCENE: attached[0].touch_link[1]: 'finger' occurs twice"));
  EXPECT_THAT(lack("b", {"arm/b", scene_id, false, "it was eaten", {}}),
              HasSubstr("scene: it was eaten"));
  // What others are sent is nothing to this one.
  EXPECT_THAT(lack("c", {"leg/c", scene_id, true, "", bad}), testing::EndsWith("the scene"));
}

TEST_F(PlannerNodeTest, OfASceneThatDoesNotComeItTellsWhoWasHeard) {
  scene_timeout_ = std::chrono::milliseconds(500);
  StartNode();
  Send(Request("a"));
  EXPECT_EQ(ResultOf("a", PlanStatus::kInvalidRequest).result.message,
            "no scene within 0.5 s, nor was a scene server heard");
  NodeStatusMessage server = MakeNodeStatus("scene_server", NodeKind::kSceneServer);
  server.host = "office";
  const Subscription asked = bus_.Subscribe<SceneRequestMessage>(
      channel::kSceneRequest,
      [&](const SceneRequestMessage&) { bus_.Publish(channel::kNodeStatus, server); });
  Send(Request("b"));
  EXPECT_THAT(ResultOf("b", PlanStatus::kInvalidRequest).result.message,
              AllOf(HasSubstr("no scene within 0.5 s, though the scene server on office ("),
                    HasSubstr("ttl=0"), HasSubstr("MTUs differ"), HasSubstr("bus_doctor")));
}

class PlannerNodeOnTheNetworkTest : public PlannerNodeTest {
 protected:
  PlannerNodeOnTheNetworkTest() : PlannerNodeTest(PrivateUdpUrl()) {}
};

TEST_F(PlannerNodeOnTheNetworkTest, TellsOfLargeMessagesThatCameInPartWhileItLackedTheScene) {
  StartNode();
  const Stranger stranger(bus_.url());
  // The first of two packets.
  const auto send_a_part = [&](char sequence) {
    std::string packet("LC03\0\0\0 \0\0\0\4\0\0\0\0\0\0\0\2A\0ab", 24);
    packet[7] = sequence;
    stranger.Send(packet);
  };
  const auto are_given_up = [&](int number) {
    return WaitUntil([&] { return bus_.counters().incomplete == number; });
  };
  for (const char sequence : {'\1', '\2', '\3'}) send_a_part(sequence);
  ASSERT_TRUE(are_given_up(2));
  Send(Request("a"));
  ASSERT_FALSE(scene_requests_.WaitFor(1).empty());
  send_a_part('\4');
  ASSERT_TRUE(are_given_up(3));
  Cancel("a");
  EXPECT_THAT(ResultOf("a", PlanStatus::kCancelled).result.message,
              HasSubstr("the scene; meanwhile 1 large messages came in part only"));
}

TEST_F(PlannerNodeTest, CancelledRequestStaysCancelled) {
  hold_ = true;
  StartNode();
  StartSceneServer();
  Send(Request("a"));
  ASSERT_TRUE(WaitUntil([&] { return num_searches_ == 1; }));
  Cancel("a");
  ResultOf("a", PlanStatus::kCancelled);
  Send(Request("a"));  // repeated before the cancellation, and late
  ASSERT_TRUE(WaitForResultsOf("a", 2));
  EXPECT_EQ(results_.messages().back().result.status, PlanStatus::kCancelled);
  EXPECT_EQ(num_searches_, 1);
}

TEST_F(PlannerNodeTest, CancellationOfASolvedRequestBringsItsResult) {
  StartNode();
  StartSceneServer();
  Send(Request("a"));
  ResultOf("a");
  Cancel("a");
  ASSERT_TRUE(WaitForResultsOf("a", 2));
  EXPECT_EQ(results_.messages().back().result.status, PlanStatus::kSolved);
}

TEST_F(PlannerNodeTest, EndsWhileSolvingWithoutAResult) {
  hold_ = true;
  StartNode();
  StartSceneServer();
  Send(Request("a"));
  ASSERT_TRUE(WaitUntil([&] { return num_searches_ == 1; }));
  StopNode();
  EXPECT_FALSE(HasResultOf("a"));
}

TEST_F(PlannerNodeTest, EndsWithoutAResultThatItCutShort) {
  hold_ = has_path_ = true;
  StartNode();
  StartSceneServer();
  Send(Request("a"));
  ASSERT_TRUE(WaitUntil([&] { return num_searches_ == 1; }));
  StopNode();
  EXPECT_FALSE(HasResultOf("a"));
}

TEST_F(PlannerNodeTest, EndsWhileWaitingForTheSceneWithoutAResult) {
  StartNode();
  Send(Request("a"));
  ASSERT_FALSE(scene_requests_.WaitFor(1).empty());
  StopNode();
  EXPECT_FALSE(HasResultOf("a"));
}

TEST_F(PlannerNodeTest, GivesWayToAnOlderProcessOfItsName) {
  NodeStatusMessage older = MakeNodeStatus("arm", NodeKind::kPlanner);
  older.instance = "older";
  older.start_utime -= 1'000'000;
  PlannerNode node(&bus_, "arm",
                   std::make_unique<ScriptedPlanner>(
                       PlanarRobot(), [](SearchQuery& query) { return StraightLine(query); }));
  older.utime = NowUtime();
  bus_.Publish(channel::kNodeStatus, older);
  ++older.utime;
  bus_.Publish(channel::kNodeStatus, older);
  const auto deadline = std::chrono::steady_clock::now() + kTestPatience;
  ExpectInputError([&] { node.Run([&] { return std::chrono::steady_clock::now() >= deadline; }); },
                   {"'arm' is live already"});
}

TEST_F(PlannerNodeTest, NameMustFitAChannel) {
  ExpectInputError(
      [&] {
        PlannerNode(&bus_, "an arm",
                    std::make_unique<ScriptedPlanner>(
                        PlanarRobot(), [](SearchQuery& query) { return StraightLine(query); }));
      },
      {"an arm"});
}

}  // namespace
}  // namespace planbench
