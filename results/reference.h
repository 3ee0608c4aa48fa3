#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/outcomes.h"

namespace planbench {

/// Results from elsewhere as attempts of the contestant `name`: a CSV file with a header and the
/// columns problem_set, problem_index (or query_index, which counts from 0), solved (0 or 1) and
/// time_s, and if it has them direction (forward or backward; else forward), trial (else 1) and
/// time_limit_s (else `time_limit_s`); other columns are left alone, quotes are not known. A run
/// that is not solved counts as TIMED_OUT. Throws InputError with file, line and column.
std::vector<Attempt> ReadReference(const std::filesystem::path& file, const std::string& name,
                                   double time_limit_s);

}  // namespace planbench
