#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace planbench {

/// Ids of what the results database of a session folder holds: to be compared with its event log,
/// which is written first and must not lack any of it, unless it is damaged or cut off.
struct StoredIds {
  struct RunId {
    std::string request_id;
    int repeats = 0;  ///< RunStanding's (messaging/asked_runs.h).
  };
  std::vector<std::string> sessions;
  std::vector<RunId> runs;

  bool empty() const { return sessions.empty() && runs.empty(); }
  /// E.g. "3 runs, the first of them run/box/1/ara/forward/1 (repeat 2)"; of sessions where it has
  /// no runs. Not for what is empty.
  std::string Text() const;

  /// What is not among the logged sessions (SessionMessage) and runs (RecordedRun), of which a
  /// later repeat covers those before.
  template <typename Sessions, typename Runs>
  StoredIds Without(const Sessions& logged_sessions, const Runs& logged_runs) const {
    std::set<std::string> session_ids;
    std::map<std::string, int> last_repeats;  // by request id
    for (const auto& session : logged_sessions) session_ids.insert(session.run_id);
    for (const auto& run : logged_runs) {
      int& last = last_repeats[run.request_id];
      last = std::max(last, run.standing.repeats);
    }
    StoredIds left = *this;
    std::erase_if(left.sessions, [&](const std::string& id) { return session_ids.contains(id); });
    std::erase_if(left.runs, [&](const RunId& run) {
      const auto last = last_repeats.find(run.request_id);
      return last != last_repeats.end() && run.repeats <= last->second;
    });
    return left;
  }
};

/// Nothing if the folder has no results.sqlite, or that no table yet. To be called before the event
/// log is read, to which a logger that lives adds meanwhile. Throws InputError if it cannot be
/// read.
StoredIds ReadStoredIds(const std::filesystem::path& session_folder);

}  // namespace planbench
