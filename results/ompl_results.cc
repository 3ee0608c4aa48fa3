#include "results/ompl_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/read_text.h"
#include "common/sqlite.h"

namespace planbench {
namespace {

constexpr char kApproximate[] = "Approximate solution";

/// Of a run, by name with '_' for spaces; those without a value are absent.
using Properties = std::map<std::string, std::string>;

/// Names of a program's statuses by their numbers.
using Statuses = std::map<std::int64_t, std::string>;

template <typename Names>
Statuses Numbered(const Names& names) {
  Statuses statuses;
  for (const auto& name : names) {
    statuses.emplace(static_cast<std::int64_t>(statuses.size()), std::string(name));
  }
  return statuses;
}

/// OMPL's, which its logs name; databases may not.
Statuses StatusesOfOmpl() {
  return Numbered(std::vector<std::string>{"Unknown status", "Invalid start", "Invalid goal",
                                           "Unrecognized goal type", "Timeout", kApproximate,
                                           "Exact solution", "Crash", "Abort", "Infeasible"});
}

PlanStatus StatusNamed(const std::string& text) {
  static const std::map<std::string, PlanStatus> statuses = {
      {"Exact solution", PlanStatus::kSolved},
      {"Invalid start", PlanStatus::kStartInvalid},
      {"Invalid goal", PlanStatus::kGoalInvalid},
      {"Unrecognized goal type", PlanStatus::kInvalidRequest},
      {"Crash", PlanStatus::kNoAnswer},
      {"Abort", PlanStatus::kCancelled},
      {"Infeasible", PlanStatus::kExhausted}};
  if (const auto own = ParseEnum<PlanStatus>(text)) return *own;
  const auto found = statuses.find(text);
  return found == statuses.end() ? PlanStatus::kTimedOut : found->second;
}

std::optional<double> Number(const Properties& properties, const std::string& name) {
  const auto found = properties.find(name);
  if (found == properties.end()) return std::nullopt;
  const std::string& text = found->second;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw InputError(fmt::format("{}: '{}' is no number", name, text));
  }
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

int Whole(const Properties& properties, const std::string& name, int otherwise) {
  constexpr double kMost = 1e9;
  const auto value = Number(properties, name);
  if (value && !(*value >= 0 && *value <= kMost)) {
    throw InputError(fmt::format("{}: {} is out of range", name, *value));
  }
  return value ? static_cast<int>(*value) : otherwise;
}

/// A planner's on a problem.
struct Trials {
  std::map<std::pair<std::int64_t, Direction>, int> num_runs;  ///< By experiment.
  /// By experiment and what that calls them.
  std::map<std::pair<std::int64_t, int>, int> numbers;
  std::set<int> taken;  ///< Of the numbers.
  std::set<std::pair<int, Direction>> made;
};

/// Collects runs as a session.
class OmplSession {
 public:
  explicit OmplSession(std::string name) : name_(std::move(name)) {}

  StoredSession& session() { return session_; }

  std::size_t Contestant(const std::string& planner, const std::string& settings) {
    for (std::size_t i = 0; i < session_.contestants.size(); ++i) {
      const StoredContestant& known = session_.contestants[i];
      if (known.name == planner && known.settings == settings) return i;
    }
    session_.contestants.push_back({planner, settings});
    return session_.contestants.size() - 1;
  }

  /// `experiment_id` tells experiments of one name apart.
  StoredRun& AddRun(std::size_t contestant, std::int64_t experiment_id,
                    const std::string& experiment, double time_limit_s, const Statuses& statuses,
                    const Properties& properties) {
    StoredRun run;
    run.id = static_cast<std::int64_t>(session_.runs.size()) + 1;
    run.contestant = contestant;
    SetProblem(experiment, properties, &run);
    SetTrial(experiment_id, properties, &run);
    SetStatus(statuses, properties, &run);
    run.time_limit_s = time_limit_s;
    run.time_s = Number(properties, "time");
    const auto measure = [&](const std::string& property, const char* name,
                             MeasuredValues* values) {
      if (const auto value = Number(properties, property)) (*values)[name] = *value;
    };
    for (const auto& [property, name] : {std::pair("solution_length", "path_length"),
                                         std::pair("solution_smoothness", "smoothness"),
                                         std::pair("solution_clearance", "clearance")}) {
      measure(property, name, &run.measures);
      measure(std::string("simplified_") + property, name, &run.measures_simple);
    }
    run.phases.simplification_s = Number(properties, "simplification_time").value_or(0);
    session_.runs.push_back(std::move(run));
    return session_.runs.back();
  }

  /// What is to be said of the runs, a line each.
  std::vector<std::string> Warnings() const {
    std::vector<std::string> warnings;
    if (num_contradictions_ > 0) {
      warnings.push_back(
          fmt::format("status and solved contradict each other in {} runs: what counts is solved",
                      num_contradictions_));
    }
    if (num_unnamed_ > 0) {
      warnings.push_back(
          fmt::format("{} runs have a status that no list names: they are solved if solved says so",
                      num_unnamed_));
    }
    return warnings;
  }

  StoredSession Take() {
    const bool several = session_.contestants.size() > 1;
    std::map<std::string, int> num_named, numbers;
    for (const StoredContestant& one : session_.contestants) ++num_named[one.name];
    for (StoredContestant& one : session_.contestants) {
      const std::string planner = one.name;
      one.settings = "planner = " + planner + "\n" + one.settings;
      one.name = several ? name_ + ": " + planner : name_;
      if (num_named[planner] > 1) one.name += fmt::format(" #{}", ++numbers[planner]);
    }
    return std::move(session_);
  }

 private:
  void SetProblem(const std::string& experiment, const Properties& properties, StoredRun* run) {
    run->problem_set = experiment;
    run->problem_index = 1;
    const std::size_t slash = experiment.rfind('/');
    if (slash != std::string::npos) {
      int index = 0;
      const char* last = experiment.data() + experiment.size();
      const auto [end, error] = std::from_chars(experiment.data() + slash + 1, last, index);
      if (error == std::errc() && end == last && index >= 0) {
        run->problem_set = experiment.substr(0, slash);
        run->problem_index = index;
      }
    }
    if (const auto set = properties.find("problem_set"); set != properties.end()) {
      run->problem_set = set->second;
    }
    run->problem_index = Whole(properties, "problem_index", run->problem_index);
    if (const auto direction = properties.find("direction"); direction != properties.end()) {
      run->direction = ParseEnum<Direction>(direction->second).value_or(Direction::kForward);
    }
  }

  /// An experiment's trials stay those that it calls so where no other experiment has them.
  void SetTrial(std::int64_t experiment_id, const Properties& properties, StoredRun* run) {
    Trials& trials = trials_[{run->contestant, run->problem_set, run->problem_index}];
    const int number = ++trials.num_runs[{experiment_id, run->direction}];
    const int given = Whole(properties, "trial", number);
    const auto [place, is_new] = trials.numbers.try_emplace({experiment_id, given}, given);
    if (is_new && !trials.taken.insert(given).second) {
      place->second = *trials.taken.rbegin() + 1;
      trials.taken.insert(place->second);
    }
    run->trial = place->second;
    if (trials.made.emplace(run->trial, run->direction).second) return;
    throw InputError(fmt::format("trial: '{}' has trial {} of problem {} of '{}', {}, twice",
                                 session_.contestants[run->contestant].name, given,
                                 run->problem_index, run->problem_set, EnumName(run->direction)));
  }

  /// `solved` counts, not the status: that means what the list says which names it, and a database
  /// keeps but one of the lists of its logs.
  void SetStatus(const Statuses& statuses, const Properties& properties, StoredRun* run) {
    const std::optional<std::string> name = StatusName(statuses, properties);
    const PlanStatus named = name ? StatusNamed(*name) : PlanStatus::kTimedOut;
    const bool claims = named == PlanStatus::kSolved;
    const bool approximate =
        Whole(properties, "approximate_solution", name == kApproximate ? 1 : 0) == 1;
    const bool solved = Whole(properties, "solved", claims ? 1 : 0) == 1 && !approximate;
    if (name && solved != claims) ++num_contradictions_;
    if (solved) {
      run->status = PlanStatus::kSolved;
    } else if (claims) {
      run->status = PlanStatus::kTimedOut;
      run->message = fmt::format("not solved, though its status is '{}'", *name);
    } else {
      run->status = named;
      run->message = name.value_or("");
    }
    if (!name && properties.contains("status")) {
      ++num_unnamed_;
      if (!solved) run->message = "status " + properties.at("status") + ", which no list names";
    }
    if (solved && Whole(properties, "correct_solution", 1) == 0) {
      run->status = PlanStatus::kInvalidPath;
      run->message = "OMPL found the path incorrect";
    }
    run->claimed = run->confirmed() || run->status == PlanStatus::kInvalidPath;
  }

  /// Nothing without a status, or with one that is not among them.
  static std::optional<std::string> StatusName(const Statuses& statuses,
                                               const Properties& properties) {
    const auto found = statuses.find(Whole(properties, "status", -1));
    return found == statuses.end() ? std::nullopt : std::optional(found->second);
  }

  std::string name_;
  StoredSession session_;
  int num_contradictions_ = 0;
  int num_unnamed_ = 0;
  /// By contestant, set and problem.
  std::map<std::tuple<std::size_t, std::string, int>, Trials> trials_;
};

// ---- Logs
// ----------------------------------------------------------------------------------------

std::vector<std::string> Split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find(separator, from)) != std::string::npos;) {
    parts.push_back(text.substr(from, at - from));
    from = at + separator.size();
  }
  parts.push_back(text.substr(from));
  return parts;
}

class LogReader {
 public:
  explicit LogReader(const std::filesystem::path& file) : file_(file), text_(ReadText(file)) {}

  void Read(OmplSession* session) {
    try {
      const int num_planners = ReadHeader(&session->session());
      for (int i = 0; i < num_planners; ++i) ReadPlanner(session);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}:{}: {}", file_.string(), line_, error.what()));
    }
  }

 private:
  std::string Next() {
    std::string line;
    if (!std::getline(text_, line)) throw InputError("the log ends here");
    ++line_;
    if (line.ends_with('\r')) line.pop_back();
    return line;
  }

  /// The number that a line of the form "7 runs" begins with.
  static int Count(const std::string& line, const std::string& what) {
    int count = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), count);
    const std::string rest(end, static_cast<std::size_t>(line.data() + line.size() - end));
    if (error != std::errc() || count < 0 || !rest.starts_with(" " + what)) {
      throw InputError("'" + line + "' is not the number of " + what);
    }
    return count;
  }

  /// Returns the number of planners.
  int ReadHeader(StoredSession* session) {
    const auto after = [](const std::string& line, const std::string& begin) {
      return line.substr(begin.size());
    };
    int num_blocks = 0;
    while (true) {
      std::string line = Next();
      if (line.find(" version ") != std::string::npos && session->version.empty()) {
        session->version = line;
      } else if (line.starts_with("Experiment ")) {
        experiment_ = after(line, "Experiment ");
      } else if (line.starts_with("Running on ")) {
        session->host = after(line, "Running on ");
      } else if (line.starts_with("Starting at ")) {
        session->date = after(line, "Starting at ");
      } else if (line.starts_with("<<<|")) {
        std::string block;
        while (!(line = Next()).starts_with("|>>>")) block += line + "\n";
        if (++num_blocks == 2) session->cpu = block.substr(0, block.find('\n'));
      } else if (line.ends_with("is the random seed")) {
        session->seed = line.substr(0, line.find(' '));
      } else if (line.ends_with(" seconds per run")) {
        time_limit_s_ =
            Number({{"time limit", line.substr(0, line.find(' '))}}, "time limit").value_or(0);
      } else if (line.ends_with(" to collect the data")) {
        session->total_time_s =
            Number({{"total time", line.substr(0, line.find(' '))}}, "total time").value_or(0);
      } else if (line.ends_with(" enum type") || line.ends_with(" enum types")) {
        for (int i = Count(line, "enum"); i > 0; --i) {
          std::vector<std::string> names = Split(Next(), "|");
          if (names.front() != "status") continue;
          names.erase(names.begin());
          statuses_ = Numbered(names);
        }
      } else if (line.ends_with(" planners")) {
        return Count(line, "planners");
      }
    }
  }

  /// Names of "7 properties for each run" and what follows.
  std::vector<std::string> ReadNames(int count) {
    std::vector<std::string> names;
    for (; count > 0; --count) {
      std::string name = Next();
      name = name.substr(0, name.rfind(' '));  // the type
      std::replace(name.begin(), name.end(), ' ', '_');
      names.push_back(std::move(name));
    }
    return names;
  }

  Properties ReadValues(const std::vector<std::string>& names, const std::string& text,
                        const std::string& separator) const {
    std::vector<std::string> values = Split(text, separator);
    values.pop_back();  // each value is followed by a separator
    if (values.size() < names.size()) {
      throw InputError(fmt::format("{} values for {} properties", values.size(), names.size()));
    }
    Properties properties;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string& value = values[i];
      if (!value.empty() && value != "nan" && value != "inf") properties[names[i]] = value;
    }
    return properties;
  }

  void ReadPlanner(OmplSession* session) {
    const std::string planner = Next();
    std::string settings;
    for (int i = Count(Next(), "common properties"); i > 0; --i) settings += Next() + "\n";
    const std::size_t contestant = session->Contestant(planner, settings);
    const auto names = ReadNames(Count(Next(), "properties for each run"));
    const int num_runs = Count(Next(), "runs");
    const std::size_t first = session->session().runs.size();
    for (int i = 0; i < num_runs; ++i) {
      session->AddRun(contestant, 0, experiment_, time_limit_s_, statuses_,
                      ReadValues(names, Next(), "; "));
    }
    const std::string line = Next();
    if (line == ".") return;
    const auto progress_names = ReadNames(Count(line, "progress properties for each run"));
    const int num_series = Count(Next(), "runs");
    for (int i = 0; i < num_series; ++i) {
      const std::string series = Next();
      if (i < num_runs) {
        ReadProgress(progress_names, series, &session->session().runs[first + i]);
      }
    }
    if (Next() != ".") throw InputError("a planner's results end with '.'");
  }

  void ReadProgress(const std::vector<std::string>& names, const std::string& series,
                    StoredRun* run) const {
    for (const std::string& sample : Split(series, ";")) {
      if (sample.empty()) continue;
      const Properties properties = ReadValues(names, sample, ",");
      const auto time_s = Number(properties, "time");
      const auto cost = Number(properties, "best_cost");
      // OMPL samples at intervals: only improvements count.
      const bool better = cost && (run->progress.empty() || *cost < run->progress.back().cost);
      if (!time_s || !better) continue;
      PlanProgress progress;
      progress.elapsed_s = *time_s;
      progress.cost = *cost;
      run->progress.push_back(progress);
    }
  }

  std::filesystem::path file_;
  std::istringstream text_;
  int line_ = 0;
  std::string experiment_;
  double time_limit_s_ = 0;
  Statuses statuses_ = StatusesOfOmpl();
};

// ---- Databases
// -----------------------------------------------------------------------------------

/// As a log would have it; nothing if NULL.
std::optional<std::string> TextOf(const SqliteValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* real = std::get_if<double>(&value)) return fmt::format("{}", *real);
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  return std::nullopt;
}

std::vector<std::string> ColumnsOf(SqliteConnection* connection, const std::string& table) {
  std::vector<std::string> columns;
  SqliteStatement rows = connection->Prepare("PRAGMA table_info(" + table + ")");
  while (rows.Step()) columns.push_back(rows.Text(1));
  return columns;
}

/// Of a database of several programs' logs OMPL's script keeps the statuses of the first alone.
class StatusLists {
 public:
  explicit StatusLists(SqliteConnection* connection) {
    Statuses kept;
    SqliteStatement rows =
        connection->Prepare("SELECT value, description FROM enums WHERE name = 'status'");
    while (rows.Step()) kept[rows.Int(0)] = rows.Text(1);
    if (kept.empty()) return;
    const bool is_own = std::all_of(kept.begin(), kept.end(), [](const auto& status) {
      return ParseEnum<PlanStatus>(status.second).has_value();
    });
    (is_own ? own_ : others_) = std::move(kept);
  }

  /// Of a log that the program of this name and version wrote.
  const Statuses& Of(const std::string& version) const {
    return version.starts_with("planbench ") ? own_ : others_;
  }

 private:
  Statuses own_ = Numbered(EnumNames<PlanStatus>::kNames);
  Statuses others_ = StatusesOfOmpl();
};

/// Experiments that are those of a log which was added before.
std::set<std::int64_t> RepeatedExperiments(SqliteConnection* connection) {
  const std::vector<std::string> columns = ColumnsOf(connection, "experiments");
  std::set<std::int64_t> repeated;
  std::set<std::vector<SqliteValue>> known;
  SqliteStatement rows = connection->Prepare("SELECT id, * FROM experiments ORDER BY id");
  while (rows.Step()) {
    std::vector<SqliteValue> values;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i] != "id") values.push_back(rows.Value(static_cast<int>(i) + 1));
    }
    if (!known.insert(std::move(values)).second) repeated.insert(rows.Int(0));
  }
  return repeated;
}

/// Returns the number of experiments that were left out because they are there twice.
std::size_t ReadRuns(SqliteConnection* connection, OmplSession* session) {
  const std::vector<std::string> columns = ColumnsOf(connection, "runs");
  const bool is_planbench = std::find(columns.begin(), columns.end(), "run_id") != columns.end();
  const StatusLists statuses(connection);
  const std::set<std::int64_t> repeated = RepeatedExperiments(connection);
  SqliteStatement rows = connection->Prepare(
      std::string("SELECT p.name, p.settings, e.name, e.timelimit, e.hostname, e.version, e.date, "
                  "e.id, r.id, r.* FROM runs r JOIN plannerConfigs p ON p.id = r.plannerid "
                  "JOIN experiments e ON e.id = r.experimentid ") +
      (is_planbench ? "WHERE r.run_id IS NULL " : "") + "ORDER BY r.id");
  constexpr int kFirst = 9;
  while (rows.Step()) {
    const std::int64_t experiment_id = rows.Int(7);
    if (repeated.contains(experiment_id)) continue;
    Properties properties;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (auto text = TextOf(rows.Value(kFirst + static_cast<int>(i)))) {
        properties[columns[i]] = std::move(*text);
      }
    }
    std::string settings = TextOf(rows.Value(1)).value_or("");
    const std::size_t contestant = session->Contestant(rows.Text(0), settings);
    const std::string version = TextOf(rows.Value(5)).value_or("");
    try {
      session->AddRun(
          contestant, experiment_id, rows.Text(2),
          Number({{"timelimit", TextOf(rows.Value(3)).value_or("0")}}, "timelimit").value_or(0),
          statuses.Of(version), properties);
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("run {} of experiment {}: {}", rows.Int(8), experiment_id, error.what()));
    }
    session->session().host = TextOf(rows.Value(4)).value_or("");
    session->session().version = version;
    session->session().date = TextOf(rows.Value(6)).value_or("");
  }
  return repeated.size();
}

void AddWarnings(const std::filesystem::path& file, const OmplSession& session,
                 std::vector<std::string>* warnings) {
  for (const std::string& warning : session.Warnings()) {
    warnings->push_back(file.string() + ": " + warning);
  }
}

}  // namespace

StoredSession ReadOmplLog(const std::filesystem::path& file, const std::string& name,
                          std::vector<std::string>* warnings) {
  OmplSession session(name);
  LogReader(file).Read(&session);
  AddWarnings(file, session, warnings);
  return session.Take();
}

StoredSession ReadOmplDatabase(const std::filesystem::path& file, const std::string& name,
                               std::vector<std::string>* warnings) {
  OmplSession session(name);
  try {
    SqliteConnection connection(file, SqliteConnection::Mode::kReadOnly);
    if (const std::size_t num_repeated = ReadRuns(&connection, &session); num_repeated > 0) {
      warnings->push_back(fmt::format(
          "{}: {} of its experiments repeat another in everything, as when a log is added twice: "
          "their runs count once",
          file.string(), num_repeated));
    }
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  } catch (const SqliteError& error) {
    throw InputError(file.string() + ": is no benchmark database of OMPL's: " + error.what());
  }
  AddWarnings(file, session, warnings);
  return session.Take();
}

}  // namespace planbench
