#pragma once

#include <filesystem>
#include <string>

#include "benchmark_driver/driver_options.h"
#include "benchmark_driver/supervisor.h"

namespace planbench {

/// Checks that every contestant has a program: planner_PROGRAM in `program_folder`, or a command.
/// Throws InputError.
void RequirePrograms(const std::vector<LineUpEntry>& line_up,
                     const std::filesystem::path& program_folder);

/// Starts scene server, planners and logger as children on the bus `lcm_url`, with their output in
/// <session>/logs/, which exists. The programs are those beside this one.
void LaunchProcesses(const DriverOptions& options, const std::vector<LineUpEntry>& line_up,
                     const std::filesystem::path& session_folder, const std::string& lcm_url,
                     Supervisor* supervisor);

/// Stops them: planners and scene server first, the logger last, so that it stores what was still
/// under way.
void StopProcesses(const std::vector<LineUpEntry>& line_up, Supervisor* supervisor);

}  // namespace planbench
