#include "benchmark_driver/progress_bar.h"

#include <fmt/format.h>

namespace planbench {

ProgressBar::ProgressBar(int num_runs, const std::vector<RunRecordMessage>& earlier)
    : line_(num_runs, static_cast<int>(earlier.size())) {
  for (const RunRecordMessage& record : earlier) Count(record);
}

void ProgressBar::Count(const RunRecordMessage& record) {
  ++num_done_;
  Tally& tally = tallies_[record.planner];
  ++tally.done;
  tally.solved += record.status == PlanStatus::kSolved;
}

void ProgressBar::Add(const RunRecordMessage& record) {
  Count(record);
  std::string text;
  for (const auto& [name, tally] : tallies_) {
    text += fmt::format("{}{} {}/{}", text.empty() ? "" : "  ", name, tally.solved, tally.done);
  }
  line_.Show(num_done_, text);
}

}  // namespace planbench
