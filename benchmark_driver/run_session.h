#pragma once

#include <functional>
#include <map>
#include <string>

#include "benchmark_driver/driver_options.h"

namespace planbench {

/// Runs a whole session as the flags ask (`flags` are for the record): launches the processes if
/// asked, drives, prints the tables, stops everything; or replays one (--replay). Returns the exit
/// code; throws InputError.
int RunSession(const DriverOptions& options, const std::map<std::string, std::string>& flags,
               const std::string& lcm_url, bool lcm_url_given,
               const std::function<bool()>& interrupted);

}  // namespace planbench
