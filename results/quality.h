#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
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

/// Geometric mean of first / second over the problems that have positive values of both, of their
/// medians: 0 has no ratio. Nothing if there are none.
std::optional<RatioEstimate> CompareByProblem(const ValuesByProblem& first,
                                              const ValuesByProblem& second);

/// Of attempts of one contestant on one set those whose path counts: confirmed, and of a trial's
/// two directions the one from start to goal if that is (FoldAttempts).
template <typename Run>
std::vector<const Run*> ConfirmedRuns(const std::vector<const Run*>& attempts) {
  std::set<std::pair<int, int>> forward;  // problem and trial
  for (const Run* run : attempts) {
    if (run->confirmed() && run->direction == Direction::kForward) {
      forward.emplace(run->problem_index, run->trial);
    }
  }
  std::vector<const Run*> counted;
  std::copy_if(attempts.begin(), attempts.end(), std::back_inserter(counted), [&](const Run* run) {
    return run->confirmed() && (run->direction == Direction::kForward ||
                                !forward.contains({run->problem_index, run->trial}));
  });
  return counted;
}
/// Those of a contestant's attempts on a set.
std::vector<const StoredRun*> ConfirmedRuns(const ComparedContestant& contestant,
                                            const std::string& problem_set);

/// A path measure of the confirmed runs of a contestant on a set, of the raw or simplified path;
/// without paths that owe to a search after the limit (OwesToOverrun).
ValuesByProblem MeasuredByProblem(const ComparedContestant& contestant,
                                  const std::string& problem_set, const std::string& measure,
                                  bool raw);

/// What is to be said of a contestant by the referee's words on the simplified paths of its
/// confirmed runs (nothing: there is none), beginning with its name; "" if none is rejected.
std::string RejectedSimplifiedNote(const std::string& contestant,
                                   const std::vector<std::optional<bool>>& verdicts);

/// How unevenly the machine worked: what a checked configuration cost on average, in the attempt in
/// which that was most over the one in which it was least, of the confirmed ones at a problem that
/// looked for the path in one direction; the median over the problems with several. Other trials
/// check other configurations of the same scene, so that the luck of a search counts little.
/// Nothing if no problem has several, or if the planner does not count.
std::optional<double> CheckingSpread(const ComparedContestant& contestant);

/// Means over the runs that tell of their phases, of simplification over those that had any; zero
/// if there are none.
PhaseTimes MeanPhases(const std::vector<const StoredRun*>& runs);

}  // namespace planbench
