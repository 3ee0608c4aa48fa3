#include "problem_generator/rejections.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace planbench {

double Rejections::Miss::Size() const {
  return off_m / allowed.position_tolerance_m + off_rad / allowed.orientation_tolerance_rad;
}

void Rejections::Add(const Rejections& other) {
  for (const auto& [key, count] : other.counts_) counts_[key] += count;
  for (const auto& [reason, miss] : other.least_misses_) KeepLeast(reason, miss);
}

void Rejections::Add(const std::string& reason, const std::string& where, const Miss& miss) {
  Add(reason, where);
  KeepLeast(reason, miss);
}

void Rejections::KeepLeast(const std::string& reason, const Miss& miss) {
  Miss& least = least_misses_.emplace(reason, miss).first->second;
  if (miss.Size() < least.Size()) least = miss;
}

std::map<std::string, long> Rejections::ByReason() const {
  std::map<std::string, long> by_reason;
  for (const auto& [key, count] : counts_) by_reason[key.first] += count;
  return by_reason;
}

std::string Rejections::Summary() const {
  const std::map<std::string, long> by_reason = ByReason();
  std::vector<std::pair<std::string, long>> sorted(by_reason.begin(), by_reason.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  if (sorted.empty()) return "nothing";
  std::vector<std::string> counts;
  for (const auto& [reason, count] : sorted) {
    counts.push_back(fmt::format("{} {}", reason, count));
    const auto miss = least_misses_.find(reason);
    if (miss == least_misses_.end()) continue;
    const auto& [off_m, off_rad, allowed] = miss->second;
    counts.back() += fmt::format(" ({})", DescribeMiss(off_m, off_rad, allowed));
  }
  return fmt::format("{}", fmt::join(counts, ", "));
}

std::string Rejections::MostFrequentPlace() const {
  const auto most =
      std::max_element(counts_.begin(), counts_.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts_.end() ? "" : most->first.second;
}

}  // namespace planbench
