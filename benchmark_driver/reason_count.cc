#include "benchmark_driver/reason_count.h"

#include <algorithm>
#include <sstream>

namespace planbench {
namespace {

/// A number, or an id of a request.
bool IsFigure(const std::string& word) {
  if (word.find('@') != std::string::npos) return true;
  return word.find_first_of("0123456789") == 0 &&
         word.find_first_not_of("0123456789.e+-,:;") == std::string::npos;
}

}  // namespace

void ReasonCount::Add(const std::string& reason) {
  std::string words;
  std::istringstream text(reason);
  for (std::string word; text >> word;) words += IsFigure(word) ? "# " : word + " ";
  Reason& known = reasons_[words];
  if (known.count++ == 0) known.example = reason;
}

std::string ReasonCount::Summary() const {
  const auto commonest = std::max_element(
      reasons_.begin(), reasons_.end(),
      [](const auto& a, const auto& b) { return a.second.count < b.second.count; });
  if (commonest == reasons_.end() || commonest->first.empty()) return "";
  int num_runs = 0;
  for (const auto& [words, reason] : reasons_) num_runs += reason.count;
  const int count = commonest->second.count;
  const char* before = 2 * count < num_runs ? "among others: " : "mostly: ";
  return before + commonest->second.example;
}

}  // namespace planbench
