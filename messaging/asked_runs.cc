#include "messaging/asked_runs.h"

namespace planbench {

bool WasAsked(const RunRecordMessage& run) {
  // A request that was sent took time, whatever came of it; of a refusal older sessions do not tell
  // how much.
  const bool took_time = run.roundtrip_time_s > 0;
  return took_time || (run.status != PlanStatus::kNoAnswer && !run.request.scene_id.empty());
}

RunStanding StandingOf(const RunRecordMessage& run) { return {WasAsked(run), run.start_utime}; }

bool Replaces(const RunStanding& record, const RunStanding& known) {
  return !known.was_asked && (record.was_asked || record.start_utime > known.start_utime);
}

bool Replaces(const RunRecordMessage& record, const RunRecordMessage& known) {
  return Replaces(StandingOf(record), StandingOf(known));
}

bool Contradicts(const RunRecordMessage& record, const RunRecordMessage& known) {
  return WasAsked(record) && WasAsked(known);
}

}  // namespace planbench
