#include "report/table.h"

#include <fmt/format.h>

#include <cmath>

#include "results/paired.h"

namespace planbench {
namespace {

std::string FormatValue(double value, Style style) {
  if (!std::isfinite(value)) return "-";
  switch (style) {
    case Style::kShare:
      return fmt::format("{:.1f}", value);
    case Style::kRatio:
      return RatioText(value, FormatNumber(value));
    case Style::kPValue:
      return value < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", value);
    default:
      return FormatNumber(value);
  }
}

std::string CsvText(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

std::string CsvNumber(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string LatexText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '\\':
        escaped += "\\textbackslash{}";
        break;
      case '-':  // Two would be one dash.
        escaped += escaped.ends_with('-') ? "{}-" : "-";
        break;
      case '~':
        escaped += "\\textasciitilde{}";
        break;
      case '^':
        escaped += "\\textasciicircum{}";
        break;
      case '<':
      case '>':
        escaped += fmt::format("${}$", c);
        break;
      case '#':
      case '$':
      case '%':
      case '&':
      case '_':
      case '{':
      case '}':
        escaped += '\\';
        [[fallthrough]];
      default:
        escaped += c;
    }
  }
  return escaped;
}

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

}  // namespace

std::string FormatNumber(double value) {
  if (value == 0) return "0";
  if (!std::isfinite(value)) return "-";
  const double magnitude = std::abs(value);
  if (magnitude < 1e-4 || magnitude >= 1e7) return fmt::format("{:.2e}", value);
  // Decimals after rounding to three digits: 9.999 has as many as 10.0.
  const double exponent = std::floor(std::log10(magnitude * (1 + 5e-4)));
  return fmt::format("{:.{}f}", value, std::max(0, 2 - static_cast<int>(exponent)));
}

std::string FormatCell(const Cell& cell, Style style) {
  return std::visit(Overloaded{[](std::monostate) { return std::string("-"); },
                               [](const std::string& text) { return text; },
                               [](int count) { return fmt::format("{}", count); },
                               [&](double value) { return FormatValue(value, style); },
                               [&](const Estimate& estimate) {
                                 std::string text = FormatValue(estimate.value, style);
                                 if (estimate.interval && std::isfinite(estimate.value)) {
                                   text += fmt::format(
                                       " [{}, {}]", FormatValue(estimate.interval->lower, style),
                                       FormatValue(estimate.interval->upper, style));
                                 }
                                 return text;
                               }},
                    cell);
}

Json TableJson(const Table& table) {
  Json json = {{"name", table.name}, {"title", table.title}, {"note", table.note}};
  json["columns"] = Json::array();
  for (const Column& column : table.columns) {
    json["columns"].push_back(
        {{"heading", column.heading}, {"numeric", column.style != Style::kText}});
  }
  json["rows"] = Json::array();
  for (const std::vector<Cell>& row : table.rows) {
    Json texts = Json::array();
    for (std::size_t i = 0; i < row.size(); ++i) {
      texts.push_back(FormatCell(row[i], table.columns[i].style));
    }
    json["rows"].push_back(std::move(texts));
  }
  return json;
}

std::string TableCsv(const Table& table) {
  std::string csv;
  const auto add = [&](const std::string& text) {
    if (!csv.empty() && csv.back() != '\n') csv += ',';
    csv += text;
  };
  // A first cell that is empty would not be told from the beginning of the line: none is.
  for (const Column& column : table.columns) {
    add(column.name);
    if (column.is_estimate) {
      add(column.name + "_lower");
      add(column.name + "_upper");
    }
  }
  csv += "\r\n";
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      std::visit(Overloaded{[&](std::monostate) { add(""); },
                            [&](const std::string& text) { add(CsvText(text)); },
                            [&](int count) { add(fmt::format("{}", count)); },
                            [&](double value) { add(CsvNumber(value)); },
                            [&](const Estimate& e) { add(CsvNumber(e.value)); }},
                 row[i]);
      if (!table.columns[i].is_estimate) continue;
      const auto* estimate = std::get_if<Estimate>(&row[i]);
      const bool known = estimate != nullptr && estimate->interval.has_value();
      add(known ? CsvNumber(estimate->interval->lower) : "");
      add(known ? CsvNumber(estimate->interval->upper) : "");
    }
    csv += "\r\n";
  }
  return csv;
}

std::string TableLatex(const Table& table) {
  std::string layout;
  for (const Column& column : table.columns) layout += column.style == Style::kText ? 'l' : 'r';
  std::string latex =
      fmt::format("% {}\n\\begin{{tabular}}{{{}}}\n\\toprule\n", table.title, layout);
  const auto add_row = [&](const std::vector<std::string>& texts) {
    // The end of the row before would take these for what belongs to it.
    if (texts.front().starts_with('[') || texts.front().starts_with('*')) latex += "{}";
    for (std::size_t i = 0; i < texts.size(); ++i) {
      latex += (i > 0 ? " & " : "") + LatexText(texts[i]);
    }
    latex += " \\\\\n";
  };
  std::vector<std::string> headings;
  for (const Column& column : table.columns) headings.push_back(column.heading);
  add_row(headings);
  latex += "\\midrule\n";
  for (const std::vector<Cell>& row : table.rows) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < row.size(); ++i) {
      texts.push_back(FormatCell(row[i], table.columns[i].style));
    }
    add_row(texts);
  }
  return latex + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace planbench
