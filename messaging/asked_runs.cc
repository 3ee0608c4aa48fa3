#include "messaging/asked_runs.h"

#include "planning/asked_request.h"

namespace planbench {

bool WasAsked(const RunRecordMessage& run) {
  return TellsOfRequest(run.roundtrip_time_s, run.status, !run.request.scene_id.empty());
}

bool Suffices(const RunRecordMessage& forward) {
  return forward.result.result.Solves() || !WasAsked(forward);
}

RunStanding StandingOf(const RunRecordMessage& run) { return {WasAsked(run), run.start_utime}; }

bool Replaces(const RunStanding& record, const RunStanding& known) {
  return !known.was_asked && (record.was_asked || record.start_utime > known.start_utime);
}

bool Replaces(const RunRecordMessage& record, const RunRecordMessage& known) {
  return Replaces(StandingOf(record), StandingOf(known));
}

bool Contradicts(const RunStanding& record, const RunStanding& known) {
  return record.was_asked && known.was_asked;
}

bool Contradicts(const RunRecordMessage& record, const RunRecordMessage& known) {
  return Contradicts(StandingOf(record), StandingOf(known));
}

}  // namespace planbench
