#include "planning/search_query.h"

#include <atomic>

namespace planbench {

bool SearchQuery::Cancelled() const { return control_->cancelled.load(std::memory_order_relaxed); }

double SearchQuery::RemainingSeconds() const {
  const double end_s = path_held_s_ ? time_limit_s_ : turn_ends_s_.value_or(time_limit_s_);
  return end_s - clock_.seconds();
}

bool SearchQuery::ShouldStop() const { return Cancelled() || RemainingSeconds() <= 0; }

void SearchQuery::ReportSolution(double epsilon, double cost, std::int64_t expansions) {
  HoldPath();
  if (!anytime_) return;
  progress_.push_back({clock_.seconds(), epsilon, cost, expansions});
  if (control_->on_progress) control_->on_progress(progress_.back());
}

void SearchQuery::HoldPath() {
  if (!path_held_s_) path_held_s_ = clock_.seconds();
}

}  // namespace planbench
