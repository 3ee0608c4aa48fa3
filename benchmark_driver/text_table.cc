#include "benchmark_driver/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace planbench {
namespace {

/// `text` broken into lines that begin where `begin` ends, in the first of which that stands.
std::string Beside(const std::string& begin, const std::string& text) {
  std::string lines = BreakLines(text, begin.size());
  return lines.replace(0, std::min(begin.size(), lines.find_first_not_of(' ')), begin);
}

}  // namespace

TextTable::TextTable(std::string title, std::vector<std::string> header, int num_left)
    : title_(std::move(title)), num_left_(num_left) {
  rows_.push_back(std::move(header));
}

void TextTable::Add(std::vector<std::string> row) {
  for (std::string& cell : row) {
    const bool is_broken = BreaksLast() && &cell == &row.back();
    cell = Shortened(std::move(cell), is_broken ? kLongText : kTextWidth);
  }
  rows_.push_back(std::move(row));
}

void TextTable::AddHeading(std::string text) { rows_.push_back({Shortened(std::move(text))}); }

std::string TextTable::Format(const std::string& notes) const {
  const std::size_t num_columns = rows_[0].size();
  std::vector<std::size_t> widths(num_columns, 0);
  for (const auto& row : rows_) {
    if (row.size() != num_columns) continue;
    for (std::size_t c = 0; c < num_columns; ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  if (BreaksLast()) {
    std::size_t left = kTextWidth - 2;
    for (std::size_t c = 0; c + 1 < num_columns; ++c) left -= std::min(left, widths[c] + 2);
    widths.back() = std::min(widths.back(), left);
  }
  std::string text = title_ + "\n";
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const auto& row = rows_[r];
    const bool is_heading = row.size() != num_columns;
    std::string line = "  ";
    if (is_heading) line += row[0];
    const std::size_t num_aligned = is_heading ? 0 : BreaksLast() ? num_columns - 1 : num_columns;
    for (std::size_t c = 0; c < num_aligned; ++c) {
      line += static_cast<int>(c) < num_left_ ? fmt::format("{:<{}}  ", row[c], widths[c])
                                              : fmt::format("{:>{}}  ", row[c], widths[c]);
    }
    if (!is_heading && BreaksLast()) line = Beside(line, row.back());
    line.erase(line.find_last_not_of(" \n") + 1);
    text += line + "\n";
    if (r == 0) {
      std::size_t total = 0;
      for (const std::size_t width : widths) total += width + 2;
      text += "  " + std::string(total - 2, '-') + "\n";
    }
  }
  return text + BreakLines(notes);
}

std::string BreakLines(const std::string& text, std::size_t indent) {
  std::string broken;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string current;
    for (std::string word; words >> word;) {
      if (!current.empty() && indent + current.size() + 1 + word.size() > kTextWidth) {
        broken += std::string(indent, ' ') + current + "\n";
        current.clear();
      }
      current += (current.empty() ? "" : " ") + word;
    }
    broken += std::string(current.empty() ? 0 : indent, ' ') + current + "\n";
  }
  return broken;
}

std::string Shortened(std::string text, std::size_t width) {
  if (text.size() <= width) return text;
  std::size_t end = std::min(text.find_last_of(' ', width - 4), width - 4);
  // Not within a character of UTF-8.
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  text.resize(end);
  return text.substr(0, text.find_last_not_of(' ') + 1) + " ...";
}

std::string Milliseconds(double seconds) {
  if (std::isnan(seconds)) return "-";
  const double ms = seconds * 1e3;
  return ms < 10     ? fmt::format("{:.3f}", ms)
         : ms < 1000 ? fmt::format("{:.1f}", ms)
                     : fmt::format("{:.0f}", ms);
}

std::string Number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

}  // namespace planbench
