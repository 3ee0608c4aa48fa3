#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "benchmark_driver/driver.h"
#include "benchmark_driver/launcher.h"
#include "benchmark_driver/resume.h"
#include "messaging/channels.h"
#include "messaging/node_announcer.h"
#include "tests/pipeline/pipeline_fixture.h"
#include "tests/support/wait_until.h"

namespace planbench {
namespace {

/// Planbench's own processes, a driver in this one, and a supervisor with less patience than a
/// session's.
class StoppedProcessesTest : public PipelineTest {
 protected:
  StoppedProcessesTest() {
    bus_.Start();
    watching_.Start();
    self_.emplace(&bus_, [status = MakeNodeStatus("driver", NodeKind::kDriver)] { return status; });
  }

  std::filesystem::path Session() const { return folder() / "session"; }

  /// So many that some are left when a process is stopped at the first record.
  static constexpr int kManyTrials = 20;

  /// Problems 1 to 3, forward.
  static DriverOptions Options(int trials = 1) {
    DriverOptions options;
    options.problem_indices = {1, 2, 3};
    options.directions = Directions::kForward;
    options.trials = trials;
    options.discovery_timeout_s = 60;
    options.conditions.request.run_id = NewRunId();
    options.conditions.request.time_limit_s = 5;
    options.skip_bad_problems = true;
    return options;
  }
  static std::vector<LineUpEntry> LineUp(const std::vector<std::string>& planners) {
    LineUpFlags flags;
    flags.planners = planners;
    return MakeLineUp(flags, std::nullopt);
  }
  std::unique_ptr<Driver> MakeDriver(const DriverOptions& options, EarlierSession earlier = {}) {
    return std::make_unique<Driver>(&bus_, options, LineUp(planners_),
                                    std::map<std::string, std::string>(), std::move(earlier));
  }

  void Launch(const std::string& name, const std::vector<std::string>& flags,
              std::map<std::string, std::string> environment = {}) {
    ChildSpec child;
    child.name = name;
    child.arguments = {Program(name == "rrtc" ? "planner_rrtc" : name)};
    child.arguments.insert(child.arguments.end(), flags.begin(), flags.end());
    child.environment = std::move(environment);
    child.environment["LCM_DEFAULT_URL"] = url();
    child.environment["PLANBENCH_TEST"] = folder().string();
    child.log = folder() / (name + ".log");
    if (name == "logger") child.when_again = {"--resume"};
    supervisor_.Start(std::move(child));
  }
  /// All that a session needs; the scene server with `failing` in its environment.
  void LaunchAll(const std::map<std::string, std::string>& failing = {}) {
    Launch("logger", {"--out", Session().string()});
    Launch("scene_server", {"--robot", RobotFolder(), "--problems", ProblemFolder()}, failing);
    Launch("rrtc", {"--robot", RobotFolder()});
  }
  /// The scene server is to fail at what holds that text.
  std::map<std::string, std::string> FailingAt(const std::string& text) const {
    std::ofstream(folder() / "fails_at") << text;
    return {{"LD_PRELOAD", PLANBENCH_FAILING_SERVER},
            {"PLANBENCH_FAILS_AT", (folder() / "fails_at").string()}};
  }

  void AwaitLive(std::size_t number) {
    ASSERT_TRUE(
        registry_.WaitUntil([&] { return registry_.Live().size() >= number; }, kTestPatience));
  }
  /// Stops processes when the first run of the planner rrtc is recorded.
  Subscription StopAtFirstRecord(const std::vector<std::pair<std::string, NodeKind>>& processes) {
    return watching_.Subscribe<RunRecordMessage>(
        channel::kRunRecord, [this, processes](const RunRecordMessage& record) {
          if (record.planner != "rrtc" || !stopped_.empty()) return;
          for (const auto& [name, kind] : processes) {
            const auto process = registry_.Find(name, kind);
            if (!process) continue;
            stopped_.push_back(static_cast<pid_t>(process->pid));
            kill(stopped_.back(), SIGSTOP);
          }
        });
  }
  /// By index and trial: whether the runs were asked for.
  static std::map<std::pair<int, int>, bool> Asked(const Driver& driver) {
    std::map<std::pair<int, int>, bool> asked;
    for (const RunRow& run : driver.runs().rows()) {
      asked[{run.problem_index, run.trial}] = run.asked;
    }
    return asked;
  }
  long long NumFinished() const {
    return Query(Session(), "SELECT count(*) FROM sessions WHERE finished");
  }
  static void Watch() {}
  static bool Never() { return false; }

  Bus bus_{url()}, watching_{url()};
  NodeRegistry registry_{&watching_};
  std::vector<pid_t> stopped_;
  std::vector<std::string> planners_ = {"rrtc"};
  std::optional<NodeAnnouncer> self_;  // the logger takes records from a live driver
  Supervisor supervisor_{std::chrono::seconds(6)};
  const Subscription children_ = WatchChildren(&watching_, LineUp(planners_), &supervisor_);
};

TEST_F(StoppedProcessesTest, WhatIsStoppedBetweenRunsIsStartedAgain) {
  LaunchAll();
  const auto driver = MakeDriver(Options(kManyTrials));
  driver->Discover(true, Watch, SceneServerOf(&supervisor_));
  const Subscription stops =
      StopAtFirstRecord({{"rrtc", NodeKind::kPlanner}, {"logger", NodeKind::kLogger}});
  EXPECT_TRUE(driver->Run(Never, Watch));
  EXPECT_EQ(supervisor_.NumFailuresAtWork("rrtc"), 1);
  EXPECT_TRUE(driver->given_up().empty());
  EXPECT_EQ(driver->num_not_asked(), 0);
  supervisor_.StopAll({});
  EXPECT_EQ(Query(Session(), "SELECT count(DISTINCT request_id) FROM runs"), 3 * kManyTrials);
  EXPECT_EQ(NumFinished(), 1);
}

TEST_F(StoppedProcessesTest, APlannerStartedByHandThatIsStoppedIsGivenUpAndTheOthersGoOn) {
  planners_ = {"rrtc", "other"};
  StartLogger(Session());
  StartSceneServer();
  StartPlanner("rrtc");
  StartPlanner("rrtc", {"--name", "other"});
  AwaitLive(5);  // the driver included
  DriverOptions options = Options(kManyTrials);
  options.discovery_timeout_s = 3;
  ServerPatience patience;
  patience.until_given_up = std::chrono::seconds(3);
  const auto driver = MakeDriver(options);
  driver->Discover(true, Watch, {}, patience);
  {
    const Subscription stops = StopAtFirstRecord({{"rrtc", NodeKind::kPlanner}});
    EXPECT_TRUE(driver->Run(Never, Watch));
  }
  ASSERT_EQ(driver->given_up().size(), 1u);
  EXPECT_EQ(driver->given_up().begin()->first, "rrtc");
  EXPECT_THAT(driver->given_up().begin()->second, testing::HasSubstr("it was not on the bus for"));
  EXPECT_EQ(driver->runs().size(), 2u * 3 * kManyTrials);
  const int num_not_asked = driver->num_not_asked();
  EXPECT_GE(num_not_asked, 1);
  for (const RunRow& run : driver->runs().rows()) {
    if (*run.planner == "other") {
      EXPECT_TRUE(run.confirmed()) << *run.message;
    }
  }
  EXPECT_EQ(NumFinished(), 0);

  for (const pid_t pid : stopped_) kill(pid, SIGCONT);
  ASSERT_TRUE(registry_.WaitUntil(
      [&] { return registry_.Find("rrtc", NodeKind::kPlanner).has_value(); }, kTestPatience));
  const auto resumed = MakeDriver(options, ReadEarlierSession(Session()));
  resumed->Discover(true, Watch, {}, patience);
  EXPECT_TRUE(resumed->Run(Never, Watch));
  EXPECT_EQ(resumed->runs().size(), 2u * 3 * kManyTrials);
  EXPECT_EQ(resumed->num_not_asked(), 0);
  EXPECT_EQ(NumFinished(), 1);
}

/// With a scene server that fails.
class FailingServerTest : public StoppedProcessesTest {
 protected:
  void SetUp() override {
    if (!std::string(PLANBENCH_SANITIZED).empty()) {
      GTEST_SKIP() << "sanitizers want to be the first library, where another has to be";
    }
  }
};

TEST_F(FailingServerTest, AProblemAtWhichItFallsSilentEachTimeIsLeftOut) {
  LaunchAll(FailingAt("shelf_demo/2@"));
  const auto driver = MakeDriver(Options());
  driver->Discover(true, Watch, SceneServerOf(&supervisor_));
  EXPECT_EQ(driver->left_out(),
            (std::map<std::string, std::string>{
                {"shelf_demo 2",
                 "twice the scene server died or fell silent when it was asked for the problem "
                 "shelf_demo 2"}}));
  EXPECT_TRUE(driver->Run(Never, Watch));
  EXPECT_EQ(Asked(*driver), (std::map<std::pair<int, int>, bool>{{{1, 1}, true}, {{3, 1}, true}}));
  EXPECT_EQ(NumFinished(), 1);
}

TEST_F(FailingServerTest, AProblemThatItDoesNotAnswerThoughLiveIsLeftOut) {
  std::map<std::string, std::string> failing = FailingAt("shelf_demo/2@");
  failing["PLANBENCH_FAILS_BY"] = "silence";
  LaunchAll(failing);
  AwaitLive(4);
  DriverOptions options = Options();
  options.discovery_timeout_s = 3;
  ServerPatience patience;
  patience.until_told = std::chrono::seconds(1);
  patience.until_passed_over = std::chrono::seconds(6);
  const auto driver = MakeDriver(options);
  driver->Discover(true, Watch, SceneServerOf(&supervisor_), patience);
  ASSERT_EQ(driver->left_out().size(), 1u);
  EXPECT_EQ(driver->left_out().at("shelf_demo 2"),
            "the scene server did not answer within 6 s when it was asked for the problem "
            "shelf_demo 2");
  EXPECT_TRUE(driver->Run(Never, Watch));
  EXPECT_EQ(NumFinished(), 1);
}

TEST_F(FailingServerTest, ARunAtWhoseVerdictItFallsSilentEachTimeIsMadeWhenTheSessionIsResumed) {
  LaunchAll(FailingAt("shelf_demo/2/rrtc"));
  const DriverOptions options = Options(2);
  const auto driver = MakeDriver(options);
  driver->Discover(true, Watch, SceneServerOf(&supervisor_));
  EXPECT_TRUE(driver->Run(Never, Watch));
  using Runs = std::map<std::pair<int, int>, bool>;
  EXPECT_EQ(Asked(*driver), (Runs{{{1, 1}, true},
                                  {{1, 2}, true},
                                  {{2, 1}, false},
                                  {{2, 2}, false},
                                  {{3, 1}, true},
                                  {{3, 2}, true}}));
  EXPECT_EQ(driver->num_not_asked(), 2);
  EXPECT_EQ(NumFinished(), 0);
  const std::vector<std::string> reasons =
      Rows(Session(), "SELECT message FROM runs WHERE problem_index = 2 ORDER BY id", 1);
  ASSERT_EQ(reasons.size(), 2u);
  const std::string why = "twice the scene server died or fell silent when it was asked for the";
  EXPECT_THAT(reasons[0], testing::StartsWith("no verdict on its path: " + why));
  EXPECT_THAT(reasons[1], testing::StartsWith("no problem: " + why));

  std::filesystem::remove(folder() / "fails_at");
  const auto resumed = MakeDriver(options, ReadEarlierSession(Session()));
  resumed->Discover(true, Watch, SceneServerOf(&supervisor_));
  EXPECT_TRUE(resumed->Run(Never, Watch));
  EXPECT_EQ(resumed->runs().size(), 6u);
  for (const RunRow& run : resumed->runs().rows()) EXPECT_TRUE(run.confirmed()) << *run.message;
  EXPECT_EQ(NumFinished(), 1);
}

}  // namespace
}  // namespace planbench
