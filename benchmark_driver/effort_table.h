#pragma once

#include <string>
#include <vector>

#include "benchmark_driver/session_results.h"

namespace planbench {

/// What EffortTable shows of a run whose path was confirmed, by column; NaN: not taken.
std::vector<double> EffortValues(const RunRecordMessage& record);

/// Medians of effort and path quality over the runs whose path was confirmed.
std::string EffortTable(const SessionResults& results);

/// What the mesh robot says of confirmed paths; empty if it did not judge.
std::string MeshTable(const SessionResults& results);

}  // namespace planbench
