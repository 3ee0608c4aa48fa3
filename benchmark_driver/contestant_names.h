#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmark_driver/line_up.h"
#include "messaging/messages.h"

namespace planbench {

/// What the contestants of a line-up are called in tables and results, by planner: as the line-up
/// says, or else by what the planner calls its algorithm (its name on the bus, if that is nothing;
/// cut, if it is very long) and whose path it improves. No two have one name: where several would,
/// those that the line-up does not name have what tells them apart behind it. `planners`: all of
/// the line-up, by name.
std::map<std::string, std::string> ContestantNames(
    const std::vector<LineUpEntry>& line_up,
    const std::map<std::string, NodeStatusMessage>& planners);

}  // namespace planbench
