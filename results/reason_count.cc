#include "results/reason_count.h"

#include <algorithm>
#include <sstream>

namespace planbench {
namespace {

/// A number, in parentheses or not, or an id of a request.
bool IsFigure(const std::string& word) {
  if (word.find('@') != std::string::npos) return true;
  const std::size_t digits = word.find_first_not_of("([-+");
  return digits != std::string::npos && word[digits] >= '0' && word[digits] <= '9' &&
         word.find_first_not_of("0123456789.e+-,:;/%)]", digits) == std::string::npos;
}

}  // namespace

std::string WithoutFigures(const std::string& reason) {
  std::string words;
  std::istringstream text(reason);
  for (std::string word; text >> word;) words += IsFigure(word) ? "# " : word + " ";
  return words;
}

void ReasonCount::Add(const std::string& reason) {
  Reason& known = reasons_[WithoutFigures(reason)];
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
