#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "messaging/messages.h"
#include "results/outcomes.h"
#include "results/untold_times.h"

namespace planbench {

/// What tables show of a run. The texts are those of its RunRows and live as long.
struct RunRow {
  const std::string* problem_set = nullptr;
  const std::string* planner = nullptr;
  const std::string* contestant = nullptr;
  const std::string* planner_class = nullptr;
  const std::string* edges = nullptr;  ///< How they were checked (planning/told_edges.h).
  const std::string* message = nullptr;
  const std::string* mesh_reason = nullptr;  ///< Why the meshes do not allow the raw path.
  int problem_index = 0;
  int trial = 1;
  Direction direction = Direction::kForward;
  PlanStatus status = PlanStatus::kNoAnswer;  ///< Final, the referee's word included.
  bool asked = true;                          ///< Else it counts as missing (asked_runs.h).
  bool claimed = false;                       ///< The planner says that it found a path.
  bool trained = false;                       ///< On this very problem (training.h).
  bool needs_other = false;  ///< It failed, and the other direction is to be tried, too.
  bool disturbed = false;
  bool repeated = false;
  bool is_to_repeat = false;  ///< It gives way to the attempt that is to follow.
  OddTimesFound odd_times_s = {};
  AnswerTimes answer_times;
  std::optional<bool> mesh_valid;         ///< The raw path, if meshes judged it.
  std::optional<bool> simplified_valid;   ///< The referee's word on the simplified path.
  std::optional<bool> mesh_valid_simple;  ///< The simplified path, unless it is rejected.
  double time_s = 0;                      ///< Planning time; without an answer, the time waited.
  double time_limit_s = 0;
  std::vector<double> effort;  ///< EffortValues, of a confirmed path only.

  bool confirmed() const { return status == PlanStatus::kSolved; }
};

/// The runs of a session as its tables need them: some 200 bytes each, since equal texts are kept
/// once and the rest of a record, most of it paths, not at all.
class RunRows {
 public:
  RunRows() = default;
  RunRows(RunRows&&) = default;
  RunRows& operator=(RunRows&&) = default;

  /// In the place of the row of its run that was to give way (`is_to_repeat`), if there is one.
  const RunRow& Add(const RunRecordMessage& record, bool needs_other = false,
                    bool is_to_repeat = false);

  const std::deque<RunRow>& rows() const { return rows_; }
  std::size_t size() const { return rows_.size(); }
  bool empty() const { return rows_.empty(); }

 private:
  const std::string* Shared(const std::string& text) { return &*texts_.insert(text).first; }

  std::set<std::string> texts_;
  std::deque<RunRow> rows_;
  std::map<std::string, RunRow*> to_repeat_;  // by request id
};

}  // namespace planbench
