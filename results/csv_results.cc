#include "results/csv_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/read_text.h"
#include "common/text.h"

namespace planbench {
namespace {

/// The rows of a file.
class RowReader {
 public:
  RowReader(std::string file, std::string text) : file_(std::move(file)), lines_(std::move(text)) {}

  /// Cells of the next row, nothing after the last; lines without anything are none. Throws
  /// InputError for a quote that is not closed.
  std::vector<std::string> Next() {
    std::vector<std::string> cells;
    bool in_quotes = false;
    for (std::string text; (cells.empty() || in_quotes) && std::getline(lines_, text);) {
      ++num_lines_;
      if (text.ends_with('\r')) text.pop_back();
      if (text.empty() && cells.empty()) continue;
      if (cells.empty()) line_ = num_lines_;
      in_quotes = TakeLine(text, in_quotes, &cells);
    }
    if (!in_quotes) return cells;
    throw InputError(fmt::format(
        "{}:{}: a quote (\") is not closed: close it, or double it within the text", file_, line_));
  }
  /// Where the row begins that was read last.
  int line() const { return line_; }

 private:
  /// Adds the cells of a line, the first of which goes on with the last one of `cells` if that is
  /// `in_quotes`, and returns whether the last one goes on so in the next line. Cells that begin
  /// with a quote are quoted; a quote within is doubled, and the end of a line becomes a space.
  static bool TakeLine(const std::string& text, bool in_quotes, std::vector<std::string>* cells) {
    if (in_quotes) {
      cells->back() += ' ';
    } else {
      cells->emplace_back();
    }
    for (std::size_t i = 0; i < text.size(); ++i) {
      std::string& cell = cells->back();
      if (text[i] == '"' && in_quotes && i + 1 < text.size() && text[i + 1] == '"') {
        cell += text[++i];
      } else if (text[i] == '"' && (in_quotes || cell.find_first_not_of(' ') == cell.npos)) {
        in_quotes = !in_quotes;
      } else if (text[i] == ',' && !in_quotes) {
        cells->emplace_back();
      } else {
        cell += text[i];
      }
    }
    return in_quotes;
  }

  std::string file_;
  std::istringstream lines_;
  int num_lines_ = 0;
  int line_ = 0;
};

/// Of two columns of one name only one could be believed. Columns without a name are never read.
void RequireDistinct(const std::vector<std::string>& header, const std::string& file, int line) {
  std::set<std::string> names;
  for (const std::string& name : header) {
    if (name.empty() || names.insert(name).second) continue;
    throw InputError(
        fmt::format("{}:{}: two columns are called '{}': remove one or give it another name", file,
                    line, name));
  }
}

/// What every row needs. `place`: of the header.
void RequireColumns(const std::vector<std::string>& header, const std::string& place) {
  if (header.size() == 1 && header[0].find_first_of(";\t") != std::string::npos) {
    throw InputError(fmt::format(
        "{}: columns are separated by {}: write the file with commas between them, and points in "
        "numbers",
        place, header[0].find(';') != std::string::npos ? "';'" : "tabs"));
  }
  const auto has = [&](const char* name) {
    return std::find(header.begin(), header.end(), name) != header.end();
  };
  for (const char* name : {"problem_set", "problem_index", "solved", "time_s"}) {
    if (has(name) || (name == std::string_view("problem_index") && has("query_index"))) continue;
    throw InputError(fmt::format("{}: no column '{}'", place, name));
  }
}

/// The cells of one row, by column.
class Row {
 public:
  Row(const std::string& file, int line, const std::vector<std::string>& header,
      std::vector<std::string> cells)
      : file_(file), line_(line), header_(header), cells_(std::move(cells)) {
    if (cells_.size() != header.size()) {
      throw InputError(
          fmt::format("{}:{}: {} values for {} columns", file, line, cells_.size(), header.size()));
    }
  }

  bool Has(const std::string& column) const { return Find(column) != nullptr; }
  /// Of a column that it has.
  const std::string& Text(const std::string& column) const { return *Find(column); }
  /// Whether there is a number to be read: where there is none, cells are empty or say nan.
  bool Tells(const std::string& column) const {
    const std::string* text = Find(column);
    return text != nullptr && !text->empty() && *text != "nan" && *text != "NaN";
  }
  double Number(const std::string& column, double least, double most) const {
    const std::string& text = Text(column);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= least) ||
        !(value <= most)) {
      Fail(column, fmt::format("a number from {} to {}", least, most));
    }
    return value;
  }
  int Int(const std::string& column, int least, int most) const {
    const double value = Number(column, least, most);
    if (value != std::floor(value))
      Fail(column, fmt::format("a whole number from {} to {}", least, most));
    return static_cast<int>(value);
  }
  [[noreturn]] void Fail(const std::string& column, const std::string& wanted) const {
    throw InputError(
        fmt::format("{}:{}: {}: '{}' is not {}", file_, line_, column, Text(column), wanted));
  }

 private:
  const std::string* Find(const std::string& column) const {
    const auto found = std::find(header_.begin(), header_.end(), column);
    return found == header_.end() ? nullptr
                                  : &cells_[static_cast<std::size_t>(found - header_.begin())];
  }

  const std::string& file_;
  int line_;
  const std::vector<std::string>& header_;
  std::vector<std::string> cells_;
};

constexpr int kMostProblems = 1'000'000;
constexpr double kLongest = 1e9;  // s

/// From 1, whichever of the two columns tells it.
int ReadProblemIndex(const Row& row) {
  if (!row.Has("query_index")) return row.Int("problem_index", 1, kMostProblems);
  const int index = row.Int("query_index", 0, kMostProblems) + 1;
  if (row.Has("problem_index") && row.Int("problem_index", 1, kMostProblems) != index) {
    row.Fail("problem_index",
             fmt::format("{}, which query_index tells, as it counts from 0: remove one of the two "
                         "columns",
                         index));
  }
  return index;
}

StoredRun ReadRun(const Row& row) {
  StoredRun run;
  run.problem_set = row.Text("problem_set");
  if (run.problem_set.empty()) row.Fail("problem_set", "the name of a problem set");
  run.problem_index = ReadProblemIndex(row);
  run.claimed = row.Int("solved", 0, 1) == 1;
  run.status = run.claimed ? PlanStatus::kSolved : PlanStatus::kTimedOut;
  if (run.claimed || row.Tells("time_s")) run.time_s = row.Number("time_s", 0, kLongest);
  if (row.Tells("time_limit_s")) run.time_limit_s = row.Number("time_limit_s", 0, kLongest);
  if (row.Has("trial")) run.trial = row.Int("trial", 1, kMostProblems);
  if (row.Has("direction")) {
    const auto direction = ParseEnum<Direction>(row.Text("direction"));
    if (!direction) row.Fail("direction", "forward or backward");
    run.direction = *direction;
  }
  if (row.Has("reason")) run.message = row.Text("reason");
  const auto measure = [&](const std::string& column, const char* name, MeasuredValues* values) {
    if (row.Tells(column)) {
      (*values)[name] = row.Number(column, 0, kLongest);
    }
  };
  for (const PathMeasure& one : PathMeasures()) {
    measure(one.name, one.name, &run.measures);
    measure(std::string(one.name) + "_simplified", one.name, &run.measures_simple);
  }
  return run;
}

}  // namespace

StoredSession ReadCsvResults(const std::filesystem::path& file, const std::string& name) {
  const std::string file_name = file.string();
  std::string text = ReadText(file);
  RefuseUtf16(text, file_name);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // The mark of UTF-8.
  RowReader rows(file_name, std::move(text));
  const std::vector<std::string> header = rows.Next();
  StoredSession session;
  session.is_csv = true;
  session.contestants = {{name, "imported from " + file_name + "\n"}};
  if (header.empty()) return session;
  RequireDistinct(header, file_name, rows.line());
  RequireColumns(header, fmt::format("{}:{}", file_name, rows.line()));
  using Key = std::tuple<std::string, int, Direction>;
  std::map<Key, int> num_rows;
  std::set<std::pair<Key, int>> trials;
  for (auto cells = rows.Next(); !cells.empty(); cells = rows.Next()) {
    const Row row(file_name, rows.line(), header, std::move(cells));
    StoredRun run = ReadRun(row);
    run.id = rows.line();
    const Key key(run.problem_set, run.problem_index, run.direction);
    if (!row.Has("trial")) run.trial = ++num_rows[key];
    if (!trials.emplace(key, run.trial).second) {
      row.Fail("trial", fmt::format("a trial of its own of problem {} of '{}'", run.problem_index,
                                    run.problem_set));
    }
    session.runs.push_back(std::move(run));
  }
  return session;
}

}  // namespace planbench
