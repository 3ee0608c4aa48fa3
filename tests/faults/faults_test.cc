#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "messaging/record_log.h"
#include "tests/faults/hostile_sender.h"
#include "tests/faults/misbehaving_planner.h"
#include "tests/pipeline/pipeline_fixture.h"

namespace planbench {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

std::uint64_t FromEnvironment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::stoull(text);
}

struct Child {
  int pid = 0;
  std::string name;
};

std::vector<Child> ChildrenOf(int parent) {
  std::vector<Child> children;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string pid = entry.path().filename();
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream file(entry.path() / "stat");
    const std::string stat{std::istreambuf_iterator<char>(file), {}};
    const std::size_t open = stat.find('('), close = stat.rfind(')');
    if (close == std::string::npos || stat.size() < close + 4) continue;
    if (std::atoi(stat.c_str() + close + 4) != parent) continue;
    children.push_back({std::stoi(pid), stat.substr(open + 1, close - open - 1)});
  }
  std::sort(children.begin(), children.end(),
            [](const Child& a, const Child& b) { return a.name < b.name; });
  return children;
}

/// Chooses what to do to children so that none dies five times, each within five seconds of its
/// start, which is what ends a session.
class Killer {
 public:
  /// Whether the child can be killed now; it then has to be.
  bool Kills(const std::string& name) {
    using std::chrono::steady_clock;
    constexpr std::chrono::seconds kQuick{7};  // since the last kill
    constexpr int kMostQuickDeaths = 3;
    Deaths& deaths = deaths_[name];
    const auto now = steady_clock::now();
    const int quick = now - deaths.last < kQuick ? deaths.quick + 1 : 0;
    if (quick > kMostQuickDeaths) return false;
    deaths = {now, quick};
    return true;
  }

 private:
  struct Deaths {
    std::chrono::steady_clock::time_point last;
    int quick = 0;
  };
  std::map<std::string, Deaths> deaths_;
};

class FaultsTest : public PipelineTest {
 protected:
  std::filesystem::path Session() const { return folder() / "session"; }

  /// A launched session on this test's bus.
  ChildProcess* StartSession(const std::vector<std::string>& flags) {
    std::vector<std::string> all = {"--lcm-url",      url(),          "--directions", "forward",
                                    "--no-clearance", "--no-simplify"};
    all.insert(all.end(), flags.begin(), flags.end());
    if (std::find(flags.begin(), flags.end(), "--time") == flags.end()) {
      all.insert(all.end(), {"--time", "5"});
    }
    return StartLaunchedDriver(Session(), all);
  }
  long long NumRuns() const { return Query(Session(), "SELECT count(*) FROM runs"); }
  /// One record of every run, in the database and in the event log, and a finished session.
  void ExpectOneRecordOfEach(int num_runs) {
    EXPECT_EQ(NumRuns(), num_runs);
    EXPECT_EQ(Query(Session(), "SELECT count(DISTINCT request_id) FROM runs"), num_runs);
    EXPECT_EQ(Query(Session(), "SELECT count(*) FROM sessions WHERE finished"), 1);
    EXPECT_EQ(ReadRecords(Session() / "session.lcmlog").runs.size(),
              static_cast<std::size_t>(num_runs));
  }
  /// Kills a child and waits until there is another of its name and a further run is recorded.
  /// Seconds that took; nothing if the session ended meanwhile.
  std::optional<double> KillAndAwait(ChildProcess* driver, const Child& victim) {
    const auto begin = std::chrono::steady_clock::now();
    const long long num_runs = NumRuns();
    kill(victim.pid, SIGKILL);
    const auto back = [&] {
      const std::optional<int> pid = PidOf(driver, victim.name);
      return pid && *pid != victim.pid && NumRuns() > num_runs;
    };
    EXPECT_TRUE(WaitUntil([&] { return back() || !driver->Running(); })) << victim.name;
    if (!driver->Running()) return std::nullopt;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  std::optional<int> PidOf(ChildProcess* driver, const std::string& name) {
    for (const Child& child : ChildrenOf(driver->pid())) {
      if (child.name == name) return child.pid;
    }
    return std::nullopt;
  }

  const std::uint64_t seed_ = FromEnvironment("PLANBENCH_FAULT_SEED", 1);
  const std::uint64_t seconds_ = FromEnvironment("PLANBENCH_FAULT_SECONDS", 12);
};

TEST_F(FaultsTest, ProcessesAreKilledAndStoppedAtRandomMoments) {
  constexpr int kRunsASecond = 20;
  const int trials = static_cast<int>(seconds_) * kRunsASecond;
  ChildProcess* driver = StartSession(
      {"--planners", "rrtc", "--problems-range", "1", "--trials", fmt::format("{}", trials)});
  ASSERT_TRUE(WaitUntil([&] { return NumRuns() >= 1 || !driver->Running(); })) << driver->Errors();
  std::mt19937_64 random(seed_);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds_);
  int num_faults = 0;
  std::map<std::string, std::vector<double>> recoveries_s;  // by name
  Killer killer;
  while (driver->Running() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(milliseconds(300 + random() % 900));
    const std::vector<Child> children = ChildrenOf(driver->pid());
    if (children.empty()) continue;
    const Child& victim = children[random() % children.size()];
    ++num_faults;
    if (random() % 2 == 0 && killer.Kills(victim.name)) {
      if (const auto took_s = KillAndAwait(driver, victim)) {
        recoveries_s[victim.name].push_back(*took_s);
      }
    } else {
      kill(victim.pid, SIGSTOP);
      std::this_thread::sleep_for(milliseconds(random() % 2000));
      kill(victim.pid, SIGCONT);
    }
  }
  ASSERT_EQ(driver->Wait(std::chrono::seconds(120 + seconds_ * 4)), 0) << driver->Errors();
  EXPECT_GE(num_faults, 1);
  for (auto& [name, took_s] : recoveries_s) {
    std::sort(took_s.begin(), took_s.end());
    fmt::print("{} killed {} times; recording again after {:.2f} s in the median, {:.2f} at most\n",
               name, took_s.size(), took_s[took_s.size() / 2], took_s.back());
  }
  ExpectOneRecordOfEach(trials);
  // What was hit says so, everything else is as ever.
  EXPECT_EQ(Query(Session(), "SELECT count(*) FROM runs WHERE status NOT IN (0, 7)"), 0)
      << testing::PrintToString(
             Rows(Session(), "SELECT status, message FROM runs WHERE status != 0", 2));
}

TEST_F(FaultsTest, ASceneServerThatFallsSilentIsStartedAgain) {
  // Each run lasts to its limit, by steps so tiny; the problem of the next is asked for after it.
  ChildProcess* driver =
      StartSession({"--planners", "rrtc", "--problems-range", "1-6", "--time", "1", "--set",
                    "rrtc.range=0.00001", "--set", "rrtc.extension=step"});
  ASSERT_TRUE(WaitUntil([&] { return NumRuns() >= 1 || !driver->Running(); })) << driver->Errors();
  const std::optional<int> server = PidOf(driver, "scene_server");
  ASSERT_TRUE(server);
  kill(*server, SIGSTOP);
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_THAT(driver->Errors(), HasSubstr("scene_server has been silent for 10 s; killing it"));
  ExpectOneRecordOfEach(6);
}

TEST_F(FaultsTest, AHostileSenderBendsNothing) {
  ChildProcess* driver =
      StartSession({"--planners", "rrtc", "--problems-range", "1-3", "--trials", "40"});
  std::optional<HostileSender> hostile;
  // Not before, when a driver that finds others on its port leaves.
  ASSERT_TRUE(WaitUntil([&] { return PidOf(driver, "planner_rrtc").has_value(); }));
  hostile.emplace(url(), seed_);
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_GT(hostile->num_forged(), 50);
  hostile.reset();
  ExpectOneRecordOfEach(120);
  EXPECT_EQ(Query(Session(), "SELECT count(*) FROM runs WHERE status != 0"), 0)
      << testing::PrintToString(Rows(Session(), "SELECT request_id, status, message FROM runs", 3));
  EXPECT_EQ(Query(Session(), fmt::format("SELECT count(*) FROM runs WHERE time = {}",
                                         HostileSender::kForgedTime)),
            0);
  EXPECT_EQ(Query(Session(), "SELECT count(*) FROM sessions WHERE hostname = 'forged'"), 0);
  EXPECT_THAT(driver->Errors(), HasSubstr("contradicted what was known"));
  const auto json = nlohmann::json::parse(std::ifstream(Session() / "run.json"));
  EXPECT_GT(json.at("bus").at("malformed_packets"), 0);
  EXPECT_FALSE(json.at("bus").at("contradictions").empty());
}

/// Percent of the datagrams that are lost; as many are doubled, and as many swapped.
class LossyNetworkTest : public FaultsTest, public testing::WithParamInterface<int> {};

TEST_P(LossyNetworkTest, EveryRunHasOneRecord) {
  if (!std::string(PLANBENCH_SANITIZED).empty()) {
    GTEST_SKIP() << "sanitizers want to be the first library, where this one has to be";
  }
  ChildProcess* driver = StartLaunchedDriver(
      Session(), {"--time", "5", "--planners", "rrtc", "--problems-range", "1", "--trials", "3"},
      {"env", fmt::format("LD_PRELOAD={}", PLANBENCH_LOSSY_NETWORK),
       fmt::format("PLANBENCH_LOSS={}", GetParam()),
       fmt::format("PLANBENCH_FAULT_SEED={}", seed_)});
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  ExpectOneRecordOfEach(3);
  // A planner may be silent for so long that it counts as dead, if much is lost.
  EXPECT_EQ(Query(Session(), "SELECT count(*) FROM runs WHERE status NOT IN (0, 7)"), 0);
  EXPECT_GE(Query(Session(), "SELECT count(*) FROM runs WHERE status = 0"), 2);
  if (GetParam() < 10) return;  // none of a few datagrams may be lost
  const auto json = nlohmann::json::parse(std::ifstream(Session() / "run.json"));
  EXPECT_GT(json.at("bus").at("lost_messages"), 0);
}

INSTANTIATE_TEST_SUITE_P(Faults, LossyNetworkTest, testing::Values(1, 10, 30));

TEST_F(FaultsTest, APlannerThatMisbehavesHasOneTrueRecordOfEveryRun) {
  ChildProcess* driver = StartSession(
      {"--planners", "mine", "--planner-command", "mine=sleep 600", "--problems-range", "1-6"});
  const MisbehavingPlanner planner(url());
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  ExpectOneRecordOfEach(6);
  const auto status = [&](int problem) {
    return Query(Session(),
                 fmt::format("SELECT status FROM runs WHERE problem_index = {}", problem));
  };
  for (const int answered : {1, 2, 3, 5}) EXPECT_EQ(status(answered), 2) << answered;
  for (const int unanswered : {4, 6}) EXPECT_EQ(status(unanswered), 7) << unanswered;
  EXPECT_EQ(Query(Session(), fmt::format("SELECT count(*) FROM runs WHERE time = {}",
                                         MisbehavingPlanner::kTime)),
            4);
  const auto reasons = Rows(Session(), "SELECT message FROM runs WHERE status = 7 ORDER BY id", 1);
  ASSERT_EQ(reasons.size(), 2u);
  EXPECT_THAT(reasons, testing::Contains(HasSubstr("no acknowledgement")));
  EXPECT_THAT(reasons, testing::Contains(HasSubstr("session 'another'")));
}

TEST_F(FaultsTest, AValidPathThatComesTwiceOrLateCountsOnceOrNotAtAll) {
  ChildProcess* honest = StartLaunchedDriver(
      folder() / "honest",
      {"--planners", "rrtc", "--problems-range", "1-4", "--directions", "forward"});
  ASSERT_EQ(honest->Wait(), 0) << honest->Errors();
  std::map<int, PlanResultMessage> paths;
  for (const RecordedRun& recorded : ReadRecords(folder() / "honest" / "honest.lcmlog").runs) {
    const RunRecordMessage run = ReadRecord(recorded.place);
    ASSERT_EQ(run.status, PlanStatus::kSolved) << run.request_id;
    paths[run.problem_index] = run.result;
  }
  ChildProcess* driver = StartSession({"--planners", "mine", "--planner-command", "mine=sleep 600",
                                       "--problems-range", "1-4", "--time", "0.5"});
  const MisbehavingPlanner planner(url(), paths);
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  ExpectOneRecordOfEach(4);
  EXPECT_EQ(Query(Session(), fmt::format("SELECT count(*) FROM runs WHERE time = {} AND status = 0 "
                                         "AND problem_index < 4",
                                         MisbehavingPlanner::kTime)),
            3);
  const auto late = Rows(Session(), "SELECT status, message FROM runs WHERE problem_index = 4", 2);
  ASSERT_EQ(late.size(), 1u);
  EXPECT_THAT(late[0], testing::AllOf(testing::StartsWith("1"), HasSubstr("a path came 1")));
  EXPECT_THAT(driver->Output(), HasSubstr("shelf_demo, Mine: 1 TIMED_OUT, problem 4"));
}

TEST_F(FaultsTest, ADiskThatIsFullForAWhileCostsNoRun) {
  ChildProcess* driver =
      StartSession({"--planners", "rrtc", "--problems-range", "1-2", "--trials", "60"});
  ASSERT_TRUE(WaitUntil([&] { return NumRuns() >= 2 || !driver->Running(); })) << driver->Errors();
  const std::optional<int> logger = PidOf(driver, "logger");
  ASSERT_TRUE(logger);
  // Its files may not grow any more.
  const rlimit full = {4096, RLIM_INFINITY};
  rlimit before = {};
  ASSERT_EQ(prlimit(*logger, RLIMIT_FSIZE, &full, &before), 0);
  ASSERT_TRUE(WaitUntil([&] {
    return driver->Errors().find("NOBODY RECORDS") != std::string::npos || !driver->Running();
  })) << driver->Errors();
  EXPECT_THAT(driver->Errors(), HasSubstr("the logger 'logger' cannot: "));
  EXPECT_THAT(driver->Errors(), HasSubstr("File too large"));
  prlimit(*logger, RLIMIT_FSIZE, &before, nullptr);
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_THAT(driver->Errors(), HasSubstr("records again"));
  ExpectOneRecordOfEach(120);
}

TEST_F(FaultsTest, ADiskThatStaysFullEndsWithTheCommandThatGoesOn) {
  ChildProcess* driver =
      StartSession({"--planners", "rrtc", "--problems-range", "1", "--trials", "120"});
  ASSERT_TRUE(WaitUntil([&] { return NumRuns() >= 2 || !driver->Running(); })) << driver->Errors();
  const std::optional<int> logger = PidOf(driver, "logger");
  ASSERT_TRUE(logger);
  const rlimit full = {4096, RLIM_INFINITY};
  ASSERT_EQ(prlimit(*logger, RLIMIT_FSIZE, &full, nullptr), 0);
  EXPECT_EQ(driver->Wait(), 1) << driver->Errors();
  EXPECT_THAT(driver->Errors(), HasSubstr("of 120 run records are not stored by the logger"));
  const std::string output = driver->Output();
  const std::string begin = "Go on with: benchmark_driver ";
  const std::size_t at = output.find(begin);
  ASSERT_NE(at, std::string::npos) << output;
  const std::size_t first = at + begin.size();
  const std::string rest = output.substr(first, output.find('\n', at) - first);
  ChildProcess* resumed = Start({"/bin/sh", "-c", Program("benchmark_driver") + " " + rest});
  ASSERT_EQ(resumed->Wait(), 0) << resumed->Errors();
  ExpectOneRecordOfEach(120);
}

TEST_F(FaultsTest, ASessionWhoseFolderIsRemovedSaysSoInItsLastLine) {
  ChildProcess* driver =
      StartSession({"--planners", "rrtc", "--problems-range", "1", "--trials", "60"});
  ASSERT_TRUE(WaitUntil([&] { return NumRuns() >= 1 || !driver->Running(); })) << driver->Errors();
  std::filesystem::rename(Session(), folder() / "elsewhere");
  EXPECT_EQ(driver->Wait(), 1) << driver->Errors();
  const std::string errors = driver->Errors();
  EXPECT_THAT(errors.substr(errors.find_last_of('\n', errors.size() - 2) + 1),
              HasSubstr("was removed or moved"));
  EXPECT_THAT(driver->Output(), testing::Not(HasSubstr("Go on with"))) << "not there";
  // What was written is whole.
  EXPECT_GE(Query(folder() / "elsewhere", "SELECT count(*) FROM runs"), 1);
}

}  // namespace
}  // namespace planbench
