#include "results/recorded_flags.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

namespace planbench {
namespace {

constexpr char kMark = '\\';

bool IsMarked(char c) { return c == ',' || c == kMark; }

/// Whether what stands after a comma is another value of the flag.
bool BeginsValue(std::string_view flag, std::string_view piece) {
  if (flag == "problems") return true;
  const std::string_view name = piece.substr(0, piece.find('='));
  if (name.empty() || name.size() == piece.size()) return false;
  return flag == "reference" || std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
         });
}

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

std::vector<std::string> SplitFlagValues(std::string_view flag, std::string_view recorded) {
  std::vector<std::string> values;
  std::string piece;
  const auto take_piece = [&] {
    if (values.empty() || BeginsValue(flag, piece)) {
      values.push_back(piece);
    } else {
      values.back() += "," + piece;
    }
    piece.clear();
  };
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    const bool marks = recorded[i] == kMark && i + 1 < recorded.size() && IsMarked(recorded[i + 1]);
    if (marks) {
      piece += recorded[++i];
    } else if (recorded[i] == ',') {
      take_piece();
    } else {
      piece += recorded[i];
    }
  }
  take_piece();
  return values;
}

}  // namespace planbench
