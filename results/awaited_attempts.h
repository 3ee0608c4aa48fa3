#pragma once

#include "results/stored_session.h"

namespace planbench {

/// Leaves out of a session that is not complete the attempts without a confirmed path whose other
/// direction was to follow and is not recorded: what becomes of their trials is not known. Returns
/// how many. In which directions a planner is asked the session's flags tell (kEntrants); of one
/// that they do not name, as in sessions of earlier versions, nothing is left out.
int LeaveOutAwaiting(StoredSession* session);

}  // namespace planbench
