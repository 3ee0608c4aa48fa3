#include "messaging/asked_runs.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/lookup.h"
#include "planning/asked_request.h"

namespace planbench {
namespace {

/// How often a run is made again because it was disturbed.
constexpr int kMostRepeats = 2;

}  // namespace

bool WasAsked(const RunRecordMessage& run) {
  return TellsOfRequest(run.roundtrip_time_s, run.status, !run.request.scene_id.empty());
}

bool IsUnjudgeable(const RunRecordMessage& run) {
  return !WasAsked(run) && !run.path_check.message.empty();
}

bool Suffices(const RunRecordMessage& forward) {
  return forward.result.result.Solves() || !WasAsked(forward);
}

RunStanding StandingOf(const RunRecordMessage& run) {
  const auto counter = [&](const char* name) {
    return Lookup(run.result.result.counters, name).value_or(0);
  };
  constexpr double kMost = 1e6;  // of a damaged record
  return {WasAsked(run), run.start_utime, counter("disturbed") > 0,
          static_cast<int>(std::clamp(counter("repeats"), 0.0, kMost))};
}

bool RepeatsDisturbed(const std::map<std::string, std::string>& flags) {
  return Lookup(flags, "repeat-disturbed") == "true";
}

bool OwesRepeat(const RunStanding& attempt) {
  return attempt.disturbed && attempt.repeats < kMostRepeats;
}

std::string RunRecordAckId(const RunRecordMessage& run) {
  const int repeats = StandingOf(run).repeats;
  return repeats == 0 ? run.request_id : fmt::format("{}#{}", run.request_id, repeats);
}

std::string SessionAckId(const SessionMessage& session) {
  return fmt::format("{}@{:.6f}", session.run_id, session.total_time_s);
}

bool Replaces(const RunStanding& record, const RunStanding& known) {
  if (!known.was_asked) return record.was_asked || record.start_utime > known.start_utime;
  return record.was_asked && known.disturbed && record.repeats > known.repeats;
}

bool Contradicts(const RunStanding& record, const RunStanding& known) {
  return record.was_asked && known.was_asked && !Replaces(record, known) &&
         !Replaces(known, record);
}

}  // namespace planbench
