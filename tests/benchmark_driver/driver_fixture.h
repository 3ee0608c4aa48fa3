#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <string>
#include <vector>

#include "benchmark_driver/driver.h"
#include "tests/benchmark_driver/fake_nodes.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/held_runs.h"

namespace planbench {

/// Ids of all that came; what was repeated counts once.
template <typename Message>
std::set<std::string> Ids(MessageCollector<Message>& collector) {
  std::set<std::string> ids;
  for (const Message& message : collector.messages()) ids.insert(message.request_id);
  return ids;
}

inline void Idle() {}
inline bool Never() { return false; }

/// Expects all runs to be made and recorded.
inline void MakeAll(Driver* driver) {
  driver->Discover(true, Idle);
  EXPECT_TRUE(driver->Run(Never, Idle));
}

inline std::vector<LineUpEntry> LineUp(const std::vector<std::string>& planners) {
  LineUpFlags flags;
  flags.planners = planners;
  return MakeLineUp(flags, std::nullopt);
}

/// A session as a test holds it, to be gone on with.
struct HeldSession {
  std::vector<SessionMessage> sessions;
  std::vector<RunRecordMessage> runs;

  EarlierSession Earlier() const { return {sessions, Held(runs)}; }
};

/// A scene server whose failures the test counts.
inline SupervisedServer CountedBy(const std::atomic<int>& num_failures) {
  return {[&num_failures] { return num_failures.load(); }, [] {}};
}

/// Problem 2 is solved backward only, others in any direction.
inline void SolveSecondBackwardOnly(FakePlanner* planner) {
  planner->OnRequest([planner](const PlanRequest& request) {
    const bool solves = request.direction == Direction::kBackward ||
                        request.request_id.find("/cans/2/") == std::string::npos;
    PlanResult failed;
    failed.status = PlanStatus::kTimedOut;
    planner->SendResult(request.request_id, solves ? FakePlanner::SolvedResult() : failed);
  });
}

class DriverTest : public testing::Test {
 protected:
  DriverTest() { bus_.Start(); }

  static DriverOptions Options() {
    DriverOptions options;
    options.directions = Directions::kBoth;
    options.problem_indices = {1, 2};
    options.discovery_timeout_s = 60;
    options.conditions.request.run_id = "run";
    return options;
  }
  void ExpectNotDiscovered(const DriverOptions& options, const std::vector<std::string>& parts) {
    Driver driver(&bus_, options, LineUp({"arm"}), {});
    ExpectInputError([&] { driver.Discover(false, Idle); }, parts);
  }

  /// What a planner was asked in a session of problems of "cans", each once, in order: "1
  /// forward/2" is problem 1's second trial.
  static std::vector<std::string> AskedOf(FakePlanner* planner) {
    const std::string& name = planner->status.name;
    std::vector<std::string> asked;
    std::set<std::string> seen;
    for (const PlanRequest& request : planner->requests().messages()) {
      if (!seen.insert(request.request_id).second) continue;
      std::string id = request.request_id.substr(0, request.request_id.find('@'));
      id.erase(0, std::string("run/cans/").size());
      id.replace(id.find('/'), name.size() + 2, " ");
      if (request.request_id.ends_with("/warm-up")) id += ", not recorded";
      asked.push_back(id);
    }
    return asked;
  }

  void Reannounce(FakePlanner* planner) {
    NodeRegistry registry(&bus_);
    planbench::Reannounce(&registry, planner);
  }

  Bus bus_{"memq://"};
};

}  // namespace planbench
