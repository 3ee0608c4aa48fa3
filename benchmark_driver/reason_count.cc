#include "benchmark_driver/reason_count.h"

#include <algorithm>
#include <sstream>

namespace planbench {
namespace {

bool IsFigure(const std::string& word) {
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

const std::string& ReasonCount::Commonest() const {
  const auto found = std::max_element(
      reasons_.begin(), reasons_.end(),
      [](const auto& a, const auto& b) { return a.second.count < b.second.count; });
  return found == reasons_.end() ? none_ : found->second.example;
}

}  // namespace planbench
