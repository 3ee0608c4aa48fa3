#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messaging/messages.h"
#include "results/session_plan.h"

namespace planbench {

/// A contestant, how it is started, and which runs it makes; or who is none and is asked for the
/// paths alone that contestants improve.
struct LineUpEntry {
  Contestant contestant;
  std::string key;                              ///< In the line-up; all of a sweep have one.
  std::string program;                          ///< planner_PROGRAM, unless it has a command.
  std::optional<std::filesystem::path> config;  ///< Its settings file; none: the robot folder's.
  std::vector<std::string> settings;            ///< "KEY=VALUE", over those of the file.
  std::map<std::string, std::string> origins;   ///< By their keys, where their values stand.
  std::vector<std::string> swept;               ///< Keys of those that its name tells.
  std::optional<Directions> directions;         ///< None: the session's.
  bool finds_first_paths_only = false;          ///< Is no contestant.
};

/// What the flags say of the contestants.
struct LineUpFlags {
  std::optional<std::filesystem::path> file;
  std::vector<std::string> planners;  ///< Which ones; empty: all of the file, else ara and rrtc.
  std::vector<std::pair<std::string, std::string>> commands;  ///< Planner, command.
  std::vector<std::pair<std::string, std::string>> settings;  ///< Planner, "KEY=VALUE".
};

/// Reads a line-up (docs/lineups.md). A settings file is looked for beside it, then in
/// `robot_folder`; with none of these (planners that run already) it is not looked for. Throws
/// InputError with file, line and field.
std::vector<LineUpEntry> ReadLineUp(const std::filesystem::path& file,
                                    const std::optional<std::filesystem::path>& robot_folder);

/// The contestants that the flags ask for, in the order of --planners or else of the line-up;
/// without a line-up each is named as its program. The key of a sweep stands for all contestants
/// that it makes, as `first_path_of` for the one of them that is chosen. Behind the contestants
/// stand those whose paths they improve and that are not chosen. Throws InputError for names that
/// are unknown, another process's, occur twice or would share their channels, for commands and
/// settings of others, for settings that a sweep decides, and where a name stands for several and
/// one is needed.
std::vector<LineUpEntry> MakeLineUp(const LineUpFlags& flags,
                                    const std::optional<std::filesystem::path>& robot_folder);

/// Throws InputError if one is given another's path: the other would search for both at once, where
/// contestants work at once.
void RequireNoFirstPaths(const std::vector<LineUpEntry>& line_up);

}  // namespace planbench
