// Pages of what was checked by a robot's meshes, made by the programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/exit_codes.h"
#include "common/read_text.h"
#include "geometry/mesh_loader.h"
#include "geometry/polyhedra.h"
#include "logger/results_database.h"
#include "messaging/event_log.h"
#include "robot_model/mesh_robot_id.h"
#include "tests/report/browser.h"
#include "tests/support/child_process.h"
#include "tests/support/mesh_arm.h"
#include "tests/support/obj_text.h"
#include "tests/support/planar_session.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The planar arm, whose hand is a mesh of a package that is nowhere near it.
class MeshesShownTest : public testing::Test {
 protected:
  MeshesShownTest() {
    arm_ = WriteMeshArm(folder_, "package://hands/hand.obj").string();
    const auto file = folder_.Write("elsewhere/hand.obj", ObjText(BoxMesh({0.25, 0.1, 0.1})));
    mesh_id_ = SharedMesh(LoadMesh(file)).id();
    hands_ = "hands=" + file.parent_path().string();
  }

  /// Two attempts, by meshes; `packages`: the driver's flag.
  std::string Record(const std::string& name, const std::string& packages) const {
    PlanarSession made;
    made.session.settings["robot"] = arm_;
    made.session.settings["package-path"] = packages;
    made.session.conditions.mesh_robot_id = mesh_robot_id_;
    made.record.request.collision_model = CollisionModel::kMeshes;
    std::filesystem::create_directories(folder_ / name);
    EventLog log(folder_ / name / "session.lcmlog", EventLog::Mode::kNew);
    ResultsDatabase database(folder_ / name / "results.sqlite");
    log.Write(PlanarSession::Received(channel::kSession, made.session));
    log.Write(PlanarSession::Received(channel::kScene, made.scene));
    database.Store(made.session);
    for (const int trial : {1, 2}) {
      made.record.trial = trial;
      made.record.request_id = fmt::format("session/shelf/1/ara/forward/{}", trial);
      log.Write(PlanarSession::Received(channel::kRunRecord, made.record));
      database.Store(made.record);
    }
    return (folder_ / name).string();
  }

  /// The page that a program makes.
  std::string Page(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), std::string(PLANBENCH_BIN_DIR) + "/" + program);
    arguments.insert(arguments.end(), {"--out", page_.string()});
    ChildProcess process(arguments, folder_ / program);
    EXPECT_EQ(process.Wait(), kExitOk) << process.Errors();
    return ReadText(page_);
  }

  static std::size_t Count(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  }

  std::string NamesMesh() const { return "{\"type\":\"mesh\",\"mesh\":\"" + mesh_id_ + "\"}"; }

  const TemporaryFolder folder_;
  const std::filesystem::path page_ = folder_ / "page.html";
  std::string arm_, mesh_id_, hands_;
  std::string mesh_robot_id_;  // Of the session; "": it does not tell.
  const std::string fallback_ =
      "The collision model is 'meshes'; shown: the robot's spheres, because ";
};

TEST_F(MeshesShownTest, OfARunTheyAreFoundWhereTheDriverOrTheViewIsTold) {
  const std::string told = Record("told", hands_);
  const std::string lost = Record("lost", "hands=/no/such/folder");
  const auto of_run = [&](const std::string& session, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"--session", session, "--run", "1"});
    return Page("view", more);
  };
  EXPECT_THAT(of_run(told), HasSubstr(NamesMesh()));
  const std::string without = of_run(lost);
  EXPECT_THAT(without, HasSubstr(fallback_));
  EXPECT_THAT(without, Not(HasSubstr(NamesMesh())));
  const std::string with = of_run(lost, {"--package-path", hands_});
  EXPECT_THAT(with, HasSubstr(NamesMesh()));
  EXPECT_THAT(with, Not(HasSubstr(fallback_)));
  const std::string log = lost + "/session.lcmlog";
  EXPECT_THAT(Page("view", {"--log", log}), HasSubstr(fallback_));
  EXPECT_THAT(Page("view", {"--log", log, "--package-path", hands_}), HasSubstr(NamesMesh()));
}

TEST_F(MeshesShownTest, ThoseThatAreNotTheSessionsAreToldAsSuch) {
  mesh_robot_id_ = MeshRobotId(LoadRobot(arm_, {{"hands", folder_ / "elsewhere"}}));
  const std::string session = Record("session", hands_);
  const std::string others = "The robot's meshes are not those of the session";
  EXPECT_THAT(Page("view", {"--session", session, "--run", "1"}), Not(HasSubstr(others)));
  folder_.Write("elsewhere/hand.obj", ObjText(BoxMesh({0.2, 0.1, 0.1})));
  EXPECT_THAT(Page("view", {"--session", session, "--run", "1"}), HasSubstr(others));
  EXPECT_THAT(Page("view", {"--log", session + "/session.lcmlog"}), HasSubstr(others));
}

TEST_F(MeshesShownTest, OfAProblemTheCollisionModelIsChosen) {
  folder_.Write("set/scene0001.yaml", "world: {}\n");
  folder_.Write("set/request0001.yaml", kPlanarRequest);
  std::vector<std::string> view = {
      "--problems", (folder_ / "set/1").string(), "--robot", arm_, "--package-path", hands_};
  EXPECT_THAT(Page("view", view), Not(HasSubstr(NamesMesh())));
  view.insert(view.end(), {"--collision-model", "meshes"});
  EXPECT_THAT(Page("view", view), HasSubstr(NamesMesh()));
}

TEST_F(MeshesShownTest, AReportHoldsThemOnceAndDrawsThemInEveryView) {
  const std::string session = Record("session", "");
  EXPECT_THAT(Page("report", {session}), HasSubstr(fallback_));
  const std::string page = Page("report", {session, "--package-path", hands_});
  EXPECT_EQ(Count(page, NamesMesh()), 2u);
  EXPECT_EQ(Count(page, "\"" + mesh_id_ + "\":null"), 2u);
  EXPECT_EQ(Count(page, "id=\"mesh-" + mesh_id_ + "\""), 1u);
  if (!FindBrowser()) GTEST_SKIP() << "no Chromium here: apt-get install chromium";
  const nlohmann::json found = Browse(page_, std::string(kPixels) + R"script(
    const buttons = [...document.querySelectorAll("#problem button")].filter(one => one.textContent === "Show in 3D");
    found.drawn = buttons.map(button => {
      button.click();
      return new Set(pixels(document.querySelector("canvas.view"))).size > 10;
    });
  )script");
  EXPECT_EQ(found["drawn"], (nlohmann::json{true, true}));
}

}  // namespace
}  // namespace planbench
