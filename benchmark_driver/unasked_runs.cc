#include "benchmark_driver/unasked_runs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace planbench {

void UnaskedRuns::Add(const std::string& request_id, const std::string& planner,
                      const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  if (++counts_[{planner, reason}] > 1) return;
  spdlog::error("{}: no answer: {}; more such runs are only counted", request_id, reason);
}

std::vector<std::string> UnaskedRuns::Lines(
    const std::map<std::string, std::string>& given_up) const {
  const std::scoped_lock lock(mutex_);
  auto counts = counts_;
  for (const auto& [planner, why] : given_up) counts.try_emplace({planner, "given up: " + why}, 0);
  std::vector<std::string> lines;
  for (const auto& [key, count] : counts) {
    lines.push_back(fmt::format("the planner '{}': {} ({} run{})", key.first, key.second, count,
                                count == 1 ? "" : "s"));
  }
  return lines;
}

}  // namespace planbench
