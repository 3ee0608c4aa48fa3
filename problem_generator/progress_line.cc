#include "problem_generator/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace planbench {

constexpr int kBarWidth = 20;

ProgressLine::ProgressLine(std::string what, int total)
    : what_(std::move(what)), total_(total), on_terminal_(isatty(STDERR_FILENO) == 1) {
  Show(0);
}

ProgressLine::~ProgressLine() {
  if (on_terminal_) std::fputc('\n', stderr);
}

void ProgressLine::Show(int done) {
  if (!on_terminal_) return;
  const auto filled = static_cast<std::size_t>(kBarWidth * done / std::max(total_, 1));
  const std::string line = fmt::format("\r\033[K{} [{}{}] {}/{}", what_, std::string(filled, '#'),
                                       std::string(kBarWidth - filled, '.'), done, total_);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace planbench
