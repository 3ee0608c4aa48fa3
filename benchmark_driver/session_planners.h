#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "benchmark_driver/planner_client.h"
#include "benchmark_driver/planner_renewal.h"
#include "benchmark_driver/run_executor.h"
#include "benchmark_driver/schedule.h"
#include "messaging/bus.h"
#include "messaging/messages.h"
#include "messaging/node_registry.h"

namespace planbench {

/// Planners whose processes are this one's to start, by name.
struct SupervisedPlanners {
  /// PlannerRenewal's.
  std::function<void(const std::string& planner)> start_anew = {};
  /// Supervisor::HowEnded.
  std::function<std::string(const std::string& planner,
                            std::chrono::steady_clock::time_point since)>
      how_ended = {};
};

/// The planners of a session while its runs are made: ready to be asked, each by one client, or
/// given up. Thread-safe for different planners.
class SessionPlanners {
 public:
  /// `found`: by name, as they are described: what is described otherwise is not asked. `patience`:
  /// with one that is not live (PlannerClient::Terms). `problems_per_process`: PlannerRenewal's.
  SessionPlanners(Bus* bus, NodeRegistry* registry, RunExecutor* executor,
                  std::map<std::string, NodeStatusMessage> found,
                  std::chrono::milliseconds patience, std::optional<int> problems_per_process,
                  SupervisedPlanners supervised);

  /// Of whom a run asks (RunExecutor::RequestsOf), in that order. A process that has given no
  /// result yet, whatever it came after, is first asked for one that is not recorded, so that what
  /// it does only once is no part of a run. Nothing if `interrupted`.
  std::optional<std::vector<PlannerClient*>> ReadyFor(const ScheduledRun& run,
                                                      const std::function<bool()>& interrupted);

  /// A planner that was asked on another host than it was found on.
  struct Move {
    NodeStatusMessage process;  ///< The first there.
    std::string warning;        ///< For whoever reads the session's times.
  };
  /// Each planner's to each host once. Thread-safe.
  std::vector<Move> moves() const;

  /// Driver's. Thread-safe.
  void GiveUp(const std::string& planner, const std::string& reason);
  std::map<std::string, std::string> given_up() const;

 private:
  PlannerClient* ClientOf(const std::string& planner);
  /// Says once if the process that is asked for a run is on a host that is new.
  void NoteHost(const ScheduledRun& run, const PlannerClient& planner);
  PlannerClient::Terms TermsOf(const std::string& planner);
  /// "" if it is not.
  std::string WhyGivenUp(const std::string& planner) const;

  Bus* bus_;
  NodeRegistry* registry_;
  RunExecutor* executor_;
  const std::map<std::string, NodeStatusMessage> found_;
  const std::chrono::milliseconds patience_;
  const SupervisedPlanners supervised_;
  PlannerRenewal renewal_;
  mutable std::mutex mutex_;
  std::map<std::string, std::string> given_up_;  // and why
  std::vector<Move> moves_;
  std::map<std::string, std::unique_ptr<PlannerClient>> clients_;
};

}  // namespace planbench
