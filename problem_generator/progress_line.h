#pragma once

#include <string>

namespace planbench {

/// A bar on stderr that is rewritten in place; nothing at all if stderr is no terminal. Not
/// thread-safe.
class ProgressLine {
 public:
  ProgressLine(std::string what, int total);
  /// Ends the line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void Show(int done);

 private:
  std::string what_;
  int total_;
  bool on_terminal_;
};

}  // namespace planbench
