#include <gtest/gtest.h>

#include <fstream>

#include "geometry/polyhedra.h"
#include "tests/pipeline/pipeline_fixture.h"
#include "tests/support/mesh_arm.h"
#include "tests/support/obj_text.h"

namespace planbench {
namespace {

class BadUse : public PipelineTest {};

TEST_F(BadUse, UnknownPlanner) {
  ExpectBadInput(StartLaunchedDriver(folder() / "s", {"--planners", "ara,prm"}),
                 "unknown planner 'prm'; known are: ara, rrtc");
  StartSceneServer();
  StartPlanner("rrtc");
  ExpectBadInput(
      Start({Program("benchmark_driver"), "--planners", "rrtc,prm", "--discovery-timeout", "3"}),
      "a planner named 'prm'");
}

TEST_F(BadUse, MissingProblemFolder) {
  ExpectBadInput(
      Start({Program("scene_server"), "--robot", RobotFolder(), "--problems", "/nowhere"}),
      "/nowhere");
  ExpectBadInput(Start({Program("benchmark_driver"), "--launch", "--robot", RobotFolder(),
                        "--problems", "/nowhere", "--out", (folder() / "s").string()}),
                 "/nowhere");
  EXPECT_TRUE(LeftRunning().empty());
}

TEST_F(BadUse, MeshesModelWithoutTheMeshFiles) {
  ExpectBadInput(StartLaunchedDriver(folder() / "s", {"--collision-model", "meshes"}),
                 "--collision-model meshes (of 'ara'): ");
  ExpectBadInput(StartLaunchedDriver(folder() / "s", {"--collision-model", "meshes"}),
                 "--package-path fetch_description=DIR");
  EXPECT_TRUE(LeftRunning().empty());
}

TEST_F(BadUse, ASizeOfAnotherUnitIsToldOnceAndBeforeWhatIsRefusedThen) {
  const TemporaryFolder robots;
  robots.Write("box.obj", ObjText(BoxMesh({20, 20, 200})));  // mm
  const std::string arm = WriteMeshArm(robots, "../box.obj").string();
  robots.Write("none/readme", "no robot");
  for (const auto& [referee, refused] :
       {std::pair{(robots / "none").string(), "expected a robot.yaml or exactly one .urdf"},
        std::pair{arm, "/nowhere"}}) {
    ChildProcess* driver =
        Start({Program("benchmark_driver"), "--launch", "--robot", arm, "--problems", "/nowhere",
               "--out", (folder() / "s").string(), "--planners", "rrtc", "--collision-model",
               "meshes", "--referee-robot", referee});
    EXPECT_EQ(driver->Wait(), 2);
    const std::string errors = driver->Errors();
    const std::size_t told = errors.find("is 200 m large");
    const std::size_t end = errors.find(refused);
    ASSERT_NE(end, std::string::npos) << errors;
    EXPECT_LT(told, end) << errors;
    EXPECT_EQ(told, errors.rfind("is 200 m large")) << errors;
  }
}

TEST_F(BadUse, EnclosingModelWithoutItsSpheres) {
  const auto arm = folder() / "arm";
  std::filesystem::create_directory(arm);
  std::filesystem::copy(RobotFolder() + "/fetch.urdf", arm / "fetch.urdf");
  std::filesystem::copy(RobotFolder() + "/spheres.yaml", arm / "spheres.yaml");
  std::ofstream(arm / "robot.yaml") << R"(name: arm
urdf: fetch.urdf
spheres: spheres.yaml
links_without_spheres: [r_wheel_link, l_wheel_link, laser_link, estop_link, bellows_link, bellows_link2, head_pan_link,
                        head_tilt_link]
groups: [{name: arm, joints: [elbow_flex_joint], tip_link: gripper_link}]
)";
  ExpectBadInput(Start({Program("benchmark_driver"), "--launch", "--robot", arm.string(),
                        "--problems", ProblemFolder(), "--out", (folder() / "s").string(),
                        "--collision-model", "enclosing"}),
                 "--collision-model enclosing (of 'ara'): robot 'arm' has no enclosing_spheres");
  ExpectBadInput(StartLaunchedDriver(folder() / "s", {"--spheres", "/nowhere.yaml"}),
                 "/nowhere.yaml");
  EXPECT_TRUE(LeftRunning().empty());
}

TEST_F(BadUse, MissingOrBrokenRobot) {
  ExpectBadInput(Start({Program("planner_ara"), "--robot", "/nowhere"}), "/nowhere");
  ExpectBadInput(StartPlanner("rrtc", {"--set", "rang=1"}), "--set rang");
  ExpectBadInput(StartPlanner("rrtc", {"--algorithm", "RRTConect"}),
                 "--set algorithm: unknown algorithm");
  ExpectBadInput(StartPlanner("ara", {"--config", "/nowhere.yaml"}), "/nowhere.yaml");
  ExpectBadInput(StartPlanner("ara", {"--collision-models", "spheres,balls"}), "balls");
}

TEST_F(BadUse, SettingsOfALineUp) {
  const std::string line_up = folder() / "lineup.yaml";
  std::ofstream(folder() / "near.yaml") << "\nrange: far";
  std::ofstream(line_up) << "contestants:\n  ara: {}\n"
                            "  third: {program: rrtc, set: {range: zwei}}\n"
                            "  fourth: {program: rrtc, config: near.yaml}\n";
  const auto start = [&](const std::string& planner, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--lineup", line_up, "--planners", planner});
    return StartLaunchedDriver(folder() / "s", more);
  };
  ExpectBadInput(start("third"), line_up + ":3: contestants.third.set.range: expected a number");
  ExpectBadInput(start("third", {"--set", "third.range=two"}), "--set third.range: expected a");
  ExpectBadInput(start("fourth"), "fourth: planner_rrtc: " + (folder() / "near.yaml:2").string());
}

TEST_F(BadUse, PlannerWithAnotherRobot) {
  const auto other = folder() / "other_fetch";
  std::filesystem::copy(RobotFolder(), other);
  {
    std::ofstream spheres(other / "spheres.yaml", std::ios::app);
    spheres << "\n# not the same description\n";
  }
  StartSceneServer();
  Start({Program("planner_rrtc"), "--robot", other.string()});
  ChildProcess* driver = StartDriver({"--planners", "rrtc"});
  EXPECT_EQ(driver->Wait(), 2);
  EXPECT_NE(driver->Errors().find("'rrtc' has another robot than the scene server"),
            std::string::npos)
      << driver->Errors();
}

TEST_F(BadUse, ProblemsForAnotherRobot) {
  const auto problems = folder() / "problems";
  std::filesystem::create_directory(problems);
  std::filesystem::copy(ProblemFolder() + "/scene0001.yaml", problems / "scene0001.yaml");
  std::ifstream original(ProblemFolder() + "/request0001.yaml");
  std::string text{std::istreambuf_iterator<char>(original), {}};
  for (std::size_t at = 0; (at = text.find("elbow_flex_joint", at)) != std::string::npos;) {
    text.replace(at, 16, "other_elbow_joint");
  }
  std::ofstream(problems / "request0001.yaml") << text;
  ChildProcess* driver =
      Start({Program("benchmark_driver"), "--launch", "--robot", RobotFolder(), "--problems",
             problems.string(), "--planners", "rrtc", "--out", (folder() / "session").string()});
  EXPECT_EQ(driver->Wait(), 2) << driver->Errors();
  EXPECT_NE(driver->Errors().find("request0001.yaml:12: start_state.joint_state.name[9]: the joint "
                                  "'other_elbow_joint' is unknown"),
            std::string::npos)
      << driver->Errors();
}

TEST_F(BadUse, SecondLoggerOnTheSameFolder) {
  const auto session = folder() / "session";
  ChildProcess* first = StartLogger(session);
  ASSERT_TRUE(WaitUntil([&] { return Query(session, "SELECT count(*) FROM runs") == 0; }));
  ExpectBadInput(Start({Program("logger"), "--out", session.string(), "--name", "logger2"}),
                 session.string());
  ExpectEndsCleanly(first);
}

TEST_F(BadUse, PortInUseByAnotherSession) {
  ChildProcess* first = StartSceneServer();
  ASSERT_TRUE(WaitUntil(
      [&] { return first->Errors().find("serving") != std::string::npos || !first->Running(); }));
  // A second server must find the first one on its own, whenever that is announced.
  ChildProcess* second = StartSceneServer();
  EXPECT_EQ(second->Wait(), 2);
  EXPECT_NE(second->Errors().find("is live already"), std::string::npos) << second->Errors();
  ExpectBadInput(StartLaunchedDriver(folder() / "s", {"--lcm-url", url()}),
                 "another session is on");
  ExpectEndsCleanly(first);
}

TEST_F(BadUse, NoMulticastRoute) {
  if (std::system("unshare -n true 2>/dev/null") != 0) {
    GTEST_SKIP() << "needs the right to make a network namespace";
  }
  for (const char* program : {"planner_rrtc", "planner_ara"}) {
    ExpectBadInput(Start({"unshare", "-n", Program(program), "--robot", RobotFolder()}),
                   "multicast route");
  }
  ExpectBadInput(Start({"unshare", "-n", Program("scene_server"), "--robot", RobotFolder(),
                        "--problems", ProblemFolder()}),
                 "multicast route");
  ExpectBadInput(Start({"unshare", "-n", Program("benchmark_driver")}), "multicast route");
  ExpectBadInput(Start({"unshare", "-n", Program("logger"), "--out", (folder() / "s").string()}),
                 "multicast route");
}

TEST_F(BadUse, BadFlags) {
  ExpectBadInput(StartDriver({"--time", "-1"}), "--time");
  ExpectBadInput(StartDriver({"--directions", "sideways"}), "--directions");
  ExpectBadInput(StartDriver({"--problems-range", "5-1"}), "--problems-range");
  ExpectBadInput(StartDriver({"--no-such-flag"}), "--no-such-flag");
  ExpectBadInput(StartLaunchedDriver(folder() / "s", {"--collision-model", "clay"}), "clay");
  ExpectBadInput(StartLaunchedDriver(folder() / "s2", {"--sets", "no_set"}), "shelf_demo");
}

TEST_F(BadUse, HelpAndVersion) {
  for (const char* program :
       {"scene_server", "planner_ara", "planner_rrtc", "benchmark_driver", "logger"}) {
    ChildProcess* help = Start({Program(program), "--help"});
    EXPECT_EQ(help->Wait(), 0);
    EXPECT_NE(help->Output().find("--lcm-url"), std::string::npos) << help->Output();
    EXPECT_EQ(help->Output().find("with --launch a port that is free") != std::string::npos,
              std::string(program) == "benchmark_driver")
        << help->Output();
    ChildProcess* version = Start({Program(program), "--version"});
    EXPECT_EQ(version->Wait(), 0);
    EXPECT_NE(version->Output().find(program), std::string::npos) << version->Output();
  }
}

}  // namespace
}  // namespace planbench
