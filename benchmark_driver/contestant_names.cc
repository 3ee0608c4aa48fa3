#include "benchmark_driver/contestant_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <utility>

#include "common/text.h"

namespace planbench {
namespace {

using NamesByPlanner = std::map<std::string, std::string>;

/// Of a planner as it announces itself. Words stand one blank apart, as a page shows them.
std::string OwnName(const NodeStatusMessage& planner) {
  constexpr std::size_t kMost = 80;  // bytes; tables cut at 100
  std::istringstream words(planner.algorithm);
  std::string name;
  for (std::string word; words >> word;) {
    if (!name.empty()) name += ' ';
    name += word;
  }
  return name.empty() ? planner.name : Abridged(std::move(name), kMost);
}

bool IsNameOfAnother(const std::string& name, const std::string& planner,
                     const NamesByPlanner& names) {
  return std::any_of(names.begin(), names.end(), [&](const auto& other) {
    return other.first != planner && other.second == name;
  });
}

}  // namespace

std::map<std::string, std::string> NamesGiven(const std::vector<SessionMessage>& earlier) {
  NamesByPlanner names;
  for (const SessionMessage& session : earlier) {
    for (const Contestant& one : session.conditions.contestants) {
      names.try_emplace(one.planner, one.name);
    }
  }
  return names;
}

std::map<std::string, std::string> ContestantNames(
    const std::vector<LineUpEntry>& line_up,
    const std::map<std::string, NodeStatusMessage>& planners,
    const std::map<std::string, std::string>& given) {
  NamesByPlanner without_first;
  for (const LineUpEntry& entry : line_up) {
    const Contestant& one = entry.contestant;
    without_first[one.planner] = one.name.empty() ? OwnName(planners.at(one.planner)) : one.name;
  }
  NamesByPlanner settled = given;
  for (const LineUpEntry& entry : line_up) {
    const Contestant& one = entry.contestant;
    if (!one.name.empty()) settled[one.planner] = one.name;
  }
  NamesByPlanner wanted = settled;
  for (const LineUpEntry& entry : line_up) {
    const Contestant& one = entry.contestant;
    const auto [place, is_new] = wanted.try_emplace(one.planner, without_first.at(one.planner));
    if (!is_new || one.first_path_of.empty()) continue;
    place->second += fmt::format(" after {}", without_first.at(one.first_path_of));
  }
  NamesByPlanner names = wanted;
  for (auto& [planner, name] : names) {
    if (settled.contains(planner)) continue;
    while (IsNameOfAnother(name, planner, wanted) || IsNameOfAnother(name, planner, names)) {
      name += fmt::format(" [{}]", planner);
    }
  }
  return names;
}

}  // namespace planbench
