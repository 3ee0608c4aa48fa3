#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "results/statistics.h"

namespace planbench {

using Json = nlohmann::ordered_json;

/// A number and how sure it is.
struct Estimate {
  double value = 0;
  std::optional<Interval> interval;
};

/// Of a share in [0, 1].
inline Estimate Percent(double share, const Interval& interval) {
  return {100 * share, Interval{100 * interval.lower, 100 * interval.upper}};
}

/// Nothing is shown as "-", and so is a number that is not finite.
using Cell = std::variant<std::monostate, std::string, int, double, Estimate>;

/// How a column's numbers are shown.
enum class Style {
  kText,
  kCount,
  kNumber,  ///< Three significant digits.
  kRatio,   ///< The same, or more: 1 is 1 (RatioText).
  kShare,   ///< Percent, one decimal.
  kPValue,  ///< Four decimals, "< 0.0001" below.
};

struct Column {
  std::string name;     ///< Of the CSV file: with the unit, and where the column is an estimate two
                        ///< more with _lower and _upper.
  std::string heading;  ///< For readers.
  Style style = Style::kText;
  bool is_estimate = false;
};

/// A table of the report, in whatever form it is written.
struct Table {
  std::string name;  ///< Of its files, without extension.
  std::string title;
  std::string note;  ///< How it was computed.
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

/// What a reader sees: "12.3 [10.1, 15.0]".
std::string FormatCell(const Cell& cell, Style style);
/// Three significant digits, plain: 0.0123, 1.23, 123, 12300.
std::string FormatNumber(double value);

/// {name, title, note, columns: [{heading, numeric}], rows: [[text, ...], ...]}
Json TableJson(const Table& table);
/// RFC 4180, header first; numbers in full precision, what does not exist empty.
std::string TableCsv(const Table& table);
/// A tabular with booktabs rules, to be \input.
std::string TableLatex(const Table& table);

}  // namespace planbench
