#include "results/imported_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "common/error.h"
#include "results/csv_results.h"
#include "results/ompl_database.h"
#include "results/ompl_log_reader.h"
#include "results/outcomes.h"

namespace planbench {
namespace {

std::string Beginning(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(400, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  if (stream.bad() || !stream.is_open()) throw InputError("cannot read " + file.string());
  return bytes;
}

/// Of what the file calls solved, what would not be here is not. `warnings` gets a line for each
/// kind.
void JudgeTimes(const std::string& file, std::vector<StoredRun>* runs,
                std::vector<std::string>* warnings) {
  int num_late = 0, num_untold = 0;
  for (StoredRun& run : *runs) {
    if (!run.confirmed()) continue;
    const bool has_limit = run.time_limit_s > 0;
    if (!run.time_s) {
      run.status = PlanStatus::kTimedOut;
      run.message = "solved, but in a time that is not told";
      ++num_untold;
    } else if (has_limit && IsLate(*run.time_s, run.time_limit_s)) {
      run.status = PlanStatus::kTimedOut;
      run.message = fmt::format("solved after {} s, beyond the time limit of {} s", *run.time_s,
                                run.time_limit_s);
      ++num_late;
    } else if (has_limit) {
      const double overrun_s = run.total_time_s - run.time_limit_s;
      if (overrun_s > kMuchTime_s) run.odd_times_s[kOverrunIndex] = overrun_s;
      run.time_s = std::min(*run.time_s, run.time_limit_s);
    }
  }
  const auto tell = [&](int number, const char* one, const char* several) {
    if (number == 0) return;
    warnings->push_back(
        fmt::format("{}: {} solved {} as TIMED_OUT", file, number, number == 1 ? one : several));
  };
  tell(num_late, "run took longer than its time limit and counts",
       "runs took longer than their time limits and count");
  tell(num_untold, "run has no time and counts", "runs have no time and count");
}

/// Index of the contestant of that name, which is added if there is none.
std::size_t ContestantOf(const StoredContestant& contestant, StoredSession* session) {
  std::vector<StoredContestant>& known = session->contestants;
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const auto& one) { return one.name == contestant.name; });
  if (found == known.end()) {
    known.push_back(contestant);
    return known.size() - 1;
  }
  if (found->settings.find(contestant.settings) == std::string::npos) {
    found->settings += contestant.settings;
  }
  return static_cast<std::size_t>(found - known.begin());
}

/// Its files are those of both.
void Append(StoredSession more, StoredSession* session) {
  std::vector<std::size_t> contestants;
  for (const StoredContestant& one : more.contestants) {
    contestants.push_back(ContestantOf(one, session));
  }
  for (StoredRun& run : more.runs) {
    run.contestant = contestants[run.contestant];
    session->runs.push_back(std::move(run));
  }
  session->num_runs += more.num_runs;
  session->run_id += ", " + more.run_id;
  session->file.replace_filename(session->run_id);
}

}  // namespace

StoredSession ImportResults(const std::filesystem::path& file, const std::string& name,
                            double time_limit_s, std::vector<std::string>* warnings) {
  const std::string beginning = Beginning(file);
  StoredSession session;
  if (beginning.starts_with("SQLite format 3")) {
    session = ReadOmplDatabase(file, name, warnings);
  } else if (beginning.starts_with("Experiment ") ||
             beginning.find("\nExperiment ") != std::string::npos) {
    session = ReadOmplLog(file, name, warnings);
  } else {
    session = ReadCsvResults(file, name);
  }
  if (session.runs.empty()) throw InputError(file.string() + ": no results");
  session.file = file;
  session.run_id = file.filename().string();
  session.imported = session.described = session.finished = true;
  session.num_runs = static_cast<int>(session.runs.size());
  for (StoredRun& run : session.runs) {
    if (run.time_limit_s == 0) run.time_limit_s = time_limit_s;
  }
  JudgeTimes(file.string(), &session.runs, warnings);
  for (StoredRun& run : session.runs) {
    run.roundtrip_time_s = run.time_s.value_or(run.time_limit_s);
  }
  return session;
}

ProblemsBySet ProblemsOf(const std::vector<StoredSession>& sessions) {
  ProblemsBySet problems;
  for (const StoredSession& session : sessions) {
    for (const StoredRun& run : session.runs) problems[run.problem_set].insert(run.problem_index);
  }
  return problems;
}

void KeepProblems(const ProblemsBySet& problems, StoredSession* imported,
                  std::vector<std::string>* warnings) {
  const auto is_other = [&](const StoredRun& run) {
    const auto set = problems.find(run.problem_set);
    return set == problems.end() ||
           (!set->second.empty() && !set->second.contains(run.problem_index));
  };
  std::vector<StoredRun>& runs = imported->runs;
  const auto first = std::find_if(runs.begin(), runs.end(), is_other);
  if (first == runs.end()) return;
  const std::string file = imported->file.string();
  const std::string place = imported->is_csv ? fmt::format("{}:{}", file, first->id) : file;
  const std::string problem =
      fmt::format("problem {} of '{}'", first->problem_index, first->problem_set);
  const std::size_t num_all = runs.size();
  std::set<std::string> sets, own_sets;
  for (const auto& [set, indices] : problems) sets.insert(set);
  for (const StoredRun& run : runs) own_sets.insert(run.problem_set);
  std::erase_if(runs, is_other);
  imported->num_runs = static_cast<int>(runs.size());
  if (runs.empty()) {
    throw InputError(
        fmt::format("{}: none of its problems is among the session's; sets here: {}; there: {}",
                    file, fmt::join(own_sets, ", "), fmt::join(sets, ", ")));
  }
  warnings->push_back(
      fmt::format("{}: {} is none of the session's; {} of {} results are of such problems, and "
                  "count nowhere",
                  place, problem, num_all - runs.size(), num_all));
}

std::vector<StoredSession> JoinImports(const std::vector<std::string>& names,
                                       std::vector<StoredSession> imported) {
  std::map<std::string, std::size_t> places;
  std::vector<StoredSession> joined;
  std::set<std::tuple<std::string, std::string, int, int, Direction>> seen;
  for (std::size_t i = 0; i < imported.size(); ++i) {
    StoredSession& session = imported[i];
    for (const StoredRun& run : session.runs) {
      const std::string& name = session.contestants[run.contestant].name;
      if (seen.emplace(name, run.problem_set, run.problem_index, run.trial, run.direction).second) {
        continue;
      }
      throw InputError(
          fmt::format("{}: '{}' has problem {} of '{}', trial {}, {}, from another file, too: "
                      "number the trials or give it another name",
                      session.file.string(), name, run.problem_index, run.problem_set, run.trial,
                      EnumName(run.direction)));
    }
    const auto [place, is_new] = places.try_emplace(names[i], joined.size());
    if (is_new) {
      joined.push_back(std::move(session));
    } else {
      Append(std::move(session), &joined[place->second]);
    }
  }
  return joined;
}

void RequireOtherNames(const std::set<std::string>& contestants,
                       const std::vector<StoredSession>& imported) {
  for (const StoredSession& session : imported) {
    for (const StoredContestant& one : session.contestants) {
      if (!contestants.contains(one.name)) continue;
      throw InputError(session.file.string() + ": a contestant is called '" + one.name +
                       "', too: give the results another name");
    }
  }
}

}  // namespace planbench
