#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "messaging/messages.h"

namespace planbench {

/// What sessions took and what they lost on the bus, to be added up when they are merged. Each has
/// a share, by its run id, and so does what a merged session went on with, so that whatever is
/// given twice, or is in a merged session too, counts once.
class SessionShares {
 public:
  /// Of a session folder: the messages that its log holds of sessions, and what its run.json tells
  /// of the bus (results/bus_json.h; nothing: there is none). Throws InputError if a merged session
  /// does not tell of its parts as Text does.
  void Add(const std::vector<SessionMessage>& told, const std::optional<std::string>& bus);

  double total_time_s() const;
  /// Of all, as in run.json.
  std::string bus() const;

  /// Of a session's flags: the run ids of those that it was merged of, before it was resumed
  /// if it was. Throws
  /// InputError if they do not tell of its parts as Text does.
  static std::set<std::string> MergedRunIds(const std::map<std::string, std::string>& flags);

  /// All of them in one line, for the merged session's setting kMergedParts.
  std::string Text() const;

 private:
  struct Share {
    double total_time_s = 0;
    std::string bus;
  };

  static std::map<std::string, Share> Parse(const std::string& text);
  void Keep(const std::string& id, const Share& share);

  std::map<std::string, Share> by_id_;
};

}  // namespace planbench
