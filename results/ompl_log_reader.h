#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/stored_session.h"

namespace planbench {

/// A log of OMPL's benchmarks as a session (ompl_session.h). Throws InputError with file and line.
StoredSession ReadOmplLog(const std::filesystem::path& file, const std::string& name,
                          std::vector<std::string>* warnings);

}  // namespace planbench
