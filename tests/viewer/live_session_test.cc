#include "viewer/live_session.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/polyhedra.h"
#include "robot_model/mesh_robot_id.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/mesh_arm.h"
#include "tests/support/obj_text.h"
#include "tests/support/planar_session.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

class LiveSessionTest : public testing::Test {
 protected:
  template <typename Message>
  void Hear(const std::string& channel, const Message& message) {
    live_.Hear(PlanarSession::Received(channel, message), kStart);
  }
  Json State(std::chrono::milliseconds later = {}) const { return live_.State(kStart + later, {}); }
  static constexpr LiveSession::TimePoint kStart{};

  PlanarSession bus_;
  LiveSession live_{""};
};

TEST_F(LiveSessionTest, ShowsARequestThenItsPathThenTheVerdict) {
  EXPECT_FALSE(live_.View());
  Hear(channel::kSession, bus_.session);
  Hear("PLAN_REQUEST_ARA", bus_.request);
  EXPECT_THAT(std::string((*live_.View())["message"]),
              testing::HasSubstr("sent before this viewer listened"));
  Hear(channel::kScene, bus_.scene);
  Json view = *live_.View();
  EXPECT_FALSE(view["links"].empty());
  EXPECT_TRUE(view["motions"].empty());
  EXPECT_EQ(view["title"], "shelf 1");
  EXPECT_EQ(view["facts"], Json({"ARA*, forward, trial 2: is being planned."}));
  const std::int64_t before = live_.view_number();
  Hear("PLAN_REQUEST_ARA", bus_.request);  // repeated
  EXPECT_EQ(live_.view_number(), before);
  Hear("PLAN_RESULT_ARA", bus_.result);
  EXPECT_GT(live_.view_number(), before);
  view = *live_.View();
  EXPECT_EQ(view["motions"].size(), 1u);
  EXPECT_EQ(view["title"], "shelf 1");
  EXPECT_EQ(view["facts"][0], "ARA*, forward, trial 2: SOLVED.");
  bus_.record.status = PlanStatus::kInvalidPath;
  bus_.record.path_check.verdict.emplace();
  bus_.record.path_check.verdict->segment = 0;
  bus_.record.path_check.verdict->fraction = 0.5;
  bus_.record.path_check.verdict->reason = "hits itself";
  Hear(channel::kRunRecord, bus_.record);
  view = *live_.View();
  EXPECT_EQ(view["title"], "shelf 1");
  EXPECT_EQ(view["motions"][0]["remarks"], Json({"the referee: hits itself"}));
}

TEST_F(LiveSessionTest, TellsOfARequestWhatIsKnown) {
  Hear(channel::kSession, bus_.session);
  Hear(channel::kScene, bus_.scene);
  const auto title_and_facts = [&](const std::string& id) {
    bus_.request.request_id = id;
    Hear("PLAN_REQUEST_ARA", bus_.request);
    const Json view = *live_.View();
    return Json{view["title"], view["facts"]};
  };
  EXPECT_EQ(title_and_facts("session/a/b 1/12/ara/backward/3/first-path@7"),
            (Json{"a/b 1 12", {"ARA*, forward, trial 3: a first path is being planned."}}));
  EXPECT_EQ(title_and_facts("session/shelf/2/ara/forward/1@7/warm-up"),
            (Json{"shelf 2", {"ARA*, forward, trial 1: is being planned to warm up."}}));
  // A request of somebody else's has an id of its own.
  EXPECT_EQ(title_and_facts("mine"), (Json{"Request mine", {"ARA, forward: is being planned."}}));
}

TEST_F(LiveSessionTest, CountsEveryRunOnce) {
  Hear(channel::kSession, bus_.session);
  Hear(channel::kRunRecord, bus_.record);
  Hear(channel::kRunRecord, bus_.record);
  bus_.record.request_id = "session/shelf/2/ara/forward/1";
  bus_.record.status = PlanStatus::kNoAnswer;
  Hear(channel::kRunRecord, bus_.record);
  const Json state = State();
  EXPECT_EQ(state["session"]["num_runs"], 4);
  ASSERT_EQ(state["contestants"].size(), 1u);
  EXPECT_EQ(state["contestants"][0]["runs"], 2);
  EXPECT_EQ(state["contestants"][0]["solved"], 1);
  ASSERT_EQ(state["runs"].size(), 2u);
  EXPECT_EQ(state["runs"][0]["time_s"], nullptr);  // no answer, no time
  EXPECT_EQ(state["runs"][1]["time_s"], 0.25);
}

TEST_F(LiveSessionTest, ASessionThatIsReplayedAfterAnotherShowsItsRunsAgain) {
  const std::string run_id = bus_.session.run_id;
  for (const std::string& one : {run_id, std::string("another"), run_id}) {
    bus_.session.run_id = one;
    Hear(channel::kSession, bus_.session);
    EXPECT_EQ(State()["runs"].size(), 0u) << one;
    if (one == run_id) Hear(channel::kRunRecord, bus_.record);
  }
  EXPECT_EQ(State()["runs"].size(), 1u);
  EXPECT_EQ(State()["contestants"][0]["runs"], 1);
}

TEST_F(LiveSessionTest, ARunThatWasNotAskedGivesWayToOneThatWas) {
  Hear(channel::kSession, bus_.session);
  RunRecordMessage not_asked = bus_.record;
  not_asked.status = PlanStatus::kNoAnswer;
  not_asked.roundtrip_time_s = 0;
  not_asked.result = {};
  not_asked.message = "given up";
  RunRecordMessage not_asked_again = not_asked;
  not_asked_again.start_utime += 1;
  not_asked_again.message = "given up again";
  for (const RunRecordMessage& record : {not_asked, not_asked_again, not_asked}) {
    Hear(channel::kRunRecord, record);
  }
  ASSERT_EQ(State()["runs"].size(), 1u);
  EXPECT_EQ(State()["runs"][0]["reason"], "given up again");
  for (const RunRecordMessage& record : {bus_.record, not_asked_again}) {
    Hear(channel::kRunRecord, record);
  }
  const Json state = State();
  EXPECT_EQ(state["contestants"][0]["runs"], 1);
  EXPECT_EQ(state["contestants"][0]["solved"], 1);
  ASSERT_EQ(state["runs"].size(), 1u);
  EXPECT_EQ(state["runs"][0]["time_s"], 0.25);
}

TEST_F(LiveSessionTest, ADisturbedRunGivesWayToItsRepeatAndCountsOnce) {
  Hear(channel::kSession, bus_.session);
  bus_.record.result.result.counters["disturbed"] = 1;
  Hear(channel::kRunRecord, bus_.record);
  for (const PlanStatus status : {PlanStatus::kSolved, PlanStatus::kTimedOut}) {
    bus_.record.status = status;
    ++bus_.record.result.result.counters["repeats"];
    Hear(channel::kRunRecord, bus_.record);
    const Json state = State();
    EXPECT_EQ(state["runs"].size(), 1u);
    EXPECT_EQ(state["contestants"][0]["runs"], 1);
    EXPECT_EQ(state["contestants"][0]["solved"], status == PlanStatus::kSolved ? 1 : 0);
  }
}

TEST_F(LiveSessionTest, KnowsWhoIsThereAndWhoIsGone) {
  NodeStatusMessage node;
  node.name = "ara";
  node.instance = std::string(16, 'a');
  node.busy = true;
  node.request_id = bus_.request.request_id;
  Hear(channel::kNodeStatus, node);
  EXPECT_EQ(State(std::chrono::milliseconds(2900))["nodes"][0]["gone"], false);
  EXPECT_EQ(State(std::chrono::milliseconds(2900))["nodes"][0]["busy"], true);
  EXPECT_EQ(State(std::chrono::milliseconds(3100))["nodes"][0]["gone"], true);
}

TEST_F(LiveSessionTest, WhoIsGoneSinceBeforeTheSessionIsLeftOut) {
  NodeStatusMessage node;
  node.name = "ara";
  node.instance = std::string(16, 'a');
  Hear(channel::kSession, bus_.session);
  Hear(channel::kNodeStatus, node);
  bus_.session.run_id = "another";
  live_.Hear(PlanarSession::Received(channel::kSession, bus_.session),
             kStart + std::chrono::seconds(1));
  node.name = "rrtc";
  live_.Hear(PlanarSession::Received(channel::kNodeStatus, node), kStart + std::chrono::seconds(2));
  EXPECT_EQ(State(std::chrono::seconds(2))["nodes"].size(), 2u);  // it may be of this one, too
  const Json nodes = State(std::chrono::seconds(9))["nodes"];
  ASSERT_EQ(nodes.size(), 1u);
  EXPECT_EQ(nodes[0]["name"], "rrtc");
  EXPECT_EQ(nodes[0]["gone"], true);
}

TEST_F(LiveSessionTest, AStrangersManyNamesTakeNoMorePlaceThanTheyMay) {
  NodeStatusMessage node;
  node.instance = std::string(16, 'a');
  const auto hear = [&](const std::string& name, std::chrono::seconds later) {
    node.name = name;
    live_.Hear(PlanarSession::Received(channel::kNodeStatus, node), kStart + later);
  };
  const auto last_name = [&] { return State(std::chrono::seconds(9))["nodes"].back()["name"]; };
  for (int i = 0; i < 1000; ++i) hear(fmt::format("a{}", i), {});
  hear("rrtc", {});
  EXPECT_LE(State()["nodes"].size(), 256u);
  EXPECT_NE(last_name(), "rrtc");
  hear("rrtc", std::chrono::seconds(9));  // the others are gone
  EXPECT_EQ(last_name(), "rrtc");
}

TEST_F(LiveSessionTest, OfManyImprovementsTheLatestAreTold) {
  Hear("PLAN_REQUEST_ARA", bus_.request);
  PlanProgressMessage progress;
  progress.planner = "ara";
  progress.request_id = bus_.request.request_id;
  for (int i = 1; i <= 1000; ++i) {
    progress.progress = {1e-3 * i, 0, 2000.0 - i, 7};
    Hear("PLAN_PROGRESS_ARA", progress);
  }
  const Json told = State()["progress"];
  EXPECT_EQ(told.size(), 200u);
  EXPECT_EQ(told.back()["cost"], 1000);
}

TEST_F(LiveSessionTest, ARobotFolderThatIsNoneIsRefusedAtOnce) {
  ExpectInputError([] { LiveSession("/nowhere"); }, {"/nowhere"});
}

TEST_F(LiveSessionTest, TellsTheImprovementsOfTheRequestShown) {
  Hear("PLAN_REQUEST_ARA", bus_.request);
  PlanProgressMessage progress;
  progress.planner = "ara";
  progress.request_id = bus_.request.request_id;
  progress.progress = {0.5, 3, 20, 7};
  Hear("PLAN_PROGRESS_ARA", progress);
  progress.request_id = "another";
  Hear("PLAN_PROGRESS_ARA", progress);
  const Json state = State();
  ASSERT_EQ(state["progress"].size(), 1u);
  EXPECT_EQ(state["progress"][0]["cost"], 20);
  EXPECT_EQ(state["progress"][0]["bound"], 3);

  progress.request_id = bus_.request.request_id;
  progress.progress = {0.6, 1, 0, 7};
  Hear("PLAN_PROGRESS_ARA", progress);
  EXPECT_EQ(State()["progress"][1]["cost"], 0) << "proven";
}

TEST_F(LiveSessionTest, ImprovementsThatAreNoneAreNotShown) {
  Hear("PLAN_REQUEST_ARA", bus_.request);
  PlanProgressMessage progress;
  progress.planner = "ara";
  progress.request_id = bus_.request.request_id;
  const auto costs_after = [&](const PlanProgress& next) {
    progress.progress = next;
    Hear("PLAN_PROGRESS_ARA", progress);
    const Json state = State();
    Json costs = Json::array();
    for (const Json& one : state["progress"]) costs.push_back(one["cost"]);
    return costs;
  };
  EXPECT_EQ(costs_after({0.5, 3, 20, 7}), Json::array({20}));
  EXPECT_EQ(costs_after({0.6, 2, 21, 8}), Json::array({20})) << "it costs more";
  EXPECT_EQ(costs_after({0.4, 2, 19, 8}), Json::array({20})) << "it came before";
  EXPECT_EQ(State()["undecodable"], 2);
  EXPECT_EQ(costs_after({0.7, 2, 18, 9}), Json::array({20, 18}));
  // Of a planner whose result is refused, the record has no improvements.
  bus_.record.status = PlanStatus::kNoAnswer;
  bus_.record.result = {};
  Hear(channel::kRunRecord, bus_.record);
  EXPECT_EQ(State()["progress"], Json::array());
  bus_.request.request_id = "the next";
  Hear("PLAN_REQUEST_ARA", bus_.request);
  progress.request_id = "the next";
  EXPECT_EQ(costs_after({0.1, 3, 30, 7}), Json::array({30}));
}

TEST_F(LiveSessionTest, WhatCannotBeReadIsCountedAndWhatCannotBeShownSaysWhy) {
  live_.Hear({channel::kRunRecord, {1, 2, 3}, 1}, kStart);
  live_.Hear({"SOMETHING_ELSE", {1, 2, 3}, 1}, kStart);
  EXPECT_EQ(State()["undecodable"], 1);
  Hear(channel::kScene, bus_.scene);
  Hear("PLAN_REQUEST_ARA", bus_.request);
  EXPECT_EQ((*live_.View())["message"],
            "the session does not name its robot's folder: give it with --robot DIR");
  bus_.session.settings["robot"] = "/none";
  Hear(channel::kSession, bus_.session);
  EXPECT_NE(std::string((*live_.View())["message"]).find("/none"), std::string::npos);
}

TEST_F(LiveSessionTest, TheSceneServersRobotIsShownWhereNobodyElseNamesOne) {
  Hear(channel::kScene, bus_.scene);
  Hear("PLAN_REQUEST_ARA", bus_.request);
  NodeStatusMessage server;
  server.kind = NodeKind::kSceneServer;
  server.name = "scene_server";
  server.instance = std::string(16, 'a');
  server.settings["robot"] = bus_.session.settings.at("robot");
  Hear(channel::kNodeStatus, server);
  EXPECT_FALSE(live_.View()->contains("message")) << *live_.View();
  // Of another robot, which has come in its place: the one before is neither kept nor asked for.
  const std::int64_t before = live_.view_number();
  server.name = "another_server";
  server.robot_id = "another";
  server.settings["robot"] = "/no/such/robot";
  Hear(channel::kNodeStatus, server);
  EXPECT_GT(live_.view_number(), before);
  EXPECT_THAT(std::string((*live_.View())["message"]), testing::HasSubstr("/no/such/robot"));
}

TEST_F(LiveSessionTest, AGivenRobotHasTheSpheresOfEachSession) {
  const TemporaryFolder folder;
  LiveSession live(bus_.session.settings.at("robot"));
  const auto spheres_of = [&](const std::string& run_id, const std::string& spheres) {
    bus_.session.run_id = run_id;
    bus_.session.settings["spheres"] = spheres;
    live.Hear(PlanarSession::Received(channel::kSession, bus_.session), kStart);
    std::size_t count = 0;
    const Json view = *live.View();
    for (const Json& link : view.at("links")) count += link.at("spheres").size();
    return count;
  };
  live.Hear(PlanarSession::Received(channel::kScene, bus_.scene), kStart);
  live.Hear(PlanarSession::Received("PLAN_REQUEST_ARA", bus_.request), kStart);
  const std::size_t own = spheres_of("first", "");
  const std::string one = "links: {hand: [{center: [0.05, 0, 0], radius: 0.06}]}";
  EXPECT_EQ(spheres_of("second", folder.Write("spheres.yaml", one).string()), 1u);
  EXPECT_EQ(spheres_of("third", "/not/here.yaml"), own);
}

TEST_F(LiveSessionTest, SaysIfTheRobotsMeshesAreNotThoseOfTheSession) {
  const TemporaryFolder folder;
  folder.Write("arm/hand.obj", ObjText(BoxMesh({0.2, 0.1, 0.1})));
  const std::filesystem::path arm = WriteMeshArm(folder, "hand.obj");
  bus_.session.settings["robot"] = arm.string();
  bus_.request.collision_model = CollisionModel::kMeshes;
  Hear(channel::kScene, bus_.scene);
  Hear("PLAN_REQUEST_ARA", bus_.request);
  const auto facts_of = [&](const std::string& run_id, const std::string& mesh_robot_id) {
    bus_.session.run_id = run_id;
    bus_.session.conditions.mesh_robot_id = mesh_robot_id;
    Hear(channel::kSession, bus_.session);
    return live_.View()->at("facts");
  };
  EXPECT_EQ(facts_of("first", MeshRobotId(LoadRobot(arm))).size(), 1u);
  const Json facts = facts_of("second", std::string(32, 'a'));
  ASSERT_EQ(facts.size(), 2u);
  EXPECT_THAT(facts[1].get<std::string>(),
              testing::HasSubstr("meshes are not those of the session"));
}

}  // namespace
}  // namespace planbench
