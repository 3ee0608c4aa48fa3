#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include "scene/moveit_yaml.h"
#include "tests/support/child_process.h"
#include "tests/support/planning_problems.h"
#include "tests/support/private_bus.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait_until.h"

// The planners of examples/, started by the driver.
namespace planbench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

bool Succeeds(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}

/// "FILE: LINK" of the relative links in documents below `folder` that lead nowhere.
std::vector<std::string> DeadLinks(const fs::path& folder) {
  static const std::regex kLink(R"(\]\(([^)\s#:]+)(#[^)\s]*)?\))");
  std::vector<std::string> dead;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".md") continue;
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (std::sregex_iterator it(text.begin(), text.end(), kLink), end; it != end; ++it) {
      const std::string link = (*it)[1];
      if (!fs::exists(entry.path().parent_path() / link)) {
        dead.push_back(entry.path().string() + ": " + link);
      }
    }
  }
  return dead;
}

class ExamplesTest : public testing::Test {
 protected:
  // Two problems: the straight line is free, and in collision. The files list the joints of goals
  // in an order of their own, and the first problem has two alternatives.
  ExamplesTest() {
    const Robot fetch = LoadFetch();
    Configuration near = FetchOverTable();
    near[7] += 0.5;
    for (const int index : {1, 2}) {
      Problem problem;
      problem.scene = FetchTableScene(fetch);
      const PlanRequest request =
          MakeRequest(fetch, index == 1 ? near : FetchTucked(), FetchOverTable());
      problem.start = request.start;
      problem.goal = {request.goal.rbegin(), request.goal.rend()};
      if (index == 1)
        problem.goal.insert(problem.goal.end(), request.goal.begin(), request.goal.end());
      problem.group = request.group;
      problem.time_limit_s = 5;
      const std::string number = "000" + std::to_string(index) + ".yaml";
      fs::create_directories(set_);
      WriteProblem(problem, set_ / ("scene" + number), set_ / ("request" + number));
    }
  }

  // What the driver says after a session of `planner` with the program that `command` starts.
  std::string Run(const std::string& planner, const std::string& command) {
    ChildProcess driver(
        {PLANBENCH_BIN_DIR "/benchmark_driver", "--launch", "--robot", "fetch", "--problems", set_,
         "--planners", planner, "--planner-command", planner + "=" + command, "--directions",
         "forward", "--out", folder_.path() / "session"},
        folder_.path() / "driver");
    EXPECT_EQ(driver.Wait(), 0) << driver.Errors();
    return driver.Output();
  }

  // Starts the program that `command` starts twice, on a bus with a scene server.
  void ExpectOneOfTwoToLeave(const std::vector<std::string>& command,
                             std::map<std::string, std::string> environment = {}) {
    environment["LCM_DEFAULT_URL"] = PrivateUdpUrl();
    ChildProcess server({PLANBENCH_BIN_DIR "/scene_server", "--robot", "fetch", "--problems", set_},
                        folder_.path() / "scene_server", environment);
    ASSERT_TRUE(WaitUntil([&] { return server.Errors().find("serving") != std::string::npos; }));
    std::vector<std::unique_ptr<ChildProcess>> two;
    for (const char* name : {"one", "other"}) {
      two.push_back(std::make_unique<ChildProcess>(command, folder_.path() / name, environment));
    }
    ASSERT_TRUE(WaitUntil([&] { return !two[0]->Running() || !two[1]->Running(); }));
    const int left = two[0]->Running() ? 1 : 0;
    EXPECT_EQ(two[left]->Wait(), 2);
    EXPECT_THAT(two[left]->Errors(), HasSubstr("is live already"));
    EXPECT_TRUE(two[1 - left]->Running());
  }

  static void ExpectTheFirstSolvedAndTheSecondNot(const std::string& output) {
    EXPECT_THAT(output, testing::ContainsRegex(" 2 +1 +1 +50\\.0 ")) << output;
    EXPECT_THAT(output, HasSubstr("1 EXHAUSTED, problem 2\n"));
    EXPECT_THAT(output, HasSubstr("mostly: the straight line is not free"));
  }

  TemporaryFolder folder_;
  fs::path set_ = folder_.path() / "lines";
  const fs::path examples_ = fs::path(PLANBENCH_SOURCE_DIR) / "examples";
};

TEST_F(ExamplesTest, InCppAgainstTheInstalledPackage) {
  const fs::path prefix = folder_.path() / "prefix";
  const fs::path build = folder_.path() / "build";
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"cmake", "--install", PLANBENCH_BUILD_DIR, "--prefix", prefix},
           {"cmake", "-S", prefix / "share/planbench/examples/cpp", "-B", build,
            "-DCMAKE_PREFIX_PATH=" + prefix.string()},
           {"cmake", "--build", build}}) {
    ChildProcess child(command, folder_.path() / "cmake");
    ASSERT_EQ(child.Wait(), 0) << child.Output() << child.Errors();
  }
  EXPECT_TRUE(fs::exists(prefix / "share/planbench/README.md"));
  EXPECT_THAT(DeadLinks(prefix / "share"), testing::IsEmpty());
  // Robots that ship are found in an installation, too.
  ChildProcess server(
      {prefix / "bin/planbench-scene-server", "--robot", "nobody", "--problems", set_},
      folder_.path() / "server");
  EXPECT_EQ(server.Wait(), 2);
  EXPECT_THAT(server.Errors(), HasSubstr("those are: fetch, panda, ur5e"));
  ExpectTheFirstSolvedAndTheSecondNot(
      Run("straight", (build / "straight_line").string() + " --name straight --robot " +
                          (prefix / "share/planbench/robots/fetch").string()));
}

TEST_F(ExamplesTest, InJava) {
  const fs::path jar = fs::path(PLANBENCH_BUILD_DIR) / "planbench_types.jar";
  if (!Succeeds("javac -version") || !fs::exists(jar)) {
    GTEST_SKIP() << "needs javac and " << jar << " (./spy makes it)";
  }
  const fs::path classes = folder_.path() / "classes";
  const fs::path run = examples_ / "java/run";
  ExpectTheFirstSolvedAndTheSecondNot(
      Run("java-line", "PLANBENCH_TYPES_JAR=" + jar.string() + " PLANBENCH_JAVA_CLASSES=" +
                           classes.string() + " " + run.string() + " java-line"));
  ExpectOneOfTwoToLeave({run, "java-line"},
                        {{"PLANBENCH_TYPES_JAR", jar}, {"PLANBENCH_JAVA_CLASSES", classes}});
}

TEST_F(ExamplesTest, InPython) {
  if (!Succeeds("python3 -c 'import lcm'")) GTEST_SKIP() << "needs LCM's module for Python, lcm";
  const fs::path program = examples_ / "python/straight_line.py";
  const fs::path temporary = folder_.path() / "temporary";
  fs::create_directory(temporary);
  ExpectTheFirstSolvedAndTheSecondNot(
      Run("python", "TMPDIR=" + temporary.string() + " python3 " + program.string() + " python"));
  EXPECT_TRUE(fs::is_empty(temporary)) << "leaves its temporary files";
  ExpectOneOfTwoToLeave({"python3", program, "python"});
}

}  // namespace
}  // namespace planbench
