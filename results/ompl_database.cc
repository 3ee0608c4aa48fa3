#include "results/ompl_database.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/sqlite.h"
#include "results/ompl_session.h"

namespace planbench {
namespace {

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
    OmplStatuses kept;
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
  const OmplStatuses& Of(const std::string& version) const {
    return version.starts_with("planbench ") ? own_ : others_;
  }

 private:
  OmplStatuses own_ =
      NumberStatuses({EnumNames<PlanStatus>::kNames.begin(), EnumNames<PlanStatus>::kNames.end()});
  OmplStatuses others_ = StatusesOfOmpl();
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

/// Samples of a run, which is to be bound; nothing where no planner told of its path.
std::optional<SqliteStatement> PrepareProgress(SqliteConnection* connection) {
  const std::vector<std::string> columns = ColumnsOf(connection, "progress");  // none without table
  if (std::find(columns.begin(), columns.end(), "best_cost") == columns.end()) return std::nullopt;
  return connection->Prepare(
      "SELECT time, best_cost FROM progress WHERE runid = ? ORDER BY time, best_cost DESC");
}

void ReadProgress(std::int64_t id, SqliteStatement* samples, StoredRun* run) {
  samples->Bind(1, id);
  while (samples->Step()) {
    OmplProperties sample;
    if (auto time = TextOf(samples->Value(0))) sample["time"] = std::move(*time);
    if (auto cost = TextOf(samples->Value(1))) sample["best_cost"] = std::move(*cost);
    AddProgress(sample, run);
  }
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
  std::optional<SqliteStatement> progress = PrepareProgress(connection);
  constexpr int kFirst = 9;
  while (rows.Step()) {
    const std::int64_t experiment_id = rows.Int(7);
    if (repeated.contains(experiment_id)) continue;
    OmplProperties properties;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (auto text = TextOf(rows.Value(kFirst + static_cast<int>(i)))) {
        properties[columns[i]] = std::move(*text);
      }
    }
    std::string settings = TextOf(rows.Value(1)).value_or("");
    const std::size_t contestant = session->Contestant(rows.Text(0), settings);
    const std::string version = TextOf(rows.Value(5)).value_or("");
    try {
      StoredRun& run = session->AddRun(
          contestant, experiment_id, rows.Text(2),
          FindAmount({{"timelimit", TextOf(rows.Value(3)).value_or("0")}}, "timelimit").value_or(0),
          statuses.Of(version), properties);
      if (progress) ReadProgress(rows.Int(8), &*progress, &run);
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

}  // namespace

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
  return session.Take(file, warnings);
}

}  // namespace planbench
