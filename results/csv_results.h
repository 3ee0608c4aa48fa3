#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/stored_session.h"

namespace planbench {

/// A CSV file (RFC 4180, a row a line) with a header and the columns problem_set, problem_index (or
/// query_index, which counts from 0; of both, what they tell is one), solved (0 or 1) and time_s,
/// and if it has them direction (forward or backward; else forward), trial (else 1), time_limit_s
/// (else `time_limit_s`), reason, and path measures (docs/database.md), which may be empty; other
/// columns are left alone, but no two may have one name. A run that is not solved counts as
/// TIMED_OUT, and so does one that is after its time limit (0: there is none that is known), of
/// which `warnings` tells. Throws InputError with file, line and column.
StoredSession ReadCsvResults(const std::filesystem::path& file, const std::string& name,
                             double time_limit_s, std::vector<std::string>* warnings);

}  // namespace planbench
