#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace planbench {

/// Makes one session of parts of it, sessions measured under equal conditions
/// (messaging/session_conditions.h): a session folder `out` that holds their scenes and run records
/// under the run id of the part that was begun first, and that can be read and resumed like any
/// other, also merged again. What the parts took and what run.json tells of their buses is added
/// up. What several folders tell of alike, a run or a whole part, counts once. Returns what was
/// merged, in a line. Throws InputError in one line if conditions differ (naming the field), if two
/// parts tell of a run differently, or if a folder cannot be read or `out` not be written.
std::string MergeSessions(const std::vector<std::string>& session_folders,
                          const std::filesystem::path& out);

}  // namespace planbench
