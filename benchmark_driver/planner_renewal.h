#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "benchmark_driver/planner_client.h"

namespace planbench {

/// Has each planner's process make room for a new one after every so many problems: what a process
/// is faster or slower by for as long as it lives is then drawn anew. One that came in the place of
/// another that died has what is left of that one's problems. Thread-safe.
class PlannerRenewal {
 public:
  /// `problems`: of one process; nothing: all. `start_anew`: ends the process of a planner, by
  /// name, and starts another; it need not wait for that.
  explicit PlannerRenewal(std::optional<int> problems = {},
                          std::function<void(const std::string& planner)> start_anew = {});

  /// To be called before each request. Where the planner's process had its problems and this is
  /// another, a new one is on its way, and whoever is live is not asked any more.
  void Renew(const std::string& problem_set, int problem_index, PlannerClient* planner);

 private:
  struct Asked {
    std::pair<std::string, int> problem;  // the last
    int num_problems = 0;                 // of this process
  };

  std::optional<int> problems_;
  std::function<void(const std::string&)> start_anew_;
  std::mutex mutex_;
  std::map<std::string, Asked> asked_;  // by planner
};

}  // namespace planbench
