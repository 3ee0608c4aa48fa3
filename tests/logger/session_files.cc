#include "session_files.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "common/sqlite.h"

namespace planbench {

std::string TextOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

void WriteText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string DumpDatabase(const std::filesystem::path& file) {
  SqliteConnection connection(file, SqliteConnection::Mode::kReadOnly);
  std::vector<std::string> tables;
  SqliteStatement names =
      connection.Prepare("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name");
  while (names.Step()) tables.push_back(names.Text(0));
  std::string dump;
  for (const std::string& table : tables) {
    const std::int64_t num_columns = std::get<std::int64_t>(
        connection.QueryValue("SELECT count(*) FROM pragma_table_xinfo('" + table + "')"));
    dump += "-- " + table + "\n";
    SqliteStatement rows = connection.Prepare("SELECT * FROM " + table);
    while (rows.Step()) {
      for (int column = 0; column < num_columns; ++column) {
        const bool null = std::holds_alternative<std::monostate>(rows.Value(column));
        dump += null ? "NULL|" : fmt::format("'{}'|", rows.Text(column));
      }
      dump += "\n";
    }
  }
  return dump;
}

}  // namespace planbench
