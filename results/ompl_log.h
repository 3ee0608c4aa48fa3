#pragma once

#include <string>

#include "results/stored_session.h"

namespace planbench {

/// The runs of a session on a set as a log of OMPL's benchmarks, which ompl_benchmark_statistics
/// makes a database of: an experiment named like the set, its planners the contestants. Every
/// attempt is a run, solved if the referee confirmed its path, and tells its problem, trial and
/// direction in properties of their own.
std::string OmplLog(const StoredSession& session, const std::string& problem_set);

}  // namespace planbench
