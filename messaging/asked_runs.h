#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "messaging/messages.h"

namespace planbench {

/// Whether a request of the run was sent. A run that was not (its planner had been given up, or had
/// come back as another; its problem could not be had), or whose path the scene server gave no
/// verdict on, has a record that says why, and counts as missing: no figure counts it, the session
/// is not finished without, --resume makes it unless it IsUnjudgeable.
bool WasAsked(const RunRecordMessage& run);
/// Of one without a verdict, whether the scene server refused it, as it would in a session that is
/// resumed: the referee's step, which is a condition, is too fine for its path.
bool IsUnjudgeable(const RunRecordMessage& run);

/// Whether a backward search that is to be made only if this forward one found no path is not made:
/// the planner claims one, or could not be asked, so that nobody knows yet whether it is needed.
bool Suffices(const RunRecordMessage& forward);

/// Of a run's record, what tells which of several stands.
struct RunStanding {
  bool was_asked = false;
  std::int64_t start_utime = 0;  ///< us since the Unix epoch.
  bool disturbed = false;
  int repeats = 0;  ///< Which repeat it is of an attempt that was disturbed; 0: none.
};
RunStanding StandingOf(const RunRecordMessage& run);

/// Whether a session of such flags makes disturbed runs again (--repeat-disturbed).
bool RepeatsDisturbed(const std::map<std::string, std::string>& flags);
/// Whether such a session is to make another attempt in this one's place, as it does twice at most:
/// it is not finished without.
bool OwesRepeat(const RunStanding& attempt);

/// What a record's acknowledgement names it by: one of a disturbed attempt is none of its repeat.
std::string RunRecordAckId(const RunRecordMessage& run);
/// Likewise of a session: one of its beginning is none of its end. RUN_ID@SECONDS, the time when it
/// stood so.
std::string SessionAckId(const SessionMessage& session);

/// A run has one record. Of two that differ the first stands, but for this: whether `record` stands
/// in the place of `known`, which tells of no request, since it tells of one or, of none either, of
/// a later attempt; or which was disturbed, since it is of a later repeat. The other way round
/// `record` is to be passed over.
bool Replaces(const RunStanding& record, const RunStanding& known);

/// Whether two records of a run that differ cannot both be true: each tells of a request, and
/// neither of a repeat of the other.
bool Contradicts(const RunStanding& record, const RunStanding& known);

}  // namespace planbench
