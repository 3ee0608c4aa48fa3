#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace planbench {

/// Ids of what the results database of a session folder holds: to be compared with its event log,
/// which is written first and must not lack any of it, unless it is damaged or cut off.
struct StoredIds {
  std::vector<std::string> sessions;
  std::vector<std::string> runs;  ///< Request ids.

  bool empty() const { return sessions.empty() && runs.empty(); }
  /// E.g. "3 runs, the first of them run/box/1/ara/forward/1"; of sessions where it has no runs.
  /// Not for what is empty.
  std::string Text() const;

  /// What is not among the logged sessions' run_id and the logged runs' request_id.
  template <typename Sessions, typename Runs>
  StoredIds Without(const Sessions& logged_sessions, const Runs& logged_runs) const {
    std::set<std::string> session_ids, run_ids;
    for (const auto& session : logged_sessions) session_ids.insert(session.run_id);
    for (const auto& run : logged_runs) run_ids.insert(run.request_id);
    StoredIds left = *this;
    std::erase_if(left.sessions, [&](const std::string& id) { return session_ids.contains(id); });
    std::erase_if(left.runs, [&](const std::string& id) { return run_ids.contains(id); });
    return left;
  }
};

/// Nothing if the folder has no results.sqlite, or that no table yet. To be called before the event
/// log is read, to which a logger that lives adds meanwhile. Throws InputError if it cannot be
/// read.
StoredIds ReadStoredIds(const std::filesystem::path& session_folder);

}  // namespace planbench
