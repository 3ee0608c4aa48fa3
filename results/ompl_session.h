#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "results/stored_session.h"

namespace planbench {

// Results of OMPL's benchmarks (ompl::tools::Benchmark, MoveIt's too), whether in a log
// (ompl_log_reader.h) or in a database (ompl_database.h). A planner becomes a contestant, `name` if
// there is one, else "NAME: PLANNER"; with several settings it is several, "NAME: PLANNER #2". Only
// an exact solution is a path; one that OMPL calls incorrect counts as INVALID_PATH. "solved"
// counts where it contradicts "status", which a warning tells. The problem of a run is that of its
// properties "problem set", "problem index" and "trial", if there are such; else an experiment is a
// problem: SET/3 is problem 3 of SET, any other name the first problem of a set of its own, and the
// runs of a planner are its trials. "time" is that of the whole search; planning ends with the
// first sample of the progress that has a cost, if that is earlier; without one a warning tells
// that the whole counts. Of a run that has "total time", too, as in our logs, "time" is the
// planning time.

/// Of a run, by name with '_' for spaces; those without a value are absent.
using OmplProperties = std::map<std::string, std::string>;

/// Nothing if there is none, or one that is not finite. Throws InputError for what is no number.
std::optional<double> FindNumber(const OmplProperties& properties, const std::string& name);
/// Of what is never below zero, as times and lengths are: throws for what is, too.
std::optional<double> FindAmount(const OmplProperties& properties, const std::string& name);

/// Names of a program's statuses by their numbers.
using OmplStatuses = std::map<std::int64_t, std::string>;

/// From 0.
OmplStatuses NumberStatuses(const std::vector<std::string>& names);
/// OMPL's own, which its logs name; databases may not.
OmplStatuses StatusesOfOmpl();

/// Adds what a planner told of its path while it searched, `time` and `best_cost`, if that is an
/// improvement: OMPL samples at intervals. Throws InputError for values that cannot be.
void AddProgress(const OmplProperties& sample, StoredRun* run);

/// Collects runs as a session.
class OmplSession {
 public:
  explicit OmplSession(std::string name) : name_(std::move(name)) {}

  StoredSession& session() { return session_; }

  /// Index of the contestant that a planner of such settings is.
  std::size_t Contestant(const std::string& planner, const std::string& settings);

  /// `experiment_id` tells experiments of one name apart. Throws InputError for values that cannot
  /// be, and for runs that cannot be told apart.
  StoredRun& AddRun(std::size_t contestant, std::int64_t experiment_id,
                    const std::string& experiment, double time_limit_s,
                    const OmplStatuses& statuses, const OmplProperties& properties);

  /// Its contestants have their names; what is to be said of the runs of `file` is added to
  /// `warnings`, a line each.
  StoredSession Take(const std::filesystem::path& file, std::vector<std::string>* warnings);

 private:
  /// A contestant's on a problem.
  struct Trials {
    std::map<std::pair<std::int64_t, Direction>, int> num_runs;  ///< By experiment.
    /// By experiment and what that calls them.
    std::map<std::pair<std::int64_t, int>, int> numbers;
    std::set<int> taken;  ///< Of the numbers.
    std::set<std::pair<int, Direction>> made;
  };

  /// Planning times, once all progress is there.
  void CountToFirstSolutions(const std::filesystem::path& file, std::vector<std::string>* warnings);
  void SetTrial(std::int64_t experiment_id, const OmplProperties& properties, StoredRun* run);
  void SetStatus(const OmplStatuses& statuses, const OmplProperties& properties, StoredRun* run);

  std::string name_;
  StoredSession session_;
  int num_contradictions_ = 0;
  int num_unnamed_ = 0;
  std::vector<bool> tells_total_;  ///< Of each run, whether it tells a total time, too.
  /// By contestant, set and problem.
  std::map<std::tuple<std::size_t, std::string, int>, Trials> trials_;
};

}  // namespace planbench
