#include "results/reproduce.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

#include "results/shell_quoted.h"

namespace planbench {
namespace {

bool IsName(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  });
}

/// The values of a flag that may be repeated, which are recorded with commas between them. Where
/// they are NAME=VALUE, a comma that no name follows is part of a value.
std::vector<std::string> Values(const std::string& recorded, bool are_named) {
  std::vector<std::string> values = {""};
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    if (recorded[i] == ',') {
      const std::string_view rest = std::string_view(recorded).substr(i + 1);
      if (!are_named || IsName(rest.substr(0, std::min(rest.find('='), rest.size())))) {
        values.emplace_back();
        continue;
      }
    }
    values.back() += recorded[i];
  }
  return values;
}

}  // namespace

std::string ReproducingCommand(const std::map<std::string, std::string>& flags) {
  if (flags.empty()) return "";
  if (const auto merged = flags.find(kMergedCommands); merged != flags.end()) return merged->second;
  constexpr auto kOwn = std::to_array<std::string_view>({"out", "resume", "lcm-url"});
  constexpr auto kNamed =
      std::to_array<std::string_view>({"package-path", "planner-command", "set", "reference"});
  const auto is_one_of = [](const auto& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::string command = "benchmark_driver";
  for (const auto& [flag, value] : flags) {
    if (value.empty() || value == "false" || is_one_of(kOwn, flag)) continue;
    if (value == "true") {
      command += " --" + flag;
      continue;
    }
    const bool are_named = is_one_of(kNamed, flag);
    const bool repeats = are_named || flag == "problems";
    for (const std::string& one : repeats ? Values(value, are_named) : std::vector{value}) {
      command += " --" + flag + " " + ShellQuoted(one);
    }
  }
  return command;
}

std::string ResumingCommand(const std::map<std::string, std::string>& flags,
                            const std::filesystem::path& session_folder) {
  return ReproducingCommand(flags) + " --resume " + ShellQuoted(session_folder.string());
}

}  // namespace planbench
