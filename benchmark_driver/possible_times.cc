#include "benchmark_driver/possible_times.h"

#include <algorithm>
#include <cmath>

#include "results/outcomes.h"

namespace planbench {
namespace {

/// What clocks of two machines may differ by over a round trip, and what a planner rounds to: the
/// share of it, and s.
constexpr double kClockError = 1e-3;
/// What costs that are summed or written otherwise differ by, the share of it.
constexpr double kRounding = 1e-6;
/// So much of what a failed attempt leaves untold, s, may be a slow bus's or a busy machine's.
constexpr double kLittle = 0.05;

/// Whether a time is beyond one that it has to be within.
bool IsBeyond(double time_s, double limit_s) {
  return time_s > (1 + kClockError) * limit_s + kClockError;
}

double SumOfParts(const PhaseTimes& phases) {
  double sum_s = 0;
  for (double PhaseTimes::*const part : kPartsOfTotal) sum_s += phases.*part;
  return sum_s;
}

/// Brings planning time, parts and progress within the total time.
void KeepWithinTotal(PlanResult* result) {
  result->planning_time_s = std::min(result->planning_time_s, result->total_time_s);
  if (const double sum_s = SumOfParts(result->phases); IsBeyond(sum_s, result->total_time_s)) {
    for (double PhaseTimes::*const part : kPartsOfTotal) {
      result->phases.*part *= result->total_time_s / sum_s;
    }
  }
  for (PlanProgress& progress : result->progress) {
    progress.elapsed_s = std::min(progress.elapsed_s, result->total_time_s);
  }
}

/// No part of a time is longer than the whole, which holds the first improvement of a path.
void KeepTogether(PlanResult* result) {
  double longest_s = std::max(result->planning_time_s, SumOfParts(result->phases));
  for (const PlanProgress& progress : result->progress) {
    longest_s = std::max(longest_s, progress.elapsed_s);
  }
  if (IsBeyond(longest_s, result->total_time_s)) {
    result->counters[kContradictoryTime] = longest_s - result->total_time_s;
  }
  result->total_time_s = std::max(result->total_time_s, result->planning_time_s);
  if (result->Solves() && !result->progress.empty()) {
    result->total_time_s = std::max(result->total_time_s, result->progress.front().elapsed_s);
  }
  KeepWithinTotal(result);
}

/// The planning time is no shorter than that (s), by what else is told.
void RaisePlanningTime(double least_s, PlanResult* result) {
  double& planning_time_s = result->planning_time_s;
  if (IsBeyond(least_s, planning_time_s)) {
    double& contradiction_s = result->counters[kContradictoryTime];
    contradiction_s = std::max(contradiction_s, least_s - planning_time_s);
  }
  planning_time_s = std::max(planning_time_s, least_s);
}

/// A path was not there before the first improvement that is told of (unless the limit came with it
/// in hand), and does not cost more than the last.
void KeepToProgress(double time_limit_s, PlanResult* result) {
  if (!result->Solves() || result->progress.empty()) return;
  const double first_s = result->progress.front().elapsed_s;
  const double planning_time_s = result->planning_time_s;
  if (planning_time_s < time_limit_s && IsBeyond(first_s, planning_time_s)) {
    RaisePlanningTime(first_s, result);
  }
  const double last_cost = result->progress.back().cost, excess = result->cost - last_cost;
  const bool are_told = last_cost != 0 && result->cost != 0;
  if (!are_told || excess <= kRounding * std::abs(last_cost)) return;
  result->counters[kContradictoryCost] = excess;
  for (PlanProgress& progress : result->progress) {
    if (progress.cost != 0) progress.cost = std::max(progress.cost, result->cost);
  }
}

/// No time is longer than that which passed until the answer came.
void KeepWithinRoundTrip(double roundtrip_time_s, PlanResult* result) {
  double& simplification_s = result->phases.simplification_s;
  const double told_s = result->total_time_s + simplification_s;
  if (!IsBeyond(told_s, roundtrip_time_s)) return;
  result->counters[kToldTime] = told_s;
  result->total_time_s = std::min(result->total_time_s, roundtrip_time_s);
  simplification_s = std::min(simplification_s, roundtrip_time_s - result->total_time_s);
  KeepWithinTotal(result);
}

/// Who is not asked for better paths has planned until the search ended, or the limit came: the
/// path was handed over then.
void CountToTheEnd(const PlanRequest& request, PlanResult* result) {
  if (request.anytime || !result->Solves()) return;
  RaisePlanningTime(std::min(result->total_time_s, request.time_limit_s), result);
}

/// What a search with a path in hand took beyond the limit. Of others that their time tells.
void NoteOverrun(double time_limit_s, PlanResult* result) {
  const double overrun_s = result->total_time_s - time_limit_s;
  if (result->Solves() && !IsLate(result->planning_time_s, time_limit_s) &&
      overrun_s > kMuchTime_s) {
    result->counters[kOverrunTime] = overrun_s;
  }
}

/// A failed attempt, as one whose path is late, counts to the end of its search. Where the limit
/// came, or no time is told at all, and less is told than is left of the round trip, that stands in
/// its place, the limit at most. What other failures leave untold may be loading, which does not
/// count.
void CountFailedAttempt(double roundtrip_time_s, double time_limit_s, bool is_overdue,
                        PlanResult* result) {
  if (result->Solves() && !is_overdue && !IsLate(result->planning_time_s, time_limit_s)) return;
  double& total_s = result->total_time_s;
  result->planning_time_s = total_s;
  const bool limit_came = is_overdue || result->status == PlanStatus::kTimedOut;
  const bool tells_nothing = total_s == 0 && result->status != PlanStatus::kInvalidRequest;
  if (!limit_came && !tells_nothing) return;
  const double passed_s =
      std::min(roundtrip_time_s - result->phases.simplification_s, time_limit_s);
  const double untold_s = passed_s - total_s;
  if (untold_s <= std::max(total_s, kLittle)) return;
  result->counters[kUntoldFailure] = untold_s;
  result->planning_time_s = total_s = passed_s;
}

/// What an answer that came after the time limit does not tell of, though it tells of less.
void NoteUntoldTime(double roundtrip_time_s, double time_limit_s, PlanResult* result) {
  const double simplification_s = result->phases.simplification_s;
  const double untold_s = roundtrip_time_s - result->total_time_s - simplification_s;
  if (roundtrip_time_s - simplification_s > time_limit_s + kMuchTime_s && untold_s > kMuchTime_s) {
    result->counters[kUntoldTime] = untold_s;
  }
}

}  // namespace

void KeepTimesPossible(double roundtrip_time_s, const PlanRequest& request, bool is_overdue,
                       PlanResult* result) {
  const double time_limit_s = request.time_limit_s;
  for (const OddTimes& odd : kOddTimes) result->counters.erase(odd.counter);
  KeepTogether(result);
  KeepToProgress(time_limit_s, result);
  KeepWithinRoundTrip(roundtrip_time_s, result);
  CountToTheEnd(request, result);
  NoteOverrun(time_limit_s, result);
  CountFailedAttempt(roundtrip_time_s, time_limit_s, is_overdue, result);
  NoteUntoldTime(roundtrip_time_s, time_limit_s, result);
}

}  // namespace planbench
