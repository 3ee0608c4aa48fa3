#include "results/ompl_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <sstream>
#include <vector>

namespace planbench {
namespace {

/// OMPL's reader takes a line for a value, and of some lines the last word.
std::string OneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}
std::string OneWord(const std::string& text, const char* otherwise) {
  std::string word = OneLine(text);
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c == ' ' || c == '\t'; }, '_');
  return word.empty() ? otherwise : word;
}

std::string Text(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "";
}
std::string Flag(bool value) { return value ? "1" : "0"; }

struct Property {
  const char* name;
  const char* type;
  std::function<std::string(const StoredRun&)> value;  ///< Empty: none.
};

std::vector<Property> LoggedProperties() {
  const auto measure = [](const char* name, bool raw) {
    return [=](const StoredRun& run) {
      return Text(FindMeasure(raw ? run.measures : run.measures_simple, name));
    };
  };
  const auto phase = [](double PhaseTimes::*time) {
    return [=](const StoredRun& run) {
      const bool is_told = run.time_s && run.phases.AreTold();
      return is_told ? fmt::format("{}", run.phases.*time) : std::string();
    };
  };
  return {
      {"time", "REAL", [](const StoredRun& run) { return Text(run.time_s); }},
      {"total time", "REAL",
       [](const StoredRun& run) {
         return run.time_s ? Text(std::max(run.total_time_s, *run.time_s)) : "";
       }},
      {"solved", "BOOLEAN", [](const StoredRun& run) { return Flag(run.confirmed()); }},
      {"status", "ENUM",
       [](const StoredRun& run) { return fmt::format("{}", static_cast<int>(run.status)); }},
      {"claimed", "BOOLEAN", [](const StoredRun& run) { return Flag(run.claimed); }},
      {"correct solution", "BOOLEAN",
       [](const StoredRun& run) { return run.claimed ? Flag(run.confirmed()) : ""; }},
      {"problem index", "INTEGER",
       [](const StoredRun& run) { return fmt::format("{}", run.problem_index); }},
      {"trial", "INTEGER", [](const StoredRun& run) { return fmt::format("{}", run.trial); }},
      {"direction", "TEXT",
       [](const StoredRun& run) { return std::string(EnumName(run.direction)); }},
      {"solution length", "REAL", measure("path_length", true)},
      {"solution smoothness", "REAL", measure("smoothness", true)},
      {"solution clearance", "REAL", measure("clearance", true)},
      {"simplified correct solution", "BOOLEAN",
       [](const StoredRun& run) {
         return run.simplified_valid ? Flag(*run.simplified_valid) : "";
       }},
      {"simplified solution length", "REAL", measure("path_length", false)},
      {"simplified solution smoothness", "REAL", measure("smoothness", false)},
      {"simplified solution clearance", "REAL", measure("clearance", false)},
      {"setup time", "REAL", phase(&PhaseTimes::setup_s)},
      {"collision time", "REAL", phase(&PhaseTimes::collision_s)},
      {"guidance time", "REAL", phase(&PhaseTimes::guidance_s)},
      {"search time", "REAL", phase(&PhaseTimes::search_s)},
      {"simplification time", "REAL",
       [](const StoredRun& run) { return Text(run.phases.Simplification()); }},
  };
}

std::string ProgressOf(const StoredRun& run) {
  std::string text;
  for (std::size_t i = 0; i < run.progress.size(); ++i) {
    const PlanProgress& one = run.progress[i];
    // OMPL's tables have room for one a time.
    if (i + 1 < run.progress.size() && run.progress[i + 1].elapsed_s == one.elapsed_s) continue;
    text += fmt::format("{},{},;", one.elapsed_s, one.cost);
  }
  return text;
}

std::string PlannerResults(const StoredContestant& contestant,
                           const std::vector<const StoredRun*>& runs) {
  std::vector<std::string> settings;
  std::istringstream lines(contestant.settings);
  for (std::string line; std::getline(lines, line);) settings.push_back(OneLine(line));
  std::string text =
      fmt::format("{}\n{} common properties\n", OneLine(contestant.name), settings.size());
  for (const std::string& line : settings) text += line + "\n";
  const std::vector<Property> properties = LoggedProperties();
  text += fmt::format("{} properties for each run\n", properties.size());
  for (const Property& one : properties) text += fmt::format("{} {}\n", one.name, one.type);
  text += fmt::format("{} runs\n", runs.size());
  for (const StoredRun* run : runs) {
    for (const Property& one : properties) text += one.value(*run) + "; ";
    text += "\n";
  }
  if (std::any_of(runs.begin(), runs.end(), [](auto* run) { return !run->progress.empty(); })) {
    text += fmt::format("2 progress properties for each run\ntime REAL\nbest cost REAL\n{} runs\n",
                        runs.size());
    for (const StoredRun* run : runs) text += ProgressOf(*run) + "\n";
  }
  return text + ".\n";
}

}  // namespace

std::string OmplLog(const StoredSession& session, const std::string& problem_set) {
  std::vector<std::vector<const StoredRun*>> runs(session.contestants.size());
  double time_limit_s = 0;
  for (const StoredRun& run : session.runs) {
    if (run.problem_set != problem_set) continue;
    runs[run.contestant].push_back(&run);
    time_limit_s = std::max(time_limit_s, run.time_limit_s);
  }
  std::size_t num_planners = 0, most_runs = 0;
  std::string planners;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].empty()) continue;
    ++num_planners;
    most_runs = std::max(most_runs, runs[i].size());
    planners += PlannerResults(session.contestants[i], runs[i]);
  }
  return fmt::format(
      "planbench version {}\nExperiment {}\nRunning on {}\nStarting at {}\n"
      "<<<|\nproblem set {} of the session {}, robot {}\n|>>>\n<<<|\n{}\n|>>>\n"
      "{} is the random seed\n{} seconds per run\n0 MB per run\n{} runs per planner\n"
      "{} seconds spent to collect the data\n1 enum type\nstatus|{}\n{} planners\n{}",
      OneWord(session.version.substr(session.version.rfind(' ') + 1), "unknown"),
      OneWord(problem_set, "unnamed"), OneWord(session.host, "unknown"), OneLine(session.date),
      OneLine(problem_set), session.run_id, OneLine(session.robot), OneLine(session.cpu),
      OneWord(session.seed, "0"), time_limit_s, most_runs, session.total_time_s,
      fmt::join(EnumNames<PlanStatus>::kNames, "|"), num_planners, planners);
}

}  // namespace planbench
