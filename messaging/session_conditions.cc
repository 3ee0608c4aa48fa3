#include "messaging/session_conditions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "messaging/channels.h"
#include "messaging/codec.h"

namespace planbench {
namespace {

const std::set<std::string> kFlagsThatCount = {"directions", "max-disturbance",
                                               "problems-per-process", "repeat-disturbed"};

/// The number that a text is; nothing if it is none, or one that a double may not tell from its
/// neighbours, a seed or a hash.
std::optional<double> NumberOf(const std::string& text) {
  constexpr double kWholeNumbersEnd = 9007199254740992;  // 2^53
  const char* const last = text.data() + text.size();
  double number = 0;
  const auto [end, error] =
      std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), last, number);
  const bool is_number = error == std::errc() && end == last && !text.empty();
  if (!is_number || !(std::abs(number) < kWholeNumbersEnd)) return std::nullopt;
  return number;
}

/// `session` without what may differ from `other`.
SessionMessage Comparable(SessionMessage session, const SessionMessage& other) {
  session.start_utime = 0;
  session.finished = false;
  session.total_time_s = 0;
  session.num_runs = 0;
  session.host = session.cpu = "";
  session.left_out.clear();
  // Of the flags those that runs count by and that the conditions do not tell.
  std::erase_if(session.settings, [&](const auto& flag) {
    return !kFlagsThatCount.contains(flag.first) || !other.settings.contains(flag.first);
  });
  const auto keep_common = [](auto* map, const auto& others) {
    std::erase_if(*map, [&](const auto& entry) { return !others.contains(entry.first); });
  };
  keep_common(&session.conditions.problem_sets, other.conditions.problem_sets);
  std::erase_if(session.conditions.contestants, [&](const Contestant& contestant) {
    const auto& others = other.conditions.contestants;
    return std::none_of(others.begin(), others.end(),
                        [&](const Contestant& o) { return o.planner == contestant.planner; });
  });
  for (Contestant& contestant : session.conditions.contestants) {
    contestant.about = contestant.published = "";  // what tables say beside it
  }
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
    node.unusable_models.clear();  // words
    const auto is_its = [&](const Contestant& one) { return one.planner == node.name; };
    // The contestant tells which of them counts.
    if (std::ranges::any_of(session.conditions.contestants, is_its)) node.collision_models.clear();
    node.request_id = node.host = node.instance = node.trouble = "";
    node.pid = 0;
    if (node.kind == NodeKind::kSceneServer) {
      node.name = "scene server";  // there is one
      node.settings.clear();       // the folders it was given; what is in them has ids
    }
  }
  // A planner that was on several hosts is there once for each.
  session.nodes.erase(std::unique(session.nodes.begin(), session.nodes.end()), session.nodes.end());
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

/// Whether fields of FieldsOf, by their place and values, say the same.
bool IsSameField(const std::string& field, const std::string& first, const std::string& second) {
  if (first == second) return true;
  const auto is_text = [](const std::string& value) { return value.starts_with('"'); };
  const bool is_setting = field.find("setting[") != std::string::npos;
  if (!is_setting || !is_text(first) || !is_text(second)) return false;
  const auto unquoted = [](const std::string& text) { return text.substr(1, text.size() - 2); };
  return IsSameSetting(unquoted(first), unquoted(second));
}

}  // namespace

bool IsSameSetting(const std::string& first, const std::string& second) {
  if (first == second) return true;
  const std::optional<double> number = NumberOf(first);
  return number && number == NumberOf(second);
}

std::optional<ConditionDifference> FindConditionDifference(const SessionMessage& first,
                                                           const SessionMessage& second) {
  const std::map<std::string, std::string> of_first = FieldsOf(Comparable(first, second));
  const std::map<std::string, std::string> of_second = FieldsOf(Comparable(second, first));
  const auto text = [](const auto& fields, const std::string& field) {
    const auto found = fields.find(field);
    return found == fields.end() ? "nothing" : found->second;
  };
  for (const auto* fields : {&of_first, &of_second}) {
    for (const auto& [field, value] : *fields) {
      ConditionDifference difference{field, text(of_first, field), text(of_second, field)};
      if (!IsSameField(field, difference.first, difference.second)) return difference;
    }
  }
  return std::nullopt;
}

std::optional<ConditionDifference> FindConditionDifference(const NodeStatusMessage& first,
                                                           const NodeStatusMessage& second) {
  SessionMessage of_first, of_second;
  of_first.nodes = {first};
  of_second.nodes = {second};
  return FindConditionDifference(of_first, of_second);
}

std::optional<std::string> DescribeInstructionDifference(
    const std::vector<SessionMessage>& sessions, std::string_view cpu) {
  std::string cpus(cpu);
  for (const SessionMessage& session : sessions) cpus += session.cpu;
  std::set<std::string> instructions;
  for (std::size_t end = 0; (end = cpus.find(']', end + 1)) != std::string::npos;) {
    const std::size_t begin = cpus.rfind('[', end);
    if (begin != std::string::npos) instructions.insert(cpus.substr(begin + 1, end - begin - 1));
  }
  if (instructions.size() < 2) return std::nullopt;
  return fmt::format(
      "processors with different vector instructions ({}): the same request and seed may give "
      "paths that differ by rounding, as of STOMP and CHOMP",
      fmt::join(instructions, ", "));
}

}  // namespace planbench
