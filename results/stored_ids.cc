#include "results/stored_ids.h"

#include <fmt/format.h>

#include "common/error.h"
#include "common/file_kind.h"
#include "common/sqlite.h"

namespace planbench {

std::string StoredIds::Text() const {
  if (runs.empty()) return "the session " + sessions.front();
  const RunId& first = runs.front();
  const std::string repeat = first.repeats > 0 ? fmt::format(" (repeat {})", first.repeats) : "";
  if (runs.size() == 1) return fmt::format("1 run, {}{}", first.request_id, repeat);
  return fmt::format("{} runs, the first of them {}{}", runs.size(), first.request_id, repeat);
}

StoredIds ReadStoredIds(const std::filesystem::path& session_folder) {
  const std::filesystem::path database = session_folder / "results.sqlite";
  StoredIds stored;
  if (!IsFile(database)) return stored;
  try {
    SqliteConnection connection(database, SqliteConnection::Mode::kReadOnly);
    const auto read = [&](const char* sql, std::vector<std::string>* ids) {
      SqliteStatement select = connection.Prepare(sql);
      while (select.Step()) ids->push_back(select.Text(0));
    };
    std::vector<std::string> tables;
    read("SELECT name FROM sqlite_master WHERE name IN ('runs', 'sessions')", &tables);
    if (tables.size() < 2) return stored;
    read("SELECT run_id FROM sessions ORDER BY start_utime, run_id", &stored.sessions);
    std::vector<std::string> column;  // which databases of before do not have
    read("SELECT name FROM pragma_table_info('runs') WHERE name = 'repeats'", &column);
    // Those that other programs appended have no session.
    SqliteStatement select = connection.Prepare(
        fmt::format("SELECT request_id, {} FROM runs WHERE run_id IS NOT NULL ORDER BY id",
                    column.empty() ? "0" : "repeats"));
    while (select.Step()) {
      stored.runs.push_back({select.Text(0), static_cast<int>(select.Int(1))});
    }
  } catch (const SqliteError& error) {
    throw InputError(error.what());
  }
  return stored;
}

}  // namespace planbench
