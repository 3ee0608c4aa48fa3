#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "benchmark_driver/run_rows.h"
#include "messaging/messages.h"
#include "results/outcomes.h"

namespace planbench {

/// What a session ends with, as text.
struct SessionTables {
  /// For a terminal, at most kTextWidth wide: success and planning times by set and contestant,
  /// contestants against the first one, what the mesh robot says, and what failed.
  std::string brief;
  /// Everything: also times by direction, effort and quality, all pairs, every failed run.
  std::string full;
};

/// Tables of the runs, which may come in any order; contestants in that of the conditions.
/// Beside a contestant that asks for it stand the figures that the study published
/// (published_study.h). Runs that were to be made and have no record (`num_missing`), those that
/// were not asked for (messaging/asked_runs.h), which no table has either, and problems that were
/// left out (SessionMessage::left_out), are told of before everything else; of those that are
/// missing, how many an earlier call was to make and this one is not (`num_owed`). Where disturbed
/// runs are told of, so is how many are still to be made again (`num_to_repeat`); before the tables
/// it stands how many problems a planner's process had (`problems_per_process`), if not all, and
/// below what the mesh robot says in what it is another one (`referee_misfits`).
/// Definitions stand below each table and in docs/lineups.md.
SessionTables MakeTables(const SessionConditions& conditions, const RunRows& runs,
                         const std::vector<Attempt>& references = {}, int num_missing = 0,
                         const std::map<std::string, std::string>& left_out = {}, int num_owed = 0,
                         int num_to_repeat = 0, std::optional<int> problems_per_process = {},
                         const std::string& referee_misfits = "");

}  // namespace planbench
