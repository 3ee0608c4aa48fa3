#include "results/imported_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <set>
#include <utility>

#include "common/error.h"
#include "results/csv_results.h"
#include "results/ompl_results.h"

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

}  // namespace

StoredSession ImportResults(const std::filesystem::path& file, const std::string& name,
                            double time_limit_s) {
  const std::string beginning = Beginning(file);
  StoredSession session;
  if (beginning.starts_with("SQLite format 3")) {
    session = ReadOmplDatabase(file, name);
  } else if (beginning.starts_with("Experiment ") ||
             beginning.find("\nExperiment ") != std::string::npos) {
    session = ReadOmplLog(file, name);
  } else {
    session = ReadCsvResults(file, name, time_limit_s);
  }
  if (session.runs.empty()) throw InputError(file.string() + ": no results");
  session.file = file;
  session.run_id = file.filename().string();
  session.imported = session.described = session.finished = true;
  session.num_runs = static_cast<int>(session.runs.size());
  for (StoredRun& run : session.runs) {
    if (run.time_limit_s == 0) run.time_limit_s = time_limit_s;
    run.roundtrip_time_s = run.time_s.value_or(run.time_limit_s);
  }
  return session;
}

void KeepProblemsOf(const std::vector<StoredSession>& sessions, StoredSession* imported) {
  std::set<std::pair<std::string, int>> problems;
  std::set<std::string> sets, own_sets;
  for (const StoredSession& session : sessions) {
    for (const StoredRun& run : session.runs) {
      problems.emplace(run.problem_set, run.problem_index);
      sets.insert(run.problem_set);
    }
  }
  for (const StoredRun& run : imported->runs) own_sets.insert(run.problem_set);
  std::erase_if(imported->runs, [&](const StoredRun& run) {
    return !problems.contains({run.problem_set, run.problem_index});
  });
  if (!imported->runs.empty()) return;
  throw InputError(fmt::format(
      "{}: none of its problems is among those of the sessions; sets here: {}; there: {}",
      imported->file.string(), fmt::join(own_sets, ", "), fmt::join(sets, ", ")));
}

}  // namespace planbench
