#include "benchmark_driver/resume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>

#include "common/error.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/record_log.h"

namespace planbench {
namespace {

std::filesystem::path EventLogOf(const std::filesystem::path& session_folder) {
  try {
    return FindEventLog(session_folder);
  } catch (const InputError& error) {
    throw InputError(std::string("--resume: ") + error.what());
  }
}

/// `session` without what may differ from `other`.
SessionMessage Comparable(SessionMessage session, const SessionMessage& other) {
  session.start_utime = 0;
  session.finished = false;
  session.total_time_s = 0;
  session.num_runs = 0;
  session.host = session.cpu = "";
  session.settings.clear();  // the flags: what they change is in the conditions
  const auto keep_common = [](auto* map, const auto& others) {
    std::erase_if(*map, [&](const auto& entry) { return !others.contains(entry.first); });
  };
  keep_common(&session.conditions.problem_sets, other.conditions.problem_sets);
  std::erase_if(session.conditions.contestants, [&](const Contestant& contestant) {
    const auto& others = other.conditions.contestants;
    return std::none_of(others.begin(), others.end(),
                        [&](const Contestant& o) { return o.planner == contestant.planner; });
  });
  std::sort(session.conditions.contestants.begin(), session.conditions.contestants.end(),
            [](const auto& a, const auto& b) { return a.planner < b.planner; });

  std::erase_if(session.nodes, [&](const NodeStatusMessage& node) {
    if (node.kind == NodeKind::kSceneServer) return false;
    return node.kind != NodeKind::kPlanner ||
           std::none_of(other.nodes.begin(), other.nodes.end(),
                        [&](const auto& o) { return o.kind == node.kind && o.name == node.name; });
  });
  std::sort(session.nodes.begin(), session.nodes.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  for (NodeStatusMessage& node : session.nodes) {
    node.utime = node.start_utime = 0;
    node.busy = false;
    node.request_id = node.host = "";
    node.pid = 0;
    if (node.kind == NodeKind::kSceneServer) {
      node.name = "scene server";  // there is one
      node.settings.clear();       // the folders it was given; what is in them has ids
    }
  }
  return session;
}

/// Every field as text, by its place: "node[ara].setting[tip_guide].value".
std::map<std::string, std::string> FieldsOf(const SessionMessage& session) {
  std::map<std::string, std::string> fields;
  std::vector<std::string> place;  // of structs, the outermost first
  std::istringstream lines(Print<SessionMessage>(Encode(session), channel::kSession));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t depth = line.find_first_not_of(' ') / 2;
    const std::size_t colon = line.find(':');
    const std::string name = line.substr(2 * depth, colon - 2 * depth);
    place.resize(depth);
    if (colon + 1 == line.size()) {
      place.push_back(name);
      continue;
    }
    const std::string value = line.substr(colon + 2);
    // Elements of lists go by their key, if they have one.
    const bool is_key = name == "name" || name == "key" || name == "planner";
    if (is_key && !place.empty() && std::isdigit(place.back()[place.back().find('[') + 1]) != 0) {
      place.back().replace(place.back().find('[') + 1, std::string::npos,
                           value.substr(1, value.size() - 2) + "]");
      continue;
    }
    if (name == "utime") continue;  // of the moment
    fields[fmt::format("{}{}{}", fmt::join(place, "."), place.empty() ? "" : ".", name)] = value;
  }
  return fields;
}

}  // namespace

EarlierSession ReadEarlierSession(const std::filesystem::path& session_folder) {
  RecordedSession recorded = ReadRecords(EventLogOf(session_folder));
  if (recorded.sessions.empty()) {
    throw InputError("--resume: " + session_folder.string() + " holds no session");
  }
  const std::string run_id = recorded.sessions.back().run_id;
  std::erase_if(recorded.sessions, [&](const auto& session) { return session.run_id != run_id; });
  std::erase_if(recorded.runs, [&](const auto& run) { return run.run_id != run_id; });
  return {std::move(recorded.sessions), std::move(recorded.runs)};
}

void RequireSameConditions(const SessionMessage& before, const SessionMessage& now) {
  std::map<std::string, std::string> fields_before = FieldsOf(Comparable(before, now));
  std::map<std::string, std::string> fields_now = FieldsOf(Comparable(now, before));
  const auto require_same = [&](const std::string& field) {
    const auto text = [&](const auto& fields) {
      const auto found = fields.find(field);
      return found == fields.end() ? "nothing" : found->second;
    };
    if (text(fields_before) == text(fields_now)) return;
    throw InputError(fmt::format("--resume: {} was {} when the session was begun and is {} now",
                                 field, text(fields_before), text(fields_now)));
  };
  for (const auto& [field, value] : fields_before) require_same(field);
  for (const auto& [field, value] : fields_now) require_same(field);
}

}  // namespace planbench
