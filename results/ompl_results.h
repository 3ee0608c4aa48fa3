#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/stored_session.h"

namespace planbench {

/// Results of OMPL's benchmarks (ompl::tools::Benchmark, MoveIt's too). A planner becomes a
/// contestant, `name` if there is one, else "NAME: PLANNER"; with several settings it is several,
/// "NAME: PLANNER #2". Only an exact solution is a path; one
/// that OMPL calls incorrect counts as INVALID_PATH. "solved" counts where it contradicts "status",
/// which a warning tells. The problem of a run is that of its properties
/// "problem set", "problem index" and "trial", if there are such; else an experiment is a problem:
/// SET/3 is problem 3 of SET, any other name the first problem of a set of its own, and the runs of
/// a planner are its trials.

/// A log. Throws InputError with file and line.
StoredSession ReadOmplLog(const std::filesystem::path& file, const std::string& name,
                          std::vector<std::string>* warnings);

/// A database; of one of planbench's, the runs that other programs appended. Trials of several
/// experiments on a problem are numbered one after the other; experiments that are there twice
/// count once. Throws InputError, also for runs that cannot be told apart.
StoredSession ReadOmplDatabase(const std::filesystem::path& file, const std::string& name,
                               std::vector<std::string>* warnings);

}  // namespace planbench
