#pragma once

#include <string>
#include <vector>

namespace planbench {

/// A table as text: columns aligned, the first `num_left` to the left, the others to the right.
class TextTable {
 public:
  TextTable(std::string title, std::vector<std::string> header, int num_left);

  /// Cells are Shortened to kTextWidth: whoever wants all of a text finds it in the database.
  void Add(std::vector<std::string> row);
  /// A line of its own between the rows.
  void AddHeading(std::string text);
  /// Title, header, rule, rows, then `notes`, broken into lines of at most `kTextWidth`.
  std::string Format(const std::string& notes) const;

 private:
  std::string title_;
  int num_left_;
  std::vector<std::vector<std::string>> rows_;  // of one cell: a heading
};

/// What tables that are read on a terminal keep to.
inline constexpr std::size_t kTextWidth = 100;

/// Breaks text into lines of at most kTextWidth at its blanks, each indented by `indent`; '\n'
/// stays.
std::string BreakLines(const std::string& text, std::size_t indent = 2);

/// `text` cut at a blank, with "...", to `width` at most.
std::string Shortened(std::string text, std::size_t width = kTextWidth);

/// How values are shown: NaN is "-".
std::string Milliseconds(double seconds);
std::string Number(double value, int decimals);

}  // namespace planbench
