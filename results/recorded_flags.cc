#include "results/recorded_flags.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace planbench {
namespace {

constexpr char kMark = '\\';

bool IsMarked(char c) { return c == ',' || c == kMark; }

}  // namespace

bool TakesSeveralValues(std::string_view flag) {
  constexpr auto kFlags = std::to_array<std::string_view>(
      {"package-path", "planner-command", "problems", "reference", "set"});
  return std::find(kFlags.begin(), kFlags.end(), flag) != kFlags.end();
}

std::string JoinFlagValues(const std::vector<std::string>& values) {
  std::string text;
  for (const std::string& value : values) {
    if (&value != &values.front()) text += ',';
    for (const char c : value) {
      if (IsMarked(c)) text += kMark;
      text += c;
    }
  }
  return text;
}

std::vector<std::string> SplitFlagValues(std::string_view recorded) {
  std::vector<std::string> values = {""};
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    const bool marks = recorded[i] == kMark && i + 1 < recorded.size() && IsMarked(recorded[i + 1]);
    if (marks) {
      values.back() += recorded[++i];
    } else if (recorded[i] == ',') {
      values.emplace_back();
    } else {
      values.back() += recorded[i];
    }
  }
  return values;
}

}  // namespace planbench
