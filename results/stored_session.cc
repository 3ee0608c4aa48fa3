#include "results/stored_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

#include "common/error.h"
#include "common/file_kind.h"
#include "common/sqlite.h"
#include "planning/asked_request.h"
#include "planning/told_warnings.h"
#include "results/bus_json.h"
#include "results/database_version.h"
#include "results/outcomes.h"

namespace planbench {
namespace {

std::optional<double> Real(const SqliteValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  return std::nullopt;
}

std::optional<std::int64_t> Int(const SqliteValue& value) {
  const auto* integer = std::get_if<std::int64_t>(&value);
  return integer == nullptr ? std::nullopt : std::optional(*integer);
}

std::string Text(const SqliteValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text == nullptr ? "" : *text;
}

/// A column of `runs`, and what becomes of its value.
struct Field {
  std::string column;
  std::function<void(StoredRun*, const SqliteValue&)> set;
};

/// A time in s; nothing for NULL, which is also how SQLite stores NaN. `run` has its id. Throws
/// InputError for what is negative, infinite or no number.
std::optional<double> Measured(const StoredRun& run, const char* column, const SqliteValue& value) {
  const std::optional<double> real = Real(value);
  if (const auto* text = std::get_if<std::string>(&value)) {
    throw InputError(fmt::format("run {}: {}: '{}' is no number", run.id, column, *text));
  }
  if (real && !(std::isfinite(*real) && *real >= 0)) {
    throw InputError(
        fmt::format("run {}: {}: {} is not finite, or less than 0", run.id, column, *real));
  }
  return real;
}

Field Time(const char* column, double PhaseTimes::*phase) {
  return {column, [=](StoredRun* run, const SqliteValue& value) {
            run->phases.*phase = Measured(*run, column, value).value_or(0);
          }};
}

/// 0 where there is none.
Field Time(const char* column, double StoredRun::*time_s) {
  return {column, [=](StoredRun* run, const SqliteValue& value) {
            run->*time_s = Measured(*run, column, value).value_or(0);
          }};
}

Field Measure(std::string column, std::string name, MeasuredValues StoredRun::*measures) {
  return {std::move(column),
          [name = std::move(name), measures](StoredRun* run, const SqliteValue& value) {
            if (const auto real = Real(value)) (run->*measures)[name] = *real;
          }};
}

std::vector<Field> Fields() {
  std::vector<Field> fields = {
      {"id", [](StoredRun* run, const SqliteValue& v) { run->id = Int(v).value_or(0); }},
      {"request_id", [](StoredRun* run, const SqliteValue& v) { run->request_id = Text(v); }},
      {"problem_set", [](StoredRun* run, const SqliteValue& v) { run->problem_set = Text(v); }},
      {"problem_index",
       [](StoredRun* run, const SqliteValue& v) {
         run->problem_index = static_cast<int>(Int(v).value_or(0));
       }},
      {"scene_id", [](StoredRun* run, const SqliteValue& v) { run->scene_id = Text(v); }},
      {"trial", [](StoredRun* run,
                   const SqliteValue& v) { run->trial = static_cast<int>(Int(v).value_or(1)); }},
      {"direction",
       [](StoredRun* run, const SqliteValue& v) {
         run->direction = ParseEnum<Direction>(Text(v)).value_or(Direction::kForward);
       }},
      {"status",
       [](StoredRun* run, const SqliteValue& v) {
         const std::int64_t status = Int(v).value_or(-1);
         if (status < 0 || status >= kNumEnumValues<PlanStatus>) {
           throw InputError(fmt::format("run {}: {} is no status", run->id, status));
         }
         run->status = static_cast<PlanStatus>(status);
       }},
      // Databases from before this column tell by the status alone. It stands above.
      {"claimed",
       [](StoredRun* run, const SqliteValue& v) {
         const bool found = run->confirmed() || run->status == PlanStatus::kInvalidPath;
         run->claimed = Int(v).value_or(found ? 1 : 0) != 0;
       }},
      {"message", [](StoredRun* run, const SqliteValue& v) { run->message = Text(v); }},
      {"time",
       [](StoredRun* run, const SqliteValue& v) { run->time_s = Measured(*run, "time", v); }},
      {"total_time",
       [](StoredRun* run, const SqliteValue& v) {
         run->total_time_s = Measured(*run, "total_time", v).value_or(run->time_s.value_or(0));
       }},
      Time("roundtrip_time", &StoredRun::roundtrip_time_s),
      Time("time_limit", &StoredRun::time_limit_s),
      Time("setup_time", &PhaseTimes::setup_s),
      Time("collision_time", &PhaseTimes::collision_s),
      Time("guidance_time", &PhaseTimes::guidance_s),
      Time("search_time", &PhaseTimes::search_s),
      Time("simplification_time", &PhaseTimes::simplification_s),
      {"referee_reason",
       [](StoredRun* run, const SqliteValue& v) { run->referee_reason = Text(v); }},
      {"mesh_valid",
       [](StoredRun* run, const SqliteValue& v) {
         if (const auto valid = Int(v)) run->mesh_valid = *valid != 0;
       }},
      {"mesh_reason", [](StoredRun* run, const SqliteValue& v) { run->mesh_reason = Text(v); }},
      {"mesh_depth", [](StoredRun* run, const SqliteValue& v) { run->mesh_depth_m = Real(v); }},
      {"mesh_valid_simplified",
       [](StoredRun* run, const SqliteValue& v) {
         if (const auto valid = Int(v)) run->mesh_valid_simple = *valid != 0;
       }},
      {"configurations_checked",  // by the planner's own word, whatever that is
       [](StoredRun* run, const SqliteValue& v) {
         run->configurations_checked = Real(v).value_or(0);
       }},
      {"load_before", [](StoredRun* run, const SqliteValue& v) { run->load_before = Real(v); }},
      {"waiting_time", [](StoredRun* run, const SqliteValue& v) { run->waiting_s = Real(v); }},
      {"steal_time", [](StoredRun* run, const SqliteValue& v) { run->steal_s = Real(v); }},
      {"disturbed",
       [](StoredRun* run, const SqliteValue& v) { run->disturbed = Int(v).value_or(0) != 0; }},
      {"repeats",
       [](StoredRun* run, const SqliteValue& v) {
         run->repeats = static_cast<int>(Int(v).value_or(0));
       }},
  };
  for (const PathMeasure& measure : PathMeasures()) {
    const std::string name = measure.name;
    fields.push_back(Measure(name, name, &StoredRun::measures));
    fields.push_back(Measure(name + "_simplified", name, &StoredRun::measures_simple));
  }
  // All that it may take back stands above.
  fields.push_back({"simplified_valid", [](StoredRun* run, const SqliteValue& v) {
                      if (const auto valid = Int(v)) run->JudgeSimplified(*valid != 0);
                    }});
  return fields;
}

/// "bus" of the folder's run.json, which the logger writes there where anything was odd; nothing
/// if that is not told.
std::optional<BusRecord> ReadBusRecord(const std::filesystem::path& run_json) {
  if (!IsFile(run_json)) return std::nullopt;
  const std::string text = ReadBusJson(run_json);
  if (!IsToldOf(text)) return std::nullopt;
  BusRecord record;
  if (text.empty()) return record;
  const auto bus = nlohmann::json::parse(text);
  record.malformed = bus.value("malformed_packets", std::int64_t{0});
  record.lost = bus.value("lost_messages", std::int64_t{0});
  record.dropped = bus.value("dropped_messages", std::int64_t{0});
  for (const auto& one : bus.value("contradictions", nlohmann::json::array())) {
    record.contradictions += one.value("count", std::int64_t{0});
  }
  record.parts_not_told = bus.value(kLogsNotToldOf, std::int64_t{0});
  return record;
}

/// A database of which it is known that it is one of ours.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file)
      : file_(file), connection_(file, SqliteConnection::Mode::kReadOnly) {
    const std::int64_t version = Int(connection_.QueryValue("PRAGMA user_version")).value_or(0);
    if (version < 1 || CountTables("'runs', 'plannerConfigs', 'sessions'") < 3) {
      throw InputError(WhyNotOurs());
    }
    if (version > kResultsSchemaVersion) {
      throw InputError(
          fmt::format("was written by a later version of planbench (user_version {})", version));
    }
  }

  StoredSessions Read(std::optional<std::int64_t> only_run) {
    if (only_run) chosen_ = fmt::format("= {}", *only_run);
    ReadDescriptions();
    ReadRuns();
    ReadProgress();
    ReadOddTimes();
    const std::optional<BusRecord> bus =
        ReadBusRecord(std::filesystem::absolute(file_).replace_filename("run.json"));
    StoredSessions stored;
    for (auto& [run_id, session] : sessions_) {
      session.bus = bus;
      stored.sessions.push_back(std::move(session));
    }
    std::stable_sort(stored.sessions.begin(), stored.sessions.end(),
                     [](const auto& a, const auto& b) { return a.date < b.date; });
    stored.num_foreign_runs = static_cast<int>(
        Int(connection_.QueryValue("SELECT count(*) FROM runs WHERE run_id IS NULL")).value_or(0));
    return stored;
  }

 private:
  std::int64_t CountTables(const char* names) {
    return Int(connection_.QueryValue(
                   fmt::format("SELECT count(*) FROM sqlite_master WHERE name IN ({})", names)))
        .value_or(0);
  }

  std::string WhyNotOurs() {
    if (CountTables("'runs', 'plannerConfigs'") == 2) {
      return "was written by another program than planbench";
    }
    if (Int(connection_.QueryValue("SELECT count(*) FROM sqlite_master")) == 0 &&
        Text(connection_.QueryValue("PRAGMA journal_mode")) == "wal") {
      return "holds nothing by itself: while a session runs, its results are in the -wal file "
             "beside it; copy that, too";
    }
    return "is no results database of planbench";
  }

  StoredSession& Session(const std::string& run_id) {
    StoredSession& session = sessions_[run_id];
    session.run_id = run_id;
    session.file = file_;
    return session;
  }

  void ReadDescriptions() {
    SqliteStatement select = connection_.Prepare(
        "SELECT run_id, finished, total_time, num_runs, version, hostname, cpuinfo, date, seed, "
        "details FROM sessions");
    while (select.Step()) {
      StoredSession& session = Session(select.Text(0));
      session.described = true;
      session.finished = Int(select.Value(1)).value_or(0) != 0;
      session.total_time_s = Real(select.Value(2)).value_or(0);
      session.num_runs = static_cast<int>(Int(select.Value(3)).value_or(0));
      session.version = Text(select.Value(4));
      session.host = Text(select.Value(5));
      session.cpu = Text(select.Value(6));
      session.date = Text(select.Value(7));
      session.seed = Text(select.Value(8));
      const auto details = nlohmann::json::parse(Text(select.Value(9)), nullptr, false);
      if (!details.is_object()) continue;
      session.commit = details.value("commit", "");
      if (const auto robot = details.find("robot"); robot != details.end()) {
        session.robot = fmt::format("{} ({})", robot->value("name", ""), robot->value("id", ""));
      }
      session.flags = details.value("flags", session.flags);
      session.left_out = details.value("left_out", session.left_out);
      told_contestants_[session.run_id] = details.value("contestants", std::set<std::string>());
      for (const auto& node : details.value("nodes", nlohmann::json::array())) {
        if (node.value("kind", "") == "driver") {
          session.machine = node.value("settings", session.machine);
        } else if (node.value("kind", "") == "scene server") {
          const auto told = node.value("settings", std::map<std::string, std::string>());
          for (const char* kind : {kRobotWarning, kProblemWarning, kPlannerWarning}) {
            for (std::string& warning : ToldWarnings(kind, told)) {
              const bool is_new =
                  std::ranges::find(session.warnings, warning) == session.warnings.end();
              if (is_new) session.warnings.push_back(std::move(warning));
            }
          }
        }
      }
    }
  }

  void ReadRuns() {
    const std::vector<Field> fields = Fields();
    std::vector<std::string> present;
    SqliteStatement columns = connection_.Prepare("PRAGMA table_info(runs)");
    while (columns.Step()) present.push_back(columns.Text(1));
    std::string sql = "SELECT run_id, plannerid, p.name, p.settings";
    for (const Field& field : fields) {
      const bool is_present =
          std::find(present.begin(), present.end(), field.column) != present.end();
      sql += is_present ? ", runs." + field.column : ", NULL";
    }
    sql += " FROM runs JOIN plannerConfigs p ON p.id = plannerid WHERE run_id IS NOT NULL";
    sql += fmt::format(" AND runs.id {} ORDER BY runs.id", chosen_);
    SqliteStatement select = connection_.Prepare(sql);
    while (select.Step()) {
      StoredSession& session = Session(select.Text(0));
      const std::set<std::string>& told = told_contestants_[session.run_id];
      if (!told.empty() && !told.contains(select.Text(2))) {
        ++session.strangers[select.Text(2)];
        continue;
      }
      StoredRun run;
      for (std::size_t i = 0; i < fields.size(); ++i) {
        fields[i].set(&run, select.Value(static_cast<int>(i) + 4));
      }
      const auto [known, is_new] =
          contestants_.try_emplace({session.run_id, select.Int(1)}, session.contestants.size());
      if (is_new) session.contestants.push_back({select.Text(2), Text(select.Value(3))});
      if (!TellsOfRequest(run.roundtrip_time_s, run.status, !run.scene_id.empty())) {
        ++session.num_not_asked;
        session.num_unjudgeable += run.referee_reason.empty() ? 0 : 1;
        session.why_not_asked.Add(run.message);
        continue;
      }
      run.contestant = known->second;
      places_[run.id] = {&session, session.runs.size()};
      session.runs.push_back(std::move(run));
    }
  }

  void ReadProgress() {
    if (CountTables("'progress'") == 0) return;
    SqliteStatement select = connection_.Prepare(
        fmt::format("SELECT runid, time, epsilon, cost, expansions FROM progress "
                    "WHERE runid {} ORDER BY runid, time, rowid",
                    chosen_));
    while (select.Step()) {
      const auto place = places_.find(select.Int(0));
      const auto time_s = Real(select.Value(1));
      const auto cost = Real(select.Value(3));
      if (place == places_.end() || !time_s || !cost) continue;
      place->second.first->runs[place->second.second].progress.push_back(
          {*time_s, Real(select.Value(2)).value_or(0), *cost, Int(select.Value(4)).value_or(0)});
    }
  }

  void ReadOddTimes() {
    if (CountTables("'counters'") == 0) return;
    for (std::size_t i = 0; i < kNumOddTimes; ++i) {
      SqliteStatement select = connection_.Prepare(
          fmt::format("SELECT runid, value FROM counters WHERE name = '{}' AND runid {}",
                      kOddTimes[i].counter, chosen_));
      while (select.Step()) {
        const auto place = places_.find(select.Int(0));
        if (place == places_.end()) continue;
        StoredRun& run = place->second.first->runs[place->second.second];
        run.odd_times_s[i] = Real(select.Value(1)).value_or(0);
      }
    }
  }

  std::filesystem::path file_;
  SqliteConnection connection_;
  std::string chosen_ = "IS NOT NULL";  ///< Said of a run's id.
  std::map<std::string, StoredSession> sessions_;
  /// Names by session; none where it does not tell, as those of before.
  std::map<std::string, std::set<std::string>> told_contestants_;
  /// Session and index of a run, by its id.
  std::map<std::int64_t, std::pair<StoredSession*, std::size_t>> places_;
  /// By session and `plannerConfigs.id`.
  std::map<std::pair<std::string, std::int64_t>, std::size_t> contestants_;
};

}  // namespace

void StoredRun::JudgeSimplified(bool valid) {
  simplified_valid = valid;
  if (valid) return;
  measures_simple.clear();
  mesh_valid_simple.reset();
}

std::map<std::string, std::string> ParseSettings(const std::string& settings) {
  const std::string between = " = ";
  std::map<std::string, std::string> by_name;
  std::istringstream lines(settings);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find(between);
    if (end == std::string::npos) continue;
    by_name.emplace(line.substr(0, end), line.substr(end + between.size()));
  }
  return by_name;
}

StoredSessions ReadSessions(const std::filesystem::path& folder_or_file,
                            std::optional<std::int64_t> only_run) {
  std::filesystem::path file = folder_or_file;
  if (IsFolder(file)) file /= "results.sqlite";
  if (!IsFile(file)) {
    std::error_code ignored;
    throw InputError(file.string() + (std::filesystem::exists(file, ignored)
                                          ? " is neither a session folder nor a file"
                                          : " does not exist"));
  }
  try {
    return Reader(file).Read(only_run);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  } catch (const SqliteError& error) {
    throw InputError(error.what());
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

}  // namespace planbench
