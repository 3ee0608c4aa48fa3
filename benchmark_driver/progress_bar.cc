#include "benchmark_driver/progress_bar.h"

#include <fmt/format.h>

#include <algorithm>

namespace planbench {

ProgressBar::ProgressBar(int num_runs, const RunRows& earlier)
    : line_(num_runs,
            static_cast<int>(std::count_if(earlier.rows().begin(), earlier.rows().end(),
                                           [](const RunRow& run) { return !run.is_to_repeat; }))) {
  for (const RunRow& run : earlier.rows()) Count(run);
}

void ProgressBar::Count(const RunRow& run) {
  if (run.is_to_repeat) return;
  ++num_done_;
  if (!run.asked) return;  // it has been dealt with, and tells nothing of the planner
  Tally& tally = tallies_[*run.planner];
  ++tally.done;
  tally.solved += run.confirmed();
}

void ProgressBar::Add(const RunRow& run) {
  Count(run);
  std::string text;
  for (const auto& [name, tally] : tallies_) {
    text += fmt::format("{}{} {}/{}", text.empty() ? "" : "  ", name, tally.solved, tally.done);
  }
  line_.Show(num_done_, text);
}

}  // namespace planbench
