#pragma once

#include <string>
#include <vector>

namespace planbench {

/// A table as text: columns aligned, the first `num_left` to the left, the others to the right.
/// Where the last is to the left, too, it is broken into lines, so that all are at most kTextWidth
/// but for words, such as paths, that are longer.
class TextTable {
 public:
  TextTable(std::string title, std::vector<std::string> header, int num_left);

  /// Cells are Shortened to kTextWidth, those that are broken to kLongText: whoever wants all of a
  /// text finds it in the database.
  void Add(std::vector<std::string> row);
  /// A line of its own between the rows.
  void AddHeading(std::string text);
  /// Title, header, rule, rows, then `notes`, broken into lines of at most `kTextWidth`.
  std::string Format(const std::string& notes) const;

 private:
  bool BreaksLast() const { return num_left_ == static_cast<int>(rows_[0].size()); }

  std::string title_;
  int num_left_;
  std::vector<std::vector<std::string>> rows_;  // of one cell: a heading
};

/// What tables that are read on a terminal keep to.
inline constexpr std::size_t kTextWidth = 100;

/// What they show of a text that they break into lines.
inline constexpr std::size_t kLongText = 3 * kTextWidth;

/// Breaks text into lines of at most kTextWidth at its blanks, each indented by `indent`; '\n'
/// stays.
std::string BreakLines(const std::string& text, std::size_t indent = 2);

/// `text` cut at a blank, with "...", to `width` at most.
std::string Shortened(std::string text, std::size_t width = kTextWidth);

/// How values are shown: NaN is "-".
std::string Milliseconds(double seconds);
std::string Number(double value, int decimals);

}  // namespace planbench
