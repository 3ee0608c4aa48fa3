#include "scene_server/scene_server_node.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/error.h"
#include "common/read_text.h"
#include "messaging/channels.h"
#include "messaging/node_registry.h"
#include "planning/told_warnings.h"
#include "robot_model/referee_misfits.h"
#include "tests/scene_server/tiny_world.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/message_collector.h"

namespace planbench {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

// Generous: what is waited for comes at once, unless it never comes.
constexpr seconds kTimeout{30};
constexpr milliseconds kRetry{500};

/// A server on a bus within this process.
class SceneServerNodeTest : public ::testing::Test {
 protected:
  SceneServerNodeTest() { bus_.Start(); }

  template <typename Request, typename Reply>
  Reply Call(const std::string& request_channel, const std::string& reply_channel,
             const Request& request) {
    RpcClient<Request, Reply> client(&bus_, request_channel, reply_channel);
    const auto reply = client.Call(request, kRetry, kTimeout);
    EXPECT_TRUE(reply.has_value()) << "no answer on " << reply_channel;
    return reply.value_or(Reply{});
  }
  ProblemMessage CallForProblem(const ProblemRequestMessage& request) {
    return Call<ProblemRequestMessage, ProblemMessage>(channel::kProblemRequest, channel::kProblem,
                                                       request);
  }

  TinyWorld world_{/*with_mesh_robot=*/true};
  Bus bus_{"memq://"};
  SceneServerNode node_{&bus_, "scene_server", &world_.service()};
};

TEST_F(SceneServerNodeTest, SendsTheSceneAndThenTheProblem) {
  MessageCollector<SceneMessage> scenes(&bus_, channel::kScene);
  const ProblemMessage problem = CallForProblem({"id", "cans", 1});
  ASSERT_TRUE(problem.ok) << problem.message;
  const std::vector<SceneMessage> received = scenes.WaitFor(1);
  ASSERT_EQ(received.size(), 1u);
  EXPECT_EQ(received[0].scene_id, problem.scene_id);
  EXPECT_EQ(SceneId(received[0].scene), problem.scene_id);
}

TEST_F(SceneServerNodeTest, RefusesAnUnknownProblem) {
  const ProblemMessage problem = CallForProblem({"id", "cans", 9});
  EXPECT_FALSE(problem.ok);
  EXPECT_THAT(problem.message, HasSubstr("no problem 9"));
}

TEST_F(SceneServerNodeTest, RepeatedRequestIsAnsweredAgainButWorkedOnOnce) {
  MessageCollector<ProblemMessage> problems(&bus_, channel::kProblem);
  MessageCollector<SceneMessage> scenes(&bus_, channel::kScene);
  const ProblemRequestMessage request{"id", "cans", 1};
  CallForProblem(request);
  CallForProblem(request);
  EXPECT_EQ(problems.WaitFor(2).size(), 2u);
  // The answer to another request, whose scene comes after whatever the repeated one brought.
  CallForProblem({"another id", "cans", 2});
  const std::vector<SceneMessage> received = scenes.WaitFor(2);
  ASSERT_EQ(received.size(), 2u);
  EXPECT_EQ(received[0].request_id, "id");
  EXPECT_EQ(received[1].request_id, "another id");
}

TEST_F(SceneServerNodeTest, AnswersSceneCollisionAndPathQueries) {
  const ProblemMessage problem = CallForProblem({"id", "cans", 1});
  const auto scene = Call<SceneRequestMessage, SceneMessage>(
      channel::kSceneRequest, channel::kScene, {"scene", problem.scene_id});
  ASSERT_TRUE(scene.ok) << scene.message;
  EXPECT_EQ(SceneId(scene.scene), problem.scene_id);

  CollisionRequestMessage collision;
  collision.request_id = "collision";
  collision.scene_id = problem.scene_id;
  collision.states = {{0, 0}, {1, 0}};
  collision.edges = {{{-1, 0}, {1, 0}}};
  const auto verdicts = Call<CollisionRequestMessage, CollisionReplyMessage>(
      channel::kCollisionRequest, channel::kCollisionReply, collision);
  ASSERT_TRUE(verdicts.ok) << verdicts.message;
  ASSERT_EQ(verdicts.states.size(), 2u);
  EXPECT_FALSE(verdicts.states[0].free);
  EXPECT_TRUE(verdicts.states[1].free);
  ASSERT_EQ(verdicts.edges.size(), 1u);
  EXPECT_FALSE(verdicts.edges[0].free);

  PathCheckRequestMessage path_check;
  path_check.request_id = "path";
  path_check.scene_id = problem.scene_id;
  path_check.group = problem.group;
  path_check.start = problem.start;
  path_check.goal = problem.goal;
  path_check.joint_names = {"lift", "swing"};
  path_check.path = {{0, kStartSwing}, {0.4, kStartSwing}, {0.4, kGoalSwing}, {0, kGoalSwing}};
  path_check.step_m = 0.01;
  path_check.with_clearance = true;
  const auto check = Call<PathCheckRequestMessage, PathCheckReplyMessage>(
      channel::kPathCheckRequest, channel::kPathCheckReply, path_check);
  ASSERT_TRUE(check.ok) << check.message;
  ASSERT_TRUE(check.verdict);
  EXPECT_TRUE(check.verdict->valid) << check.verdict->reason;
  ASSERT_TRUE(check.mesh_verdict);
  EXPECT_FALSE(check.mesh_verdict->valid);
}

TEST_F(SceneServerNodeTest, RefusalsTravelToo) {
  const auto scene = Call<SceneRequestMessage, SceneMessage>(channel::kSceneRequest,
                                                             channel::kScene, {"scene", "0123"});
  EXPECT_FALSE(scene.ok);
  EXPECT_EQ(scene.scene_id, "0123");
  CollisionRequestMessage collision;
  collision.request_id = "collision";
  collision.scene_id = "0123";
  EXPECT_FALSE((Call<CollisionRequestMessage, CollisionReplyMessage>(
                    channel::kCollisionRequest, channel::kCollisionReply, collision))
                   .ok);
  PathCheckRequestMessage path_check;
  path_check.request_id = "path";
  path_check.scene_id = "0123";
  path_check.step_m = 0.01;
  EXPECT_FALSE((Call<PathCheckRequestMessage, PathCheckReplyMessage>(
                    channel::kPathCheckRequest, channel::kPathCheckReply, path_check))
                   .ok);
}

TEST_F(SceneServerNodeTest, AnnouncesItselfAndItsSetsWhenDiscovered) {
  // Run is not running: what comes is the answer to DISCOVER.
  NodeRegistry registry(&bus_);
  registry.Discover("test");
  ASSERT_TRUE(registry.WaitUntil([&] { return registry.ProblemSets().has_value(); }, kTimeout));
  const ProblemSetsMessage sets = *registry.ProblemSets();
  EXPECT_EQ(sets.server, "scene_server");
  EXPECT_NE(sets.referee_robot_id, "");
  ASSERT_EQ(sets.sets.size(), 1u);
  EXPECT_EQ(sets.sets[0].name, "cans");
  ASSERT_TRUE(registry.WaitUntil(
      [&] { return registry.Find("scene_server", NodeKind::kSceneServer).has_value(); }, kTimeout));
  const NodeStatusMessage status = *registry.Find("scene_server", NodeKind::kSceneServer);
  EXPECT_EQ(status.robot_name, "tiny");
  EXPECT_EQ(status.robot_id, world_.service().robot().content_id);
  EXPECT_FALSE(status.settings.contains(kRefereeMisfits));
}

TEST_F(SceneServerNodeTest, TellsWhatItsRobotsAreMadeOf) {
  const auto settings_of = [&](Robot robot, std::optional<Robot> mesh_robot = {}) {
    SceneService service(std::move(robot), std::move(mesh_robot), {world_.folder() / "problems"});
    Bus bus("memq://");
    const SceneServerNode node(&bus, "scene_server", &service);
    bus.Start();
    NodeRegistry registry(&bus);
    registry.Discover("test");
    const auto find = [&] { return registry.Find("scene_server", NodeKind::kSceneServer); };
    EXPECT_TRUE(registry.WaitUntil([&] { return find().has_value(); }, kTimeout));
    return find().value_or(NodeStatusMessage()).settings;
  };
  const std::filesystem::path folder = world_.service().robot().folder;
  const std::filesystem::path spheres = folder / "spheres.yaml";
  EXPECT_FALSE(settings_of(LoadRobot(folder)).contains("spheres"));
  const auto told = settings_of(LoadRobot(folder, {}, std::filesystem::relative(spheres)));
  EXPECT_EQ(told.at("robot"), folder.string());
  const std::filesystem::path file = told.at("spheres");
  EXPECT_TRUE(file.is_absolute()) << file;
  EXPECT_TRUE(std::filesystem::equivalent(file, spheres)) << file;
  // What was odd when they were loaded,
  Robot odd = LoadRobot(folder);
  odd.warnings = {"tiny.urdf: is odd"};
  Robot judge = LoadRefereeRobot(world_.folder() / "tiny_meshes", odd);
  judge.warnings = {"it is even", "and odd"};
  EXPECT_THAT(ToldWarnings(kRobotWarning, settings_of(odd, judge)),
              testing::ElementsAre("tiny.urdf: is odd", "it is even", "and odd"));
  // and in what its referee's is another robot, as it was found then.
  EXPECT_FALSE(settings_of(odd, judge).contains(kRefereeMisfits));
  judge.referee_misfits = "it is made of ice";
  EXPECT_EQ(settings_of(odd, judge).at(kRefereeMisfits), "it is made of ice");
  std::string urdf = ReadText(world_.folder() / "tiny_meshes/tiny.urdf");
  world_.folder().Write("taller/tiny.urdf", urdf.replace(urdf.find("0 0 0.1"), 7, "0 0 0.2"));
  const Robot robot = LoadRobot(folder);
  EXPECT_THAT(
      settings_of(robot, LoadRefereeRobot(world_.folder() / "taller", robot)).at(kRefereeMisfits),
      HasSubstr("link 'arm', beyond joint 'swing', is up to 100.0 mm"));
}

TEST_F(SceneServerNodeTest, AnnouncesItsSetsAgainAndAgainWhileItRuns) {
  MessageCollector<ProblemSetsMessage> sets(&bus_, channel::kProblemSets);
  std::atomic<bool> stop = false;
  std::thread runner([&] { node_.Run([&] { return stop.load(); }); });
  EXPECT_GE(sets.WaitFor(2).size(), 2u);
  stop = true;
  runner.join();
}

/// Two servers on one bus, started one after the other.
class TwoSceneServers : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string url = fmt::format("udpm://239.255.76.67:{}?ttl=0", 20000 + getpid() % 20000);
    try {
      first_bus_ = std::make_unique<Bus>(url);
    } catch (const InputError& error) {
      GTEST_SKIP() << error.what();
    }
    second_bus_ = std::make_unique<Bus>(url);
    first_bus_->Start();
    second_bus_->Start();
  }

  void ExpectSecondIsRefused(const std::string& second_name, const std::vector<std::string>& why) {
    SceneServerNode first(first_bus_.get(), "scene_server", &world_.service());
    std::this_thread::sleep_for(milliseconds(2));  // start times are compared
    SceneServerNode second(second_bus_.get(), second_name, &world_.service());
    const auto deadline = std::chrono::steady_clock::now() + kTimeout;
    ExpectInputError(
        [&] { second.Run([&] { return std::chrono::steady_clock::now() > deadline; }); }, why);
    int asked = 0;
    EXPECT_NO_THROW(first.Run([&] { return ++asked > 3; }));
  }

  TinyWorld world_;
  std::unique_ptr<Bus> first_bus_;
  std::unique_ptr<Bus> second_bus_;
};

TEST_F(TwoSceneServers, TheLaterOfOneNameGivesWay) {
  ExpectSecondIsRefused("scene_server", {"'scene_server'"});
}

TEST_F(TwoSceneServers, TheLaterByAnotherNameGivesWay) {
  ExpectSecondIsRefused("other_server", {"another scene server, 'scene_server'"});
}

}  // namespace
}  // namespace planbench
