#pragma once

#include "results/stored_session.h"

namespace planbench {

/// Leaves out of a session that is not complete the attempts without a confirmed path whose other
/// direction was to follow and is not recorded: what becomes of their trials is not known. Returns
/// how many. In which directions a planner is asked for a trial the session's plan tells
/// (results/session_plan.h); without one, as in sessions of earlier versions, nothing is left out.
/// Throws InputError for a plan that cannot be read.
int LeaveOutAwaiting(StoredSession* session);

}  // namespace planbench
