#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "messaging/asked_runs.h"
#include "tests/benchmark_driver/driver_fixture.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

/// A machine that keeps a planner from working at requests that begin with an id: how often. The
/// planner answers as told, or solves everything.
class DisturbedMachine {
 public:
  DisturbedMachine(FakePlanner* planner, std::map<std::string, int> times,
                   std::function<void(const PlanRequest&)> answer = {})
      : planner_(planner), left_(std::move(times)), answer_(std::move(answer)) {
    Write();
    planner_->OnRequest([this](const PlanRequest& request) { OnRequest(request); });
  }
  ~DisturbedMachine() {
    planner_->OnRequest([](const PlanRequest&) {});
  }
  DisturbedMachine(const DisturbedMachine&) = delete;
  DisturbedMachine& operator=(const DisturbedMachine&) = delete;
  KernelFolders folders() const { return {folder_ / "proc", folder_ / "sys"}; }

 private:
  void OnRequest(const PlanRequest& request) {
    const std::string run = request.request_id.substr(0, request.request_id.find('@'));
    const bool warms_up = request.request_id.ends_with("/warm-up");
    const auto left = left_.find(run);
    if (!warms_up && left != left_.end() && seen_.insert(request.request_id).second &&
        left->second > 0) {
      --left->second;
      waited_ns_ += 1'000'000'000'000;  // far longer than any run, of which so much counts
      Write();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));  // longer than counts for nothing
    }
    answer_ ? answer_(request) : planner_->Solve(request);
  }
  void Write() const {
    folder_.Write(fmt::format("proc/{}/task/1/schedstat", getpid()),
                  fmt::format("0 {} 1\n", waited_ns_));
  }

  FakePlanner* planner_;
  std::map<std::string, int> left_;
  std::function<void(const PlanRequest&)> answer_;
  std::set<std::string> seen_;
  std::int64_t waited_ns_ = 0;
  TemporaryFolder folder_;
};

class DisturbedRunsTest : public DriverTest {
 protected:
  /// On such a machine, disturbed runs made again.
  static DriverOptions Repeating(const DisturbedMachine& machine,
                                 Directions directions = Directions::kBoth) {
    DriverOptions options = Options();
    options.directions = directions;
    options.kernel = machine.folders();
    options.repeat_disturbed = true;
    return options;
  }
};

/// Records in the order in which they came, each once: one is sent again until it is acknowledged.
std::vector<RunRecordMessage> EachOnce(std::vector<RunRecordMessage> records) {
  std::set<std::string> seen;
  std::erase_if(records,
                [&](const auto& record) { return !seen.insert(RunRecordAckId(record)).second; });
  return records;
}

/// What they tell, of answers.
std::vector<std::string> ToldOf(const std::vector<RunRecordMessage>& records) {
  std::vector<std::string> told;
  for (const RunRecordMessage& record : records) {
    const auto& counters = record.result.result.counters;
    told.push_back(fmt::format("{} disturbed {} after {}", record.request_id,
                               counters.at("disturbed"), counters.at("repeats")));
  }
  return told;
}

TEST_F(DisturbedRunsTest, DisturbedRunsAreRecordedAtOnceAndMadeAgainAtTheEnd) {
  FakePlanner planner(&bus_);
  const DisturbedMachine machine(
      &planner, {{"run/cans/1/arm/forward/1", 2}, {"run/cans/1/arm/backward/1", 9}});
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  const DriverOptions options = Repeating(machine);
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  MakeAll(&driver);
  EXPECT_EQ(ToldOf(EachOnce(logger.records().messages())),
            (std::vector<std::string>{"run/cans/1/arm/forward/1 disturbed 1 after 0",
                                      "run/cans/1/arm/backward/1 disturbed 1 after 0",
                                      "run/cans/2/arm/forward/1 disturbed 0 after 0",
                                      "run/cans/2/arm/backward/1 disturbed 0 after 0",
                                      "run/cans/1/arm/forward/1 disturbed 1 after 1",
                                      "run/cans/1/arm/backward/1 disturbed 1 after 1",
                                      "run/cans/1/arm/forward/1 disturbed 0 after 2",
                                      "run/cans/1/arm/backward/1 disturbed 1 after 2"}));
  ASSERT_EQ(driver.runs().size(), 4u) << "a run is one, however often it was made";
  EXPECT_EQ(driver.num_runs(), 4);
  for (const RunRow& run : driver.runs().rows()) {
    EXPECT_EQ(run.repeated, run.problem_index == 1);
    EXPECT_EQ(run.disturbed, run.problem_index == 1 && run.direction == Direction::kBackward);
  }
}

TEST_F(DisturbedRunsTest, AResumedSessionMakesTheRepeatsThatAreOwed) {
  FakePlanner planner(&bus_);
  const std::string first = "run/cans/1/arm/forward/1";
  const DisturbedMachine machine(&planner, {{first, 99}});
  const FakeSceneServer server(&bus_);
  const DriverOptions options = Repeating(machine, Directions::kForward);
  std::vector<SessionMessage> sessions;
  std::vector<RunRecordMessage> attempts;  // at the first problem
  {
    FakeLogger logger(&bus_);
    Driver driver(&bus_, options, LineUp({"arm"}), {});
    MakeAll(&driver);
    sessions = logger.sessions().messages();
    attempts = EachOnce(logger.records().messages());
    std::erase_if(attempts, [&](const auto& record) { return record.request_id != first; });
  }
  ASSERT_EQ(attempts.size(), 3u);
  for (std::size_t made = 0; made < attempts.size(); ++made) {
    FakeLogger logger(&bus_);
    Driver driver(&bus_, options, LineUp({"arm"}), {},
                  HeldSession{{sessions.front()}, {attempts[made]}}.Earlier());
    MakeAll(&driver);
    std::vector<std::string> expected = {"run/cans/2/arm/forward/1 disturbed 0 after 0"};
    for (std::size_t repeat = made + 1; repeat < attempts.size(); ++repeat) {
      const auto place = repeat == made + 1 ? expected.begin() : expected.end();
      expected.insert(place, fmt::format("{} disturbed 1 after {}", first, repeat));
    }
    EXPECT_EQ(ToldOf(EachOnce(logger.records().messages())), expected);
    EXPECT_EQ(driver.runs().size(), 2u);
    EXPECT_EQ(driver.num_runs(), 2);
    EXPECT_TRUE(logger.sessions().messages().back().finished);
  }
}

TEST_F(DisturbedRunsTest, ASessionThatOwesRepeatsIsNotFinished) {
  FakePlanner planner(&bus_);
  const DisturbedMachine machine(&planner, {{"run/cans/1/arm/forward/1", 1}});
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Repeating(machine, Directions::kForward);
  HeldSession earlier;
  {
    Driver driver(&bus_, options, LineUp({"arm"}), {});
    MakeAll(&driver);
    EXPECT_EQ(driver.num_to_repeat(), 0);
    earlier = {{logger.sessions().messages().front()}, EachOnce(logger.records().messages())};
  }
  // As if it had been interrupted before the repeat.
  std::erase_if(earlier.runs, [](const auto& record) { return StandingOf(record).repeats > 0; });
  ASSERT_EQ(earlier.runs.size(), 2u);
  for (const int problem : {2, 1}) {
    options.problem_indices = {problem};
    Driver driver(&bus_, options, LineUp({"arm"}), {}, earlier.Earlier());
    driver.Discover(true, Idle);
    EXPECT_EQ(driver.num_to_repeat(), 1);
    EXPECT_TRUE(driver.Run(Never, Idle));
    const int num_owed = problem == 2 ? 1 : 0;
    EXPECT_EQ(driver.num_owed_repeats(), num_owed);
    EXPECT_EQ(driver.num_to_repeat(), num_owed);
    EXPECT_EQ(driver.num_owed(), 0);
    EXPECT_EQ(driver.num_runs(), 2);
    EXPECT_EQ(logger.sessions().messages().back().finished, num_owed == 0);
  }
}

TEST_F(DisturbedRunsTest, AFailedAttemptThatWasDisturbedDoesNotHoldUpTheOther) {
  FakePlanner planner(&bus_);
  const std::string forward = "run/cans/2/arm/forward/1", backward = "run/cans/2/arm/backward/1";
  std::set<std::string> failed;
  const DisturbedMachine machine(&planner, {{forward, 1}}, [&](const PlanRequest& request) {
    const bool fails = request.request_id.starts_with(forward + "@") &&
                       (failed.empty() || failed.contains(request.request_id));
    if (!fails) return planner.Solve(request);
    failed.insert(request.request_id);
    PlanResult result;
    result.status = PlanStatus::kTimedOut;
    planner.SendResult(request.request_id, result);
  });
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  const DriverOptions options = Repeating(machine, Directions::kAuto);
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  MakeAll(&driver);
  EXPECT_EQ(ToldOf(EachOnce(logger.records().messages())),
            (std::vector<std::string>{
                "run/cans/1/arm/forward/1 disturbed 0 after 0", forward + " disturbed 1 after 0",
                backward + " disturbed 0 after 0", forward + " disturbed 0 after 1"}));
  EXPECT_EQ(driver.num_runs(), 3);
  ASSERT_EQ(driver.runs().size(), 3u);
  for (const RunRow& run : driver.runs().rows()) {
    EXPECT_TRUE(run.confirmed());
    EXPECT_FALSE(run.needs_other);
  }
}

TEST_F(DisturbedRunsTest, OfADisturbedRunThatCannotBeRepeatedTheAnswerStands) {
  FakePlanner planner(&bus_);
  std::atomic<bool> dead = false;
  const DisturbedMachine machine(&planner, {{"run/cans/1/arm/forward/1", 1}},
                                 [&](const PlanRequest& request) {
                                   if (request.request_id.find("/cans/2/") == std::string::npos)
                                     return planner.Solve(request);
                                   planner.FallSilent();
                                   dead = true;
                                 });
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  const DriverOptions options = Repeating(machine, Directions::kForward);
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  EXPECT_TRUE(driver.Run(Never, [&] {
    if (dead) driver.GiveUp("arm", "it died");
  }));
  EXPECT_EQ(Ids(logger.records()),
            (std::set<std::string>{"run/cans/1/arm/forward/1", "run/cans/2/arm/forward/1"}));
  EXPECT_EQ(driver.num_not_asked(), 1) << "the repeat";
  EXPECT_EQ(driver.num_to_repeat(), 1);
  EXPECT_FALSE(logger.sessions().messages().back().finished) << "a resumed session makes it";
  ASSERT_EQ(driver.runs().size(), 2u);
  EXPECT_TRUE(driver.runs().rows().front().confirmed());
  EXPECT_TRUE(driver.runs().rows().front().disturbed);
}

TEST_F(DisturbedRunsTest, WhatDependsOnADisturbedRunWaitsForIt) {
  FakePlanner planner(&bus_);
  const DisturbedMachine machine(&planner, {{"run/cans/1/arm/forward/1", 1}});
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  const DriverOptions options = Repeating(machine, Directions::kAuto);
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  MakeAll(&driver);
  EXPECT_EQ(Ids(logger.records()),
            (std::set<std::string>{"run/cans/1/arm/forward/1", "run/cans/2/arm/forward/1"}));
  EXPECT_EQ(driver.num_runs(), 2);
}

TEST_F(DisturbedRunsTest, DisturbedRunsAreMarkedWhereTheyAreNotRepeated) {
  FakePlanner planner(&bus_);
  const DisturbedMachine machine(&planner, {{"run/cans/1/arm/forward/1", 1}});
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.kernel = machine.folders();
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  MakeAll(&driver);
  EXPECT_TRUE(driver.runs().rows().front().disturbed);
  const RunRecordMessage first = logger.records().messages().at(0);
  EXPECT_EQ(first.request_id, "run/cans/1/arm/forward/1");
  EXPECT_DOUBLE_EQ(first.result.result.counters.at("waiting_time"), first.roundtrip_time_s);
  EXPECT_EQ(first.result.result.counters.at("disturbed"), 1);
  EXPECT_EQ(first.result.result.counters.at("repeats"), 0);
}

}  // namespace
}  // namespace planbench
