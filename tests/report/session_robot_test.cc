#include "report/session_robot.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "tests/support/expect_input_error.h"
#include "tests/support/planar_session.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

class SessionRobotTest : public testing::Test {
 protected:
  SessionRobotTest() {
    std::filesystem::copy(planar_, folder_ / "own");
    const std::string spheres = "links: {hand: [{center: [0.05, 0, 0], radius: 0.06}]}\n";
    session_.settings["spheres"] = folder_.Write("spheres.yaml", spheres).string();
    folder_.Write("own/spheres.yaml", spheres);
  }
  std::string& RobotIdOfSession() { return session_.conditions.request.robot_id; }

  TemporaryFolder folder_;
  SessionMessage session_ = PlanarSession().session;
  const std::filesystem::path planar_ = session_.settings.at("robot");
};

TEST_F(SessionRobotTest, HasTheSessionsSpheres) {
  const std::string id = LoadSessionRobot(session_, "").content_id;
  EXPECT_NE(id, LoadRobot(planar_).content_id);
  EXPECT_EQ(LoadSessionRobot(session_, planar_).content_id, id);
}

TEST_F(SessionRobotTest, SpheresThatAreNotHereAreThoseOfTheFolderGiven) {
  RobotIdOfSession() = LoadSessionRobot(session_, "").content_id;
  session_.settings["spheres"] = "/no/spheres.yaml";
  EXPECT_THROW(LoadSessionRobot(session_, ""), UnknownRobot);
  ExpectInputError([&] { LoadSessionRobot(session_, ""); }, {"/no/spheres.yaml", "--robot DIR"});
  EXPECT_EQ(LoadSessionRobot(session_, folder_ / "own").content_id, RobotIdOfSession());
  ExpectInputError([&] { LoadSessionRobot(session_, planar_); },
                   {planar_.string() + " is not the session's robot", "/no/spheres.yaml"});
  RobotIdOfSession() = "";
  EXPECT_EQ(LoadSessionRobot(session_, planar_).name, "planar3");
}

TEST_F(SessionRobotTest, KnowsThePackagesThatTheDriverWasToldOf) {
  session_.settings["package-path"] = "arm=/a\\,b,hand=/c,arm=/d";
  EXPECT_EQ(LoadSessionRobot(session_, "").resources.packages,
            (std::map<std::string, std::filesystem::path>{{"arm", "/a,b"}, {"hand", "/c"}}));
  // What is given counts before that.
  for (const auto& folder : {std::filesystem::path(), planar_}) {
    EXPECT_EQ(LoadSessionRobot(session_, folder, {{"hand", "/e"}}).resources.packages,
              (std::map<std::string, std::filesystem::path>{{"arm", "/a,b"}, {"hand", "/e"}}));
  }
}

TEST_F(SessionRobotTest, IsOfTheSceneServerOfItsRobot) {
  session_.settings.clear();
  RobotIdOfSession() = "this";
  NodeStatusMessage server;
  server.kind = NodeKind::kSceneServer;
  const auto add = [&](const std::string& id, const std::filesystem::path& folder) {
    server.robot_id = id;
    server.settings["robot"] = folder.string();
    session_.nodes.push_back(server);
  };
  add("other", folder_ / "own");
  add("this", planar_);
  EXPECT_EQ(LoadSessionRobot(session_, "").folder, planar_);
  session_.nodes.pop_back();
  EXPECT_THROW(LoadSessionRobot(session_, ""), UnknownRobot);
}

TEST_F(SessionRobotTest, SpheresAreThoseOfItsSceneServerWhereNoFlagNamesSome) {
  const std::string id = LoadSessionRobot(session_, "").content_id;
  NodeStatusMessage server;
  server.kind = NodeKind::kSceneServer;
  server.settings["robot"] = planar_.string();
  server.settings["spheres"] = session_.settings.at("spheres");
  session_.settings.clear();
  session_.nodes = {server};
  EXPECT_EQ(LoadSessionRobot(session_, "").content_id, id);
  EXPECT_EQ(LoadSessionRobot(session_, planar_).content_id, id);
  RobotIdOfSession() = "another";
  session_.nodes.front().robot_id = id;
  EXPECT_NE(LoadSessionRobot(session_, planar_).content_id, id);
}

}  // namespace
}  // namespace planbench
