#pragma once

#include <string>
#include <vector>

#include "tests/support/session_database.h"

namespace planbench {

/// Names that a page, a script or a table could take for something else.
inline constexpr char kTagName[] = "<b class=evil>\"A\" & 'B'</b>";
inline constexpr char kScriptName[] = "</script><script>alert(1)</script>";

/// Two sets of twelve and six problems. kTagName solves all, in 1 + index / 10 s, with two trials
/// on the first set; kScriptName takes twice as long on the first set and fails at its last two
/// problems; on the second it is rejected once.
inline std::vector<MadeRun> ExampleRuns() {
  std::vector<MadeRun> runs;
  for (int problem = 1; problem <= 12; ++problem) {
    const double time_s = 1 + problem / 10.0;
    runs.push_back({.contestant = kTagName, .problem = problem, .time_s = time_s});
    runs.push_back({.contestant = kTagName, .problem = problem, .trial = 2, .time_s = time_s});
    const bool fails = problem > 10;
    runs.push_back({.contestant = kScriptName,
                    .problem = problem,
                    .status = fails ? PlanStatus::kTimedOut : PlanStatus::kSolved,
                    .time_s = fails ? 10 : 2 * time_s,
                    .reason = fails ? "the time limit came" : "",
                    .length = 4});
  }
  for (int problem = 1; problem <= 6; ++problem) {
    const double time_s = 1 + problem / 10.0;
    runs.push_back(
        {.contestant = kTagName, .set = "a<i>set</i>", .problem = problem, .time_s = time_s});
    const bool rejected = problem == 6;
    runs.push_back({.contestant = kScriptName,
                    .set = "a<i>set</i>",
                    .problem = problem,
                    .status = rejected ? PlanStatus::kInvalidPath : PlanStatus::kSolved,
                    .time_s = 4,
                    .reason = rejected ? "hits <board>" : ""});
  }
  return runs;
}

/// Flags and origin of the example's session.
inline SessionMessage ExampleSession() {
  SessionMessage session;
  session.version = "1.2";
  session.commit = "abc123";
  session.cpu = "Fast CPU";
  session.conditions.request.seed = 7;
  session.settings = {{"time", "10"}, {"trials", "2"}, {"launch", "true"}};
  return session;
}

}  // namespace planbench
