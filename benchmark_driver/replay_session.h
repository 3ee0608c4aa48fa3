#pragma once

#include <functional>
#include <string>

#include "benchmark_driver/driver_options.h"

namespace planbench {

/// Makes the requests of the event log `options.replay` again (replay.h), with planners that it
/// launches if asked, and prints what differs. Returns the exit code: kExitOk if all answers agree.
/// Throws InputError.
int ReplaySession(const DriverOptions& options, const std::string& run_id,
                  const std::string& lcm_url, bool lcm_url_given,
                  const std::function<bool()>& interrupted);

}  // namespace planbench
