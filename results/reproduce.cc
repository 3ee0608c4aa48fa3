#include "results/reproduce.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "results/recorded_flags.h"
#include "results/session_plan.h"
#include "results/shell_quoted.h"

namespace planbench {
namespace {

constexpr std::string_view kAnd = " && ";

/// Commands that were joined by &&, which may stand in a quoted word of one, too.
std::vector<std::string> SplitCommands(const std::string& joined) {
  std::vector<std::string> commands = {""};
  bool quoted = false;
  for (std::size_t i = 0; i < joined.size(); ++i) {
    if (!quoted && joined.compare(i, kAnd.size(), kAnd) == 0) {
      commands.emplace_back();
      i += kAnd.size() - 1;
      continue;
    }
    if (joined[i] == '\'') quoted = !quoted;
    commands.back() += joined[i];
    // What follows a backslash outside of quotes is a letter like any other.
    if (joined[i] == '\\' && !quoted && i + 1 < joined.size()) commands.back() += joined[++i];
  }
  return commands;
}

}  // namespace

bool IsMerged(const std::map<std::string, std::string>& flags) {
  return flags.contains(kMergedParts) || flags.contains(kHeldParts);
}

bool IsFlag(std::string_view setting) {
  const auto others = {kMergedCommands, kMergedParts, kHeldParts, kPlanSetting};
  return std::find(others.begin(), others.end(), setting) == others.end();
}

std::string ReproducingCommand(const std::map<std::string, std::string>& flags) {
  if (flags.empty()) return "";
  if (const auto merged = flags.find(kMergedCommands); merged != flags.end()) return merged->second;
  constexpr auto kOwn = std::to_array<std::string_view>({"out", "resume", "lcm-url"});
  std::string command = "benchmark_driver";
  for (const auto& [flag, value] : flags) {
    if (value.empty() || value == "false" || !IsFlag(flag)) continue;
    if (std::find(kOwn.begin(), kOwn.end(), flag) != kOwn.end()) continue;
    if (value == "true") {
      command += " --" + flag;
      continue;
    }
    const std::vector<std::string> values =
        TakesSeveralValues(flag) ? SplitFlagValues(value) : std::vector{value};
    for (const std::string& one : values) {
      command += " --" + flag + " " + ShellQuoted(one);
    }
  }
  return command;
}

std::string ResumingCommand(const std::map<std::string, std::string>& flags,
                            const std::filesystem::path& session_folder) {
  std::string resuming;
  for (const std::string& command : SplitCommands(ReproducingCommand(flags))) {
    if (!resuming.empty()) resuming += kAnd;
    resuming += command + " --resume " + ShellQuoted(session_folder.string());
  }
  return resuming;
}

std::string JoinCommands(const std::vector<std::string>& commands) {
  std::string joined;
  std::vector<std::string> known;
  for (const std::string& several : commands) {
    for (const std::string& command : SplitCommands(several)) {
      if (command.empty() || std::find(known.begin(), known.end(), command) != known.end())
        continue;
      if (!known.empty()) joined += kAnd;
      joined += command;
      known.push_back(command);
    }
  }
  return joined;
}

std::string WhatMakesThem(int number, int num_unjudgeable) {
  const std::string them = number == 1 ? "it" : "them";
  if (num_unjudgeable == 0) return "--resume makes " + them;
  const std::string new_session = "a new session with a larger --referee-step";
  if (num_unjudgeable == number) return fmt::format("{} makes {}", new_session, them);
  return fmt::format("--resume makes {} of them, {} the others", number - num_unjudgeable,
                     new_session);
}

std::string DescribeOwed(int number, int num_unjudgeable, int num_repeats,
                         const std::string& resuming) {
  std::vector<std::string> owed;
  if (number > 0) {
    const std::string what =
        num_unjudgeable == 0 ? "" : fmt::format(" ({})", WhatMakesThem(number, num_unjudgeable));
    owed.push_back(fmt::format("not made: {}{}", number, what));
  }
  if (num_repeats > 0) {
    owed.push_back(fmt::format("disturbed and not made again: {}", num_repeats));
  }
  std::string text = fmt::format("runs of the session's earlier plan {}; it is not finished",
                                 fmt::join(owed, ", "));
  const bool may_go_on = number > num_unjudgeable || num_repeats > 0;
  if (may_go_on) text += fmt::format("; go on with: {}", resuming);
  return text;
}

}  // namespace planbench
