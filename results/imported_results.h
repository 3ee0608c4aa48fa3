#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "results/stored_session.h"

namespace planbench {

/// Results from elsewhere as the session of a contestant `name` that no referee has seen; of
/// several planners one each, "NAME: PLANNER". docs/lineups.md says what the files may be: CSV,
/// logs of OMPL's benchmarks, and OMPL's benchmark databases (of one of ours, the runs that other
/// programs appended). `time_limit_s`: of runs whose file does not tell; 0: not known. What the
/// file calls solved counts as TIMED_OUT if it tells of no path by the limit, or of no time;
/// without a known limit nothing is late. A failed run without a time has taken its limit.
/// `warnings` gets a line for each kind of run that does not count as the file says. Throws
/// InputError with file, line and column.
StoredSession ImportResults(const std::filesystem::path& file, const std::string& name,
                            double time_limit_s, std::vector<std::string>* warnings);

/// Indices of problems by set; of a set without any, all that it has.
using ProblemsBySet = std::map<std::string, std::set<int>>;
ProblemsBySet ProblemsOf(const std::vector<StoredSession>& sessions);

/// Leaves of imported results those of `problems`, the session's; `warnings` gets a line that
/// counts the others and names the first. Throws InputError if that leaves nothing.
void KeepProblems(const ProblemsBySet& problems, StoredSession* imported,
                  std::vector<std::string>* warnings);

/// One session a name of what was imported under these names: its contestants of one name are one.
/// Throws InputError naming the file if two files hold the same trial.
std::vector<StoredSession> JoinImports(const std::vector<std::string>& names,
                                       std::vector<StoredSession> imported);

/// Throws InputError if a contestant of the imported results is called as one of `contestants`, for
/// which it would be taken.
void RequireOtherNames(const std::set<std::string>& contestants,
                       const std::vector<StoredSession>& imported);

}  // namespace planbench
