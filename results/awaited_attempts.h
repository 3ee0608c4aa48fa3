#pragma once

#include "results/stored_session.h"

namespace planbench {

/// Leaves out of a session that is not complete the attempts from start to goal that found nothing
/// while the one from goal to start, which was to follow, is not recorded: what becomes of their
/// trials is not known. Returns how many. A contestant's directions are no part of a session's
/// message: it tries both if it has done so, or, with none that failed so far but its last attempt,
/// if the session's flag and its planner say so.
int LeaveOutAwaiting(StoredSession* session);

}  // namespace planbench
