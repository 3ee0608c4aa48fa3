#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmark_driver/line_up.h"
#include "messaging/messages.h"

namespace planbench {

/// What a session's contestants have been called so far, by planner.
std::map<std::string, std::string> NamesGiven(const std::vector<SessionMessage>& earlier);

/// What the contestants of a line-up are called in tables and results, by planner, beside those of
/// `given` (NamesGiven): as the line-up says, or else as given, or else by what the planner calls
/// its algorithm (its name on the bus, if that is nothing; cut, if it is very long) and whose path
/// it improves. No two have one name: where several would, those that are neither named by the
/// line-up nor given have what tells them apart behind it. So a session that is resumed keeps its
/// names, whoever else takes part this time. `planners`: all of the line-up, by name.
std::map<std::string, std::string> ContestantNames(
    const std::vector<LineUpEntry>& line_up,
    const std::map<std::string, NodeStatusMessage>& planners,
    const std::map<std::string, std::string>& given);

}  // namespace planbench
