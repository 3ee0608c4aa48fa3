#include "benchmark_driver/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

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

}  // namespace

ProgressBar::ProgressBar(int num_runs)
    : num_runs_(num_runs), shown_(begin_), on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() { Show(true); }

void ProgressBar::Count(const RunRecordMessage& record) {
  ++num_done_;
  Tally& tally = tallies_[record.planner + " " + std::string(EnumName(record.request.direction))];
  ++tally.done;
  tally.solved += record.status == PlanStatus::kSolved;
}

void ProgressBar::AddEarlier(const RunRecordMessage& record) {
  Count(record);
  ++num_earlier_;
}

void ProgressBar::Add(const RunRecordMessage& record) {
  Count(record);
  Show(false);
}

std::string ProgressBar::Line() const {
  const int filled = num_runs_ > 0 ? kBarWidth * num_done_ / num_runs_ : kBarWidth;
  std::string line = fmt::format("[{}{}] {}/{}", std::string(static_cast<std::size_t>(filled), '#'),
                                 std::string(static_cast<std::size_t>(kBarWidth - filled), '.'),
                                 num_done_, num_runs_);
  for (const auto& [name, tally] : tallies_) {
    line += fmt::format("  {} {}/{}", name, tally.solved, tally.done);
  }
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  const int done_here = num_done_ - num_earlier_;
  line += "  " + Duration(elapsed);
  if (done_here > 0 && num_done_ < num_runs_) {
    line += " (about " + Duration(elapsed / done_here * (num_runs_ - num_done_)) + " left)";
  }
  return line;
}

void ProgressBar::Show(bool last) {
  const auto now = std::chrono::steady_clock::now();
  const auto since = now - shown_;
  if (on_terminal_) {
    if (!last && since < kTerminalPeriod) return;
    std::fprintf(stderr, "\r\033[K%s%s", Line().c_str(), last ? "\n" : "");
  } else {
    if (!last && since < kLogPeriod) return;
    std::fprintf(stderr, "%s\n", Line().c_str());
  }
  std::fflush(stderr);
  shown_ = now;
}

}  // namespace planbench
