#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planning/plan_result.h"
#include "results/compared_sessions.h"
#include "results/paired.h"
#include "results/statistics.h"

namespace planbench {

/// Values of a quantity, by problem; several of one problem are those of its runs.
using ValuesByProblem = std::map<int, std::vector<double>>;

/// Each problem counts once, by the median of its values.
Summary SummarizeByProblem(const ValuesByProblem& values);

/// Geometric mean of first / second over the problems that have values of both, of their medians;
/// nothing if there are none, or if one is not positive.
std::optional<RatioEstimate> CompareByProblem(const ValuesByProblem& first,
                                              const ValuesByProblem& second, std::uint64_t seed);

/// Attempts of a contestant on a set whose path the referee confirmed.
std::vector<const StoredRun*> ConfirmedRuns(const ComparedContestant& contestant,
                                            const std::string& problem_set);

/// A path measure of the confirmed runs of a contestant on a set, of the raw or simplified path.
ValuesByProblem MeasuredByProblem(const ComparedContestant& contestant,
                                  const std::string& problem_set, const std::string& measure,
                                  bool raw);

/// Means over the runs; zero if there are none.
PhaseTimes MeanPhases(const std::vector<const StoredRun*>& runs);

}  // namespace planbench
