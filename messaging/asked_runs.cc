#include "messaging/asked_runs.h"

namespace planbench {

bool WasAsked(const RunRecordMessage& run) {
  // A request that was sent took time, whatever came of it; of a refusal older sessions do not tell
  // how much.
  const bool took_time = run.roundtrip_time_s > 0;
  return took_time || (run.status != PlanStatus::kNoAnswer && !run.request.scene_id.empty());
}

bool Replaces(const RunRecordMessage& record, const RunRecordMessage& known) {
  return !WasAsked(known) && (WasAsked(record) || record.start_utime > known.start_utime);
}

}  // namespace planbench
