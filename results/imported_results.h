#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/stored_session.h"

namespace planbench {

/// Results from elsewhere as the session of a contestant `name` that no referee has seen; of
/// several planners one each, "NAME: PLANNER". docs/lineups.md says what the files may be: CSV,
/// logs of OMPL's benchmarks, and OMPL's benchmark databases (of one of ours, the runs that other
/// programs appended). `time_limit_s`: of runs whose file does not tell. Throws InputError with
/// file, line and column.
StoredSession ImportResults(const std::filesystem::path& file, const std::string& name,
                            double time_limit_s);

/// Leaves of imported results the problems that one of the sessions has. Throws InputError if that
/// leaves nothing.
void KeepProblemsOf(const std::vector<StoredSession>& sessions, StoredSession* imported);

}  // namespace planbench
