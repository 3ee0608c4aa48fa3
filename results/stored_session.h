#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planning/path_measures.h"
#include "planning/plan_result.h"
#include "planning/plan_status.h"
#include "results/outcomes.h"
#include "results/reason_count.h"

namespace planbench {

/// A run as a results database holds it (docs/database.md).
struct StoredRun {
  std::int64_t id = 0;         ///< `runs.id`; of a CSV file, the line.
  std::size_t contestant = 0;  ///< Index into those of its session.
  std::string request_id;
  std::string problem_set;
  int problem_index = 0;
  std::string scene_id;  ///< "" if it is not told.
  int trial = 1;
  Direction direction = Direction::kForward;
  PlanStatus status = PlanStatus::kNoAnswer;  ///< Final, the referee's word included.
  bool claimed = false;
  std::string message;           ///< Why it is not solved.
  std::string referee_reason;    ///< Why its path is not valid, or is not judged.
  std::optional<double> time_s;  ///< Planning time; nothing if no answer came.
  OddTimesFound odd_times_s = {};
  double total_time_s = 0;      ///< To the end of the search; planning time where not told.
  double roundtrip_time_s = 0;  ///< By the driver's clock.
  double time_limit_s = 0;      ///< Of the request.
  PhaseTimes phases;            ///< Zero where nothing is told.
  MeasuredValues measures;      ///< Of the raw path, finite ones.
  std::optional<bool> simplified_valid;   ///< The referee's word on the simplified path.
  MeasuredValues measures_simple;         ///< Of the simplified path, unless it is rejected.
  std::optional<bool> mesh_valid;         ///< The raw path, judged with the robot's meshes.
  std::string mesh_reason;                ///< Why they do not allow it.
  std::optional<double> mesh_depth_m;     ///< Of the contact that they do not allow.
  std::optional<bool> mesh_valid_simple;  ///< The simplified path, unless it is rejected.
  double configurations_checked = 0;      ///< By the planner; 0 if it does not tell.
  std::vector<PlanProgress> progress;     ///< Improved solutions of an anytime planner, in order.

  // What other work on the machine did to it; nothing in sessions of earlier versions.
  std::optional<double> load_before;
  std::optional<double> waiting_s;  ///< Of the planner for a processor.
  std::optional<double> steal_s;    ///< By the hypervisor.
  bool disturbed = false;           ///< Beyond the session's limit.
  int repeats = 0;                  ///< Earlier attempts that were.

  bool confirmed() const { return status == PlanStatus::kSolved; }

  /// Takes the referee's word on the simplified path, after all that was measured of it: of a
  /// rejected one nothing counts.
  void JudgeSimplified(bool valid);
};

/// A planner under one name with one set of settings.
struct StoredContestant {
  std::string name;
  std::string settings;  ///< "key = value", one a line.
};

/// Such settings, by key; lines of other forms are left out. Of a key the first: what the session
/// asked for stands before what a planner calls its settings.
std::map<std::string, std::string> ParseSettings(const std::string& settings);

/// What was odd on the bus while a session folder was written, as its logger tells.
struct BusRecord {
  std::int64_t malformed = 0;       ///< Packets that are none of LCM's.
  std::int64_t lost = 0;            ///< Messages that did not reach the logger (whole).
  std::int64_t dropped = 0;         ///< Messages that it had no room for.
  std::int64_t contradictions = 0;  ///< Messages that told otherwise than those believed.
  std::int64_t parts_not_told = 0;  ///< Event logs beside, of which none of this is known.
};

/// A session, complete or not.
struct StoredSession {
  std::filesystem::path file;
  std::string run_id;
  bool imported = false;   ///< From elsewhere (imported_results.h): nobody judged its paths.
  bool is_csv = false;     ///< From a CSV file.
  bool described = false;  ///< The session's own message was stored: what follows is known.
  bool finished = false;
  double total_time_s = 0;
  int num_runs = 0;  ///< As planned.
  std::string version, commit, host, cpu, date, seed, robot;
  std::map<std::string, std::string> flags;     ///< Of the driver.
  std::map<std::string, std::string> left_out;  ///< Problems without runs, and why.
  std::map<std::string, std::string> machine;   ///< What the driver says of its own.
  std::vector<std::string> warnings;            ///< Of told_warnings.h.
  std::optional<BusRecord> bus;                 ///< Of its folder; nothing if that does not tell.

  std::vector<StoredContestant> contestants;
  std::vector<StoredRun> runs;
  /// Records of runs that were not asked for (planning/asked_request.h): these are missing, and not
  /// among `runs`.
  int num_not_asked = 0;
  int num_unjudgeable = 0;  ///< Of them those that no resumed session makes (WhatMakesThem).
  ReasonCount why_not_asked;
  /// How many runs are of a contestant that the session does not have, by its name as it stands:
  /// their records are damaged, and they are not among `runs` either.
  std::map<std::string, int> strangers;
};

struct StoredSessions {
  std::vector<StoredSession> sessions;  ///< By their beginning.
  int num_foreign_runs = 0;  ///< Appended to the database by other programs; they are left out.
};

/// All that a session folder's results.sqlite, or such a file itself, holds; also while a logger
/// writes it, and of earlier versions, whose columns are read as far as there are any. Throws
/// InputError with one line that names the file if it is missing, damaged, empty, or no results
/// database. `only_run`: of runs that of this id alone.
StoredSessions ReadSessions(const std::filesystem::path& folder_or_file,
                            std::optional<std::int64_t> only_run = {});

}  // namespace planbench
