#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "results/outcomes.h"
#include "results/stored_session.h"

namespace planbench {

/// A contestant of one session among those of all.
struct ComparedContestant {
  std::string name;      ///< Unique: with that of the session, or a number, where it must be.
  std::string own_name;  ///< In its session.
  std::string settings;
  std::size_t session = 0;
  /// From 1, of equal RankKeys alike: 1, 1, 3. 0 if nobody ranks, there being no problem that all
  /// contestants tried.
  int rank = 0;
  std::vector<const StoredRun*> runs;  ///< In the order of the database.

  /// Whether it has learned from problems of the set (training.h).
  bool IsTrainedOn(const std::string& problem_set) const;
};

/// What contestants rank by on problems that they all tried, the best least: penalised mean time,
/// s, and 0; where it is not known, infinity and the share solved, negative. What differs by no
/// more than the rounding of a sum is equal.
using RankKey = std::pair<double, double>;
RankKey RankKeyOf(const Outcomes& outcomes);

/// A run as the comparison knows it.
Attempt AttemptOf(const StoredRun& run, const std::string& contestant);

/// What stands for all sets together where there are several: no set is called so.
inline constexpr char kAllSets[] = "all sets";

/// Sessions side by side. Problems of one set and number are one problem, unless the sessions tell
/// of different scenes. A set that is called kAllSets has its session's name behind its own, which
/// a warning of that session says.
class ComparedSessions {
 public:
  explicit ComparedSessions(std::vector<StoredSession> sessions);
  ComparedSessions(const ComparedSessions&) = delete;
  ComparedSessions& operator=(const ComparedSessions&) = delete;

  const std::vector<StoredSession>& sessions() const { return sessions_; }
  /// Unique names: of their folders, or run ids where folders do not tell them apart.
  const std::vector<std::string>& session_names() const { return session_names_; }
  /// Sets that have the name of an earlier session's, and other scenes: what they stand as.
  const std::vector<std::string>& other_sets() const { return other_sets_; }
  /// By penalised mean time over the problems that all of them tried, the best first; those of
  /// which it is not known last, by the share of these that they solved; those that rank alike in
  /// the order of their sessions. If there is no such problem, by the same of what each tried,
  /// which ranks nobody.
  const std::vector<ComparedContestant>& contestants() const { return contestants_; }
  /// Those that are in nothing else here, as none of their runs counts: with that of the session if
  /// there are several.
  const std::vector<std::string>& without_runs() const { return without_runs_; }
  /// By set and the contestants' names.
  const OutcomesBySet& outcomes() const { return outcomes_; }
  /// Over all sets.
  const std::map<std::string, Outcomes>& pooled() const { return pooled_; }
  /// What contestants rank by: outcomes() on the problems that all contestants tried, without sets
  /// that have none; and over all sets.
  const OutcomesBySet& common() const { return common_; }
  const std::map<std::string, Outcomes>& pooled_common() const { return pooled_common_; }
  /// Attempts of each session that are in no run here, the one in the other direction being missing
  /// (awaited_attempts.h).
  const std::vector<int>& num_awaiting() const { return num_awaiting_; }

 private:
  std::vector<StoredSession> sessions_;
  std::vector<int> num_awaiting_;
  std::vector<std::string> session_names_;
  std::vector<std::string> other_sets_;
  std::vector<ComparedContestant> contestants_;
  std::vector<std::string> without_runs_;
  OutcomesBySet outcomes_;
  std::map<std::string, Outcomes> pooled_;
  OutcomesBySet common_;
  std::map<std::string, Outcomes> pooled_common_;
};

/// The contestant of that name, which there must be.
const ComparedContestant& ContestantCalled(const ComparedSessions& compared,
                                           const std::string& name);

/// How many problems all contestants tried.
int NumCommonProblems(const ComparedSessions& compared);

/// Whether contestants tried other problems than those that all of them tried.
bool TriedDifferentProblems(const ComparedSessions& compared);

/// Runs without a confirmed path that ended alike: their reasons are equal WithoutFigures.
struct FailureGroup {
  PlanStatus status = PlanStatus::kNoAnswer;
  std::string reason;  ///< Of the first.
  int num_runs = 0;
  std::map<int, int> problems;  ///< Number of runs by problem index.
};
/// Of one contestant on one set: the largest group first.
std::vector<FailureGroup> GroupFailures(const ComparedContestant& contestant,
                                        const std::string& problem_set);

}  // namespace planbench
