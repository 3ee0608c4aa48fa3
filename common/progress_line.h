#pragma once

#include <chrono>
#include <string>

namespace planbench {

/// How far work has come, on stderr: a bar, what the caller says, the time gone and about how much
/// is left, where that can be told. One line that is rewritten on a terminal, else a line now and
/// then. Not thread-safe.
class ProgressLine {
 public:
  /// Of `total` pieces of work, `done` are done already: they do not bear on the estimate. Where
  /// pieces are not alike, those that are done tell nothing of the others: there is no estimate.
  explicit ProgressLine(int total, int done = 0, bool pieces_are_alike = true);
  /// Shows the last state and ends the line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void Show(int done, const std::string& text);
  /// One piece of work less.
  void Drop() { --total_; }

 private:
  void Print(bool last);

  int total_;
  int done_at_first_;
  int done_;
  bool pieces_are_alike_;
  std::string text_;
  bool on_terminal_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point shown_ = begin_;
};

}  // namespace planbench
