#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace planbench {

/// Counts runs that a planner is not asked for any more, of which there may be thousands, by
/// planner and reason, and says so of the first of each. Thread-safe.
class UnaskedRuns {
 public:
  void Add(const std::string& request_id, const std::string& planner, const std::string& reason);

  /// How many of each, in lines; none, perhaps, of planners that were `given_up`, and why.
  std::vector<std::string> Lines(const std::map<std::string, std::string>& given_up) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, int> counts_;  // by planner and reason
};

}  // namespace planbench
