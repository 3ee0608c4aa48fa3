#include "results/awaited_attempts.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/error.h"
#include "results/session_plan.h"

namespace planbench {
namespace {

/// Contestant, set, problem, trial and direction.
using AttemptKey = std::tuple<std::size_t, std::string, int, int, Direction>;

AttemptKey KeyOf(const StoredRun& run, Direction direction) {
  return {run.contestant, run.problem_set, run.problem_index, run.trial, direction};
}

/// A planner's name on the bus, of a request id that ends with "/PLANNER/DIRECTION/TRIAL".
std::string PlannerOf(const std::string& request_id) {
  std::size_t end = std::string::npos;
  for (int i = 0; i < 2; ++i) {
    const std::size_t slash = request_id.rfind('/', end);
    if (slash == std::string::npos || slash == 0) return "";
    end = slash - 1;
  }
  const std::size_t begin = request_id.rfind('/', end);
  return begin == std::string::npos ? "" : request_id.substr(begin + 1, end - begin);
}

/// Whether a call of the plan makes the other direction besides this attempt.
bool NeedsOther(const StoredRun& run, const SessionPlan& plan) {
  const std::string planner = PlannerOf(run.request_id);
  const PlannedTrial trial = {run.problem_set, run.problem_index, run.trial};
  return std::any_of(plan.begin(), plan.end(), [&](const PlannedCall& call) {
    const std::optional<Directions> asked = call.DirectionsOf(planner, trial);
    if (asked == Directions::kBoth) return !run.confirmed();
    // Backward is asked only after forward, unless that claimed a path or could not be made at all.
    return asked == Directions::kAuto && run.direction == Direction::kForward && !run.claimed &&
           run.roundtrip_time_s > 0;
  });
}

/// Throws InputError naming the session's file.
std::optional<SessionPlan> PlanOf(const StoredSession& session) {
  try {
    return ReadPlan(session.flags);
  } catch (const InputError& error) {
    throw InputError(session.file.string() + ": " + error.what());
  }
}

}  // namespace

int LeaveOutAwaiting(StoredSession* session) {
  const bool complete =
      session->finished && static_cast<int>(session->runs.size()) >= session->num_runs;
  if (session->imported || complete) return 0;
  const std::optional<SessionPlan> plan = PlanOf(*session);
  if (!plan) return 0;
  std::set<AttemptKey> made;
  for (const StoredRun& run : session->runs) made.insert(KeyOf(run, run.direction));
  const auto num_left_out = std::erase_if(session->runs, [&](const StoredRun& run) {
    const Direction other =
        run.direction == Direction::kForward ? Direction::kBackward : Direction::kForward;
    return NeedsOther(run, *plan) && !made.contains(KeyOf(run, other));
  });
  return static_cast<int>(num_left_out);
}

}  // namespace planbench
