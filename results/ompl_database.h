#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/stored_session.h"

namespace planbench {

/// A database of OMPL's benchmarks as a session (ompl_session.h); of one of planbench's, the runs
/// that other programs appended. Trials of several experiments on a problem are numbered one after
/// the other; experiments that are there twice count once, which `warnings` tells. Throws
/// InputError, also for runs that cannot be told apart.
StoredSession ReadOmplDatabase(const std::filesystem::path& file, const std::string& name,
                               std::vector<std::string>* warnings);

}  // namespace planbench
