#pragma once

#include <string>
#include <vector>

#include "benchmark_driver/session_results.h"

namespace planbench {

/// What EffortTables show of a run whose path was confirmed, by column; NaN: not taken.
std::vector<double> EffortValues(const RunRecordMessage& record);

/// Effort and path quality of the runs whose path was confirmed: medians over problems, of which
/// each counts by the median of its runs.
std::string EffortTables(const SessionResults& results);

/// What the mesh robot says of confirmed paths, and in what it is another robot than the planners'
/// (RefereeMisfits); empty if it did not judge.
std::string MeshTable(const SessionResults& results, const std::string& referee_misfits);

}  // namespace planbench
