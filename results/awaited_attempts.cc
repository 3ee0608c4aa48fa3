#include "results/awaited_attempts.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace planbench {
namespace {

using Trial = std::tuple<std::string, int, int>;  // set, problem and number

Trial TrialOf(const StoredRun& run) { return {run.problem_set, run.problem_index, run.trial}; }

/// What a contestant's runs tell of the directions that it tries.
struct Tried {
  std::set<Trial> backward;  ///< Trials with an attempt from goal to start.
  bool both = false;         ///< Also where the other had found a path.
  std::vector<const StoredRun*> forward;
};

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

/// Whether the other direction is made after this attempt, of a contestant that tries both: unless
/// it claimed a path, or could not be made at all.
bool IsFollowed(const StoredRun& run, bool both) {
  if (both) return !run.confirmed();
  return !run.claimed && run.roundtrip_time_s > 0;
}

}  // namespace

int LeaveOutAwaiting(StoredSession* session) {
  const bool complete =
      session->finished && static_cast<int>(session->runs.size()) >= session->num_runs;
  if (session->imported || complete) return 0;
  const auto flag = session->flags.find("directions");
  const std::string directions = flag == session->flags.end() ? "" : flag->second;

  std::map<std::size_t, Tried> contestants;
  for (const StoredRun& run : session->runs) {
    Tried& tried = contestants[run.contestant];
    if (run.direction == Direction::kBackward) {
      tried.backward.insert(TrialOf(run));
    } else {
      tried.forward.push_back(&run);
    }
  }
  std::set<const StoredRun*> awaiting;
  for (auto& [index, tried] : contestants) {
    std::vector<const StoredRun*> without_other;
    tried.both = directions == "both";
    for (const StoredRun* run : tried.forward) {
      if (!tried.backward.contains(TrialOf(*run))) continue;
      tried.both = tried.both || run->claimed;
    }
    for (const StoredRun* run : tried.forward) {
      if (!tried.backward.contains(TrialOf(*run)) && IsFollowed(*run, tried.both)) {
        without_other.push_back(run);
      }
    }
    if (without_other.empty()) continue;
    if (tried.backward.empty()) {
      const bool says_so =
          directions == "both" ||
          (directions == "auto" &&
           session->backward_planners.contains(PlannerOf(without_other.front()->request_id)));
      if (!says_so || without_other.front() != tried.forward.back()) continue;
    }
    awaiting.insert(without_other.begin(), without_other.end());
  }
  std::vector<StoredRun> kept;
  kept.reserve(session->runs.size());
  for (StoredRun& run : session->runs) {
    if (!awaiting.contains(&run)) kept.push_back(std::move(run));
  }
  session->runs = std::move(kept);
  return static_cast<int>(awaiting.size());
}

}  // namespace planbench
