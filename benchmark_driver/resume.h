#pragma once

#include <filesystem>
#include <vector>

#include "messaging/messages.h"

namespace planbench {

/// What a session folder holds of the session to go on with.
struct EarlierSession {
  std::vector<SessionMessage> sessions;  ///< Of each time it was begun or resumed; one at least.
  std::vector<RunRecordMessage> runs;
};

/// Reads the last session of a folder's only .lcmlog. Throws InputError if there is none, or
/// several, or no session in it.
EarlierSession ReadEarlierSession(const std::filesystem::path& session_folder);

/// A session can be given more sets, problems, planners, directions or trials when it is resumed,
/// but nothing else that can change a result (messaging/session_conditions.h): its tables would
/// compare what is not alike. Throws InputError with the first field that differs, before and now.
void RequireSameConditions(const SessionMessage& before, const SessionMessage& now);

}  // namespace planbench
