#pragma once

#include <filesystem>
#include <string>

#include "results/stored_session.h"

namespace planbench {

/// A CSV file (RFC 4180, an end of a line within quotes being a space) with a header and the
/// columns problem_set, problem_index (or query_index, which counts from 0; of both, what they tell
/// is one), solved (0 or 1) and time_s (of a run that is not solved it may be empty or nan), and if
/// it has them direction (forward or backward; else forward), trial (else rows of one problem are
/// numbered), time_limit_s (empty or 0: not known), reason, and path measures (docs/database.md),
/// which may be empty or nan; other columns are left alone, but no two may have one name. A run
/// that is not solved counts as TIMED_OUT. Throws InputError with file, line and column.
StoredSession ReadCsvResults(const std::filesystem::path& file, const std::string& name);

}  // namespace planbench
