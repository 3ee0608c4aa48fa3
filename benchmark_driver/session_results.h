#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmark_driver/run_rows.h"
#include "messaging/messages.h"
#include "results/outcomes.h"
#include "results/reason_count.h"

namespace planbench {

/// One contestant on one set.
struct ContestantResults {
  const Contestant* contestant = nullptr;
  bool is_reference = false;  ///< Results from elsewhere, which no referee has seen.
  bool is_trained = false;    ///< It has learned from problems of the set (training.h).
  Outcomes outcomes;
  std::vector<const RunRow*> runs;  ///< By problem, trial and direction.

  /// Its name in tables of the set.
  std::string label() const;
};

/// One set: its contestants in the order of the line-up.
struct SetResults {
  std::string name;
  std::vector<ContestantResults> contestants;
};

/// The runs of a session, by set (ascending) and contestant.
class SessionResults {
 public:
  /// Contestants of runs that the conditions do not know (of an earlier part of the session)
  /// come last, after these those of `references`, of which the problems that the session has are
  /// kept. `runs` must outlive this.
  SessionResults(const SessionConditions& conditions, const RunRows& runs,
                 const std::vector<Attempt>& references);
  SessionResults(const SessionResults&) = delete;
  SessionResults& operator=(const SessionResults&) = delete;

  const std::vector<Contestant>& contestants() const { return contestants_; }
  const std::vector<SetResults>& sets() const { return sets_; }
  /// Attempts that failed and are in no set's results, since the one in the other direction, which
  /// was to follow, is missing: what becomes of their trials is not known.
  int num_awaiting() const { return num_awaiting_; }
  /// Runs that were not asked for (messaging/asked_runs.h), in no set's results either, and why.
  int num_not_asked() const { return num_not_asked_; }
  const ReasonCount& why_not_asked() const { return why_not_asked_; }
  /// A contestant's name where all sets are shown together.
  std::string LabelOf(const Contestant& contestant) const;

 private:
  std::vector<Contestant> contestants_;
  std::vector<SetResults> sets_;
  int num_awaiting_ = 0;
  int num_not_asked_ = 0;
  ReasonCount why_not_asked_;
};

}  // namespace planbench
