#include "benchmark_driver/run_rows.h"

#include "benchmark_driver/effort_table.h"
#include "common/lookup.h"
#include "messaging/asked_runs.h"
#include "planning/told_edges.h"
#include "results/training.h"

namespace planbench {

const RunRow& RunRows::Add(const RunRecordMessage& record, bool needs_other, bool is_to_repeat) {
  const PlanResult& result = record.result.result;
  const auto counter = [&](const char* name) { return Lookup(result.counters, name).value_or(0); };
  const auto& mesh_verdict = record.path_check.mesh_verdict;
  const auto before = to_repeat_.extract(record.request_id);
  RunRow& row = before ? *before.mapped() : rows_.emplace_back();
  row = RunRow();
  if (is_to_repeat) to_repeat_[record.request_id] = &row;
  row.problem_set = Shared(record.problem_set);
  row.planner = Shared(record.planner);
  row.contestant = Shared(record.contestant);
  row.planner_class = Shared(record.planner_class);
  row.edges = Shared(
      DescribeEdges(record.request.edge_check, record.request.edge_resolution_m, record.settings));
  row.trained = Training(record.settings).Includes(record.problem_set, record.request.scene_id);
  row.message = Shared(record.message);
  row.problem_index = record.problem_index;
  row.trial = record.trial;
  row.direction = record.request.direction;
  row.status = record.status;
  row.asked = WasAsked(record);
  row.claimed = result.Solves();
  row.needs_other = needs_other;
  row.disturbed = counter("disturbed") > 0;
  row.repeated = counter("repeats") > 0;
  row.is_to_repeat = is_to_repeat;
  for (std::size_t i = 0; i < kNumOddTimes; ++i) {
    row.odd_times_s[i] = counter(kOddTimes[i].counter);
  }
  row.answer_times = {.status = record.status,
                      .told_s = result.total_time_s + result.phases.simplification_s,
                      .roundtrip_s = record.roundtrip_time_s,
                      .waited_s = counter("waiting_time") + counter("steal_time")};
  if (mesh_verdict) row.mesh_valid = mesh_verdict->valid;
  row.mesh_reason = Shared(mesh_verdict ? mesh_verdict->reason : "");
  const PathCheckReplyMessage& simplified = record.simplified_check;
  if (simplified.verdict) row.simplified_valid = simplified.verdict->valid;
  if (simplified.mesh_verdict && row.simplified_valid.value_or(true)) {
    row.mesh_valid_simple = simplified.mesh_verdict->valid;
  }
  row.time_s =
      record.status == PlanStatus::kNoAnswer ? record.roundtrip_time_s : result.planning_time_s;
  row.time_limit_s = record.request.time_limit_s;
  if (row.confirmed()) row.effort = EffortValues(record);
  return row;
}

}  // namespace planbench
