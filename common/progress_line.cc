#include "common/progress_line.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "common/utf8.h"

namespace planbench {
namespace {

constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr std::chrono::seconds kLogPeriod{15};
constexpr int kBarWidth = 20;

std::string Duration(double seconds) {
  const int whole = static_cast<int>(seconds);
  return whole >= 3600 ? fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
                       : fmt::format("{}:{:02}", whole / 60, whole % 60);
}

/// Columns of the terminal that stderr is; 80 if it does not say.
std::size_t TerminalWidth() {
  winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

ProgressLine::ProgressLine(int total, int done, bool pieces_are_alike)
    : total_(total),
      done_at_first_(done),
      done_(done),
      pieces_are_alike_(pieces_are_alike),
      on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() { Print(true); }

void ProgressLine::Show(int done, const std::string& text) {
  done_ = done;
  text_ = text;
  Print(false);
}

void ProgressLine::Print(bool last) {
  const auto now = std::chrono::steady_clock::now();
  if (!last && now - shown_ < (on_terminal_ ? kTerminalPeriod : kLogPeriod)) return;
  shown_ = now;
  const int filled = total_ > 0 ? kBarWidth * done_ / total_ : kBarWidth;
  const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
  std::string line =
      fmt::format("[{:.<{}}] {}/{}  {}", std::string(static_cast<std::size_t>(filled), '#'),
                  kBarWidth, done_, total_, Duration(elapsed_s));
  const int done_here = done_ - done_at_first_;
  if (pieces_are_alike_ && done_here > 0 && done_ < total_) {
    line += fmt::format(" (about {} left)", Duration(elapsed_s / done_here * (total_ - done_)));
  }
  if (!text_.empty()) line += "  " + text_;
  if (on_terminal_) line = FirstCharacters(line, TerminalWidth() - 1);
  line = (on_terminal_ ? "\r\033[K" : "") + line + (last || !on_terminal_ ? "\n" : "");
  // Not fmt::print, which throws: that a terminal has been closed is no failure of the work.
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace planbench
