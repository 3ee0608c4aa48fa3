#include "results/awaited_attempts.h"

#include <cstddef>
#include <map>
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

/// Whether the other direction is made besides this attempt. `planned`: RunsOf the session's plan.
bool NeedsOther(const StoredRun& run, const std::map<PlannedRun, bool>& planned) {
  PlannedRun other = {{run.problem_set, run.problem_index, run.trial},
                      PlannerOf(run.request_id),
                      Opposite(run.direction)};
  const auto its_place = planned.find(other);
  if (its_place == planned.end()) return false;
  // Backward is asked after forward unless that claimed a path, or whatever becomes of it.
  if (its_place->second) return !run.claimed;
  other.direction = run.direction;
  const auto place = planned.find(other);
  return place != planned.end() && !place->second && !run.confirmed();
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
  const std::map<PlannedRun, bool> planned = RunsOf(*plan);
  const auto num_left_out = std::erase_if(session->runs, [&](const StoredRun& run) {
    return NeedsOther(run, planned) && !made.contains(KeyOf(run, Opposite(run.direction)));
  });
  return static_cast<int>(num_left_out);
}

}  // namespace planbench
