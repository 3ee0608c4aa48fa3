#include "planning/search_query.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "planning/proven_bound.h"

namespace planbench {
namespace {

/// Work of a step of a search, a configuration checked being 1: steps that check nothing count too.
constexpr double kStepWork = 10;

}  // namespace

bool SearchQuery::Cancelled() const { return control_->cancelled.load(std::memory_order_relaxed); }

double SearchQuery::RemainingSeconds() const {
  return turn_ends_s_.value_or(time_limit_s_) - clock_.seconds();
}

bool SearchQuery::IsOver() const { return Cancelled() || clock_.seconds() >= time_limit_s_; }

bool SearchQuery::ShouldStop() const { return Cancelled() || RemainingSeconds() <= 0; }

double SearchQuery::Work() const {
  return static_cast<double>(edges_->counters().configurations) +
         kStepWork * static_cast<double>(num_steps_);
}

bool SearchQuery::TurnIsOver() {
  ++num_steps_;
  return Work() >= turn_ends_work_;
}

void SearchQuery::Keep(std::shared_ptr<void> search, std::size_t bytes) {
  TakeKept();
  kept_.push_back({turn_, std::move(search), bytes});
  kept_bytes_ += bytes;
}

std::shared_ptr<void> SearchQuery::TakeKept() { return TakeKeptOf(turn_); }

bool SearchQuery::IsKept(std::size_t goal) const {
  return std::ranges::find(kept_, goal, &KeptSearch::goal) != kept_.end();
}

std::shared_ptr<void> SearchQuery::TakeKeptOf(std::size_t goal) {
  const auto kept = std::ranges::find(kept_, goal, &KeptSearch::goal);
  if (kept == kept_.end()) return nullptr;
  kept_bytes_ -= kept->bytes;
  std::shared_ptr<void> search = std::move(kept->search);
  kept_.erase(kept);
  return search;
}

void SearchQuery::DropLastKept() { TakeKeptOf(kept_.back().goal); }

void SearchQuery::ReportSolution(double lower_bound, double cost, std::int64_t expansions) {
  if (cost < known_cost_) HoldPath();
  if (!anytime_) return;
  cost = std::min(cost, known_cost_);
  const double epsilon =
      ToldEpsilon(cost, std::min(std::max(lower_bound, lower_bound_), lower_bound_of_others_));
  if (!progress_.empty()) {
    const PlanProgress& last = progress_.back();
    const bool proves_more = epsilon > 0 && (last.epsilon == 0 || epsilon < last.epsilon);
    // A search that goes on in a larger space has lost its proof.
    const bool proves_less = last.epsilon > 0 && (epsilon == 0 || epsilon > last.epsilon);
    if (proves_less || (cost >= last.cost && !proves_more)) return;
  }
  progress_.push_back({clock_.seconds(), epsilon, cost, expansions_before_ + expansions});
  if (control_->on_progress) control_->on_progress(progress_.back());
}

void SearchQuery::HoldPath() {
  turn_ends_s_.reset();
  if (!path_held_s_) path_held_s_ = clock_.seconds();
}

}  // namespace planbench
