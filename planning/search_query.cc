#include "planning/planner.h"

namespace planbench {

double SearchQuery::ElapsedSeconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

bool SearchQuery::Cancelled() const { return control_->cancelled.load(std::memory_order_relaxed); }

double SearchQuery::RemainingSeconds() const { return time_limit_s_ - ElapsedSeconds(); }

bool SearchQuery::ShouldStop() const { return Cancelled() || RemainingSeconds() <= 0; }

void SearchQuery::ReportSolution(double epsilon, double cost, std::int64_t expansions) {
  progress_.push_back({ElapsedSeconds(), epsilon, cost, expansions});
  if (control_->on_progress) control_->on_progress(progress_.back());
}

}  // namespace planbench
