#include "benchmark_driver/line_up.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

#include "benchmark_driver/published_study.h"
#include "common/error.h"
#include "common/file_kind.h"
#include "common/yaml.h"
#include "common/yaml_text.h"
#include "messaging/channels.h"

namespace planbench {
namespace {

using Values = std::vector<std::pair<std::string, YamlNode>>;

/// The values of settings by their keys, `prefix` before them; those in a map's by MAP.KEY, as
/// --set has them.
Values ReadValues(const YamlNode& map, const std::string& prefix = "") {
  Values values;
  for (const std::string& key : map.Keys()) {
    const YamlNode value = map.At(key);
    const Values more =
        value.IsMap() ? ReadValues(value, prefix + key + ".") : Values{{prefix + key, value}};
    values.insert(values.end(), more.begin(), more.end());
  }
  return values;
}

/// A text or a list of texts as YAML in one line.
std::string AsYaml(const YamlNode& value) {
  if (!value.IsSequence()) return value.String();
  std::vector<std::string> texts;
  for (const std::string& text : value.Strings()) texts.push_back(YamlText(text));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// Returns the value as YAML in one line.
std::string AddSetting(const std::string& key, const YamlNode& node, LineUpEntry* entry) {
  std::string value = AsYaml(node);
  entry->settings.push_back(key + "=" + value);
  entry->origins[key] = node.Where();
  return value;
}

/// Every choice of one value for each key, the last key varying fastest.
std::vector<Values> ReadSweep(const YamlNode& map) {
  std::vector<Values> choices = {{}};
  for (const auto& [key, values] : ReadValues(map)) {
    if (values.Size() == 0) values.Fail("no value to sweep over");
    std::vector<Values> longer;
    for (const Values& choice : choices) {
      for (const YamlNode& value : values.Elements()) {
        longer.push_back(choice);
        longer.back().emplace_back(key, value);
      }
    }
    choices = std::move(longer);
  }
  return choices;
}

/// `text` as a part of a node's name.
std::string AsNodeName(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return text;
}

std::filesystem::path FindConfig(const YamlNode& node, const std::filesystem::path& line_up,
                                 const std::filesystem::path& robot_folder) {
  const std::filesystem::path name = node.String();
  for (const std::filesystem::path& folder : {line_up.parent_path(), robot_folder}) {
    if (IsFile(folder / name)) return folder / name;
  }
  node.Fail(fmt::format("no such file beside the line-up or in {}", robot_folder.string()));
}

/// What is told by `key`, which is something if it is there; "" if it is not.
std::string Told(const YamlNode& node, const std::string& key) {
  const auto found = node.Find(key);
  if (!found) return "";
  std::string text = found->String();
  if (text.find_first_not_of(' ') == std::string::npos) found->Fail("says nothing");
  return text;
}

/// The name of one who has figures in the published study; "" if there is none.
std::string ReadPublished(const YamlNode& node) {
  std::string name = Told(node, "published");
  std::set<std::string_view> known;
  for (const PublishedFigures& figures : PublishedStudy()) known.insert(figures.algorithm);
  if (!name.empty() && !known.contains(name)) {
    node.At("published")
        .Fail(fmt::format("the study has no figures of '{}'; it has those of: {}", name,
                          fmt::join(known, ", ")));
  }
  return name;
}

std::vector<LineUpEntry> ReadContestant(const std::string& planner, const YamlNode& node,
                                        const std::filesystem::path& file,
                                        const std::optional<std::filesystem::path>& robot_folder) {
  node.AllowOnly({"name", "about", "published", "program", "command", "config", "set", "sweep",
                  "collision_model", "edge_resolution", "edge_check", "directions",
                  "first_path_of"});
  if (!IsNodeName(planner)) node.Fail(kNodeNameRule);
  LineUpEntry entry;
  Contestant& contestant = entry.contestant;
  contestant.planner = entry.key = planner;
  contestant.name = Told(node, "name");
  contestant.about = node.StringOr("about", "");
  contestant.published = ReadPublished(node);
  contestant.command = Told(node, "command");
  contestant.first_path_of = Told(node, "first_path_of");
  entry.program = node.StringOr("program", contestant.command.empty() ? planner : "");
  if (const auto model = node.Find("collision_model")) {
    contestant.collision_model = model->Enum<CollisionModel>();
  }
  if (const auto step = node.Find("edge_resolution")) {
    contestant.edge_resolution_m =
        step->DoubleWithin(kFinestEdgeResolution, kCoarsestEdgeResolution);
  }
  if (const auto check = node.Find("edge_check")) contestant.edge_check = check->Enum<EdgeCheck>();
  if (const auto directions = node.Find("directions")) {
    entry.directions = directions->Enum<Directions>();
  }
  if (!contestant.command.empty()) {
    for (const char* key : {"program", "config", "set", "sweep"}) {
      if (const auto found = node.Find(key)) {
        found->Fail("a contestant with a command of its own is told its settings there");
      }
    }
  }
  const auto config = node.Find("config");
  if (config && robot_folder) entry.config = FindConfig(*config, file, *robot_folder);
  if (const auto set = node.Find("set")) {
    for (const auto& [key, value] : ReadValues(*set)) AddSetting(key, value, &entry);
  }
  const auto sweep = node.Find("sweep");
  if (!sweep) return {entry};

  std::vector<LineUpEntry> entries;
  for (const Values& choice : ReadSweep(*sweep)) {
    LineUpEntry one = entry;
    for (const auto& [key, node] : choice) {
      const std::string value = AddSetting(key, node, &one);
      one.swept.push_back(key);
      one.contestant.planner += AsNodeName("_" + key + "_" + value);
      if (!one.contestant.name.empty()) one.contestant.name += fmt::format(", {} {}", key, value);
    }
    if (!IsNodeName(one.contestant.planner)) {
      sweep->Fail(fmt::format("'{}': {}", one.contestant.planner, kNodeNameRule));
    }
    entries.push_back(std::move(one));
  }
  return entries;
}

std::vector<std::string> NamesOf(const std::vector<LineUpEntry>& entries) {
  std::vector<std::string> names;
  for (const LineUpEntry& entry : entries) names.push_back(entry.contestant.planner);
  return names;
}

/// What a name stands for: the planner of that name, else all that a sweep of that name makes.
std::vector<LineUpEntry*> Find(std::vector<LineUpEntry>* entries, const std::string& name) {
  std::vector<LineUpEntry*> found;
  for (LineUpEntry& entry : *entries) {
    if (entry.contestant.planner == name) return {&entry};
    if (entry.key == name) found.push_back(&entry);
  }
  return found;
}

/// The same; throws, beginning with `where`, if none of the chosen entries has that name.
std::vector<LineUpEntry*> Chosen(std::vector<LineUpEntry>* entries, const std::string& name,
                                 const std::string& where) {
  std::vector<LineUpEntry*> found = Find(entries, name);
  if (found.empty()) {
    throw InputError(fmt::format("{}: '{}' is not among the planners: {}", where, name,
                                 fmt::join(NamesOf(*entries), ", ")));
  }
  return found;
}

/// The one entry that a name stands for; throws likewise, and if it stands for several.
LineUpEntry& ChosenOne(std::vector<LineUpEntry>* entries, const std::string& name,
                       const std::string& where) {
  const std::vector<LineUpEntry*> found = Chosen(entries, name, where);
  if (found.size() > 1) {
    std::vector<std::string> planners;
    for (const LineUpEntry* entry : found) planners.push_back(entry->contestant.planner);
    throw InputError(fmt::format("{}: '{}' stands for several planners; name one: {}", where, name,
                                 fmt::join(planners, ", ")));
  }
  return *found.front();
}

std::vector<LineUpEntry> Pick(std::vector<LineUpEntry> entries,
                              const std::vector<std::string>& planners,
                              const std::filesystem::path& file) {
  if (planners.empty()) return entries;
  std::vector<LineUpEntry> picked;
  for (const std::string& planner : planners) {
    const std::vector<LineUpEntry*> found = Find(&entries, planner);
    if (found.empty()) {
      throw InputError(fmt::format("--planners: {} has no '{}'; it has: {}", file.string(), planner,
                                   fmt::join(NamesOf(entries), ", ")));
    }
    for (const LineUpEntry* entry : found) picked.push_back(*entry);
  }
  return picked;
}

/// Adds whose paths the entries improve and who is not among them.
void AddFirstPlanners(std::vector<LineUpEntry> all, std::vector<LineUpEntry>* entries) {
  for (std::size_t i = 0, num_contestants = entries->size(); i < num_contestants; ++i) {
    const std::string first = (*entries)[i].contestant.first_path_of;
    if (first.empty() || !Find(entries, first).empty()) continue;
    for (LineUpEntry* entry : Find(&all, first)) {
      entry->finds_first_paths_only = true;
      entries->push_back(*entry);
    }
  }
}

/// Throws InputError for a setting of which the contestant's name tells another value.
void RequireNotSwept(const LineUpEntry& entry, const std::string& key) {
  for (const std::string& swept : entry.swept) {
    if (key == swept || key.starts_with(swept + ".") || swept.starts_with(key + ".")) {
      throw InputError(
          fmt::format("--set: '{}' has {} from its sweep, by which it is named: change "
                      "it in the line-up",
                      entry.contestant.planner, swept));
    }
  }
}

void RequireDistinct(const std::vector<LineUpEntry>& entries) {
  // Of two processes of one name only one stays on a bus.
  static const std::set<std::string> kTaken = {"driver", "logger", "scene_server"};
  std::map<std::string, std::string> by_channel;
  std::map<std::string, std::string> by_name;
  for (const LineUpEntry& entry : entries) {
    const Contestant& contestant = entry.contestant;
    const std::string& planner = contestant.planner;
    if (kTaken.contains(planner)) {
      throw InputError(
          fmt::format("a planner cannot be called '{}', as another process of the "
                      "session is",
                      planner));
    }
    const auto [same, is_new] = by_channel.emplace(PlannerChannels(planner).request, planner);
    if (!is_new) {
      throw InputError(same->second == planner
                           ? fmt::format("the planner '{}' occurs twice", planner)
                           : fmt::format("the planners '{}' and '{}' would share their channels "
                                         "({})",
                                         same->second, planner, same->first));
    }
    if (contestant.name.empty()) continue;
    const auto [other, is_new_name] = by_name.emplace(contestant.name, planner);
    if (!is_new_name) {
      throw InputError(fmt::format("the planners '{}' and '{}' have one name: '{}'", other->second,
                                   planner, contestant.name));
    }
  }
}

/// Who is given a path is given one that another finds by itself, whose own name is put in place.
void ResolveFirstPaths(std::vector<LineUpEntry>* entries) {
  for (LineUpEntry& entry : *entries) {
    std::string& first = entry.contestant.first_path_of;
    if (first.empty()) continue;
    const std::string where =
        fmt::format("the planner '{}': first_path_of", entry.contestant.planner);
    const Contestant& other = ChosenOne(entries, first, where).contestant;
    if (!other.first_path_of.empty()) {
      throw InputError(fmt::format("{}: '{}' does not find a path by itself", where, first));
    }
    first = other.planner;
  }
}

}  // namespace

std::vector<LineUpEntry> ReadLineUp(const std::filesystem::path& file,
                                    const std::optional<std::filesystem::path>& robot_folder) {
  const YamlNode document = YamlNode::LoadFile(file.string());
  document.AllowOnly({"contestants", "x-*"});
  const YamlNode contestants = document.At("contestants");
  std::vector<LineUpEntry> entries;
  for (const std::string& planner : contestants.Keys()) {
    const auto more = ReadContestant(planner, contestants.At(planner), file, robot_folder);
    entries.insert(entries.end(), more.begin(), more.end());
  }
  if (entries.empty()) contestants.Fail("no contestant");
  return entries;
}

std::vector<LineUpEntry> MakeLineUp(const LineUpFlags& flags,
                                    const std::optional<std::filesystem::path>& robot_folder) {
  std::vector<LineUpEntry> entries;
  if (flags.file) {
    const std::vector<LineUpEntry> all = ReadLineUp(*flags.file, robot_folder);
    entries = Pick(all, flags.planners, *flags.file);
    AddFirstPlanners(all, &entries);
  } else {
    static const std::vector<std::string> kOwn = {"ara", "rrtc"};
    for (const std::string& planner : flags.planners.empty() ? kOwn : flags.planners) {
      LineUpEntry& entry = entries.emplace_back();
      entry.contestant.planner = entry.key = entry.program = planner;
    }
  }
  RequireDistinct(entries);
  ResolveFirstPaths(&entries);
  for (const auto& [planner, command] : flags.commands) {
    LineUpEntry& entry = ChosenOne(&entries, planner, "--planner-command");
    if (!entry.contestant.command.empty()) {
      throw InputError("--planner-command: '" + planner + "' has a command already");
    }
    entry.contestant.command = command;
  }
  for (const auto& [planner, setting] : flags.settings) {
    for (LineUpEntry* entry : Chosen(&entries, planner, "--set")) {
      if (!entry->contestant.command.empty()) {
        throw InputError("--set: '" + planner +
                         "' is started by its own command; give settings there");
      }
      const std::string key = setting.substr(0, setting.find('='));
      RequireNotSwept(*entry, key);
      entry->settings.push_back(setting);
      entry->origins[key] = fmt::format("--set {}.{}", planner, key);
    }
  }
  return entries;
}

void RequireNoFirstPaths(const std::vector<LineUpEntry>& line_up) {
  for (const LineUpEntry& entry : line_up) {
    if (entry.contestant.first_path_of.empty()) continue;
    throw InputError(
        fmt::format("--parallel: '{}' cannot search for '{}' and for itself at the same time",
                    entry.contestant.first_path_of, entry.contestant.planner));
  }
}

}  // namespace planbench
