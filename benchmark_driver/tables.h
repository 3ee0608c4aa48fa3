#pragma once

#include <string>
#include <vector>

#include "messaging/messages.h"

namespace planbench {

/// The tables printed at the end of a session, as text: success by set and planner as in the study;
/// planning times by set, planner and direction as in the study; times by phase and path quality;
/// verdicts of the mesh robot if it judged. Below a set of the study's the first two also show what
/// it published (published_study.h). Definitions stand below each table. Records may come in any
/// order.
std::string FormatTables(const std::vector<RunRecordMessage>& records);

/// How the attempts at one problem by one planner and trial ended.
struct ProblemOutcome {
  enum class Kind { kForward, kBackward, kFailure, kUnsolvable, kOther };
  Kind kind = Kind::kOther;
  bool solved_forward = false;
  bool solved_backward = false;
  double forward_time_s = 0;  ///< Planning time of the forward attempt, if made.
  double backward_time_s = 0;
  double either_time_s = 0;  ///< Of the first success, the failed attempt before it included.
};

/// Folds the forward and backward records of one problem, planner and trial (either may be null):
/// forward success counts first, then backward; unsolvable if an attempt found start or goal
/// invalid and none succeeded; failure if the attempts ran out of time, memory or search space;
/// else other (invalid path, no answer, ...).
ProblemOutcome FoldAttempts(const RunRecordMessage* forward, const RunRecordMessage* backward);

}  // namespace planbench
