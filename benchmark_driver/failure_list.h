#pragma once

#include <string>

#include "benchmark_driver/session_results.h"

namespace planbench {

/// The runs whose path is not confirmed, counted by set, contestant and status, each with its
/// problems and its commonest reason, in lines of at most kTextWidth; empty if there are none.
std::string FailureSummary(const SessionResults& results);

/// Every one of them in a row of its own, with its reason; empty if there are none.
std::string FailureList(const SessionResults& results);

}  // namespace planbench
