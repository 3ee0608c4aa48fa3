#pragma once

#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "planning/plan_status.h"

namespace planbench {

/// What a comparison knows of one run: an attempt at a problem in one direction.
struct Attempt {
  std::string problem_set;
  int problem_index = 0;
  std::string contestant;
  int trial = 1;
  Direction direction = Direction::kForward;
  PlanStatus status = PlanStatus::kNoAnswer;  ///< Final, the referee's word included.
  bool claimed = false;                       ///< The planner says that it found a path.
  double time_s = 0;  ///< Planning time; without an answer, the time waited.
  double time_limit_s = 0;
};

/// Whether a path that took so long came too late, but for what rounding makes of times that were
/// added up or written as text.
inline bool IsLate(double time_s, double time_limit_s) {
  return time_s > (1 + 1e-9) * time_limit_s;
}

/// So much time, s, that is untold or beyond the limit is told. Searches of ours that look seldom
/// at the clock have gone on for 0.6 s.
inline constexpr double kMuchTime_s = 1;

/// Times that a planner told and that cannot be, or that leave much untold, and a cost that cannot
/// be: counters of its run, s or in the planner's unit, and what is to be said of runs that have
/// them, with the largest.
struct OddTimes {
  const char* counter;
  const char* text;
};
/// The longest that was told, where it is more than passed until the answer came.
inline constexpr char kToldTime[] = "told_time";
/// By how much planning time, phases or progress go beyond the total time, or the first
/// improvement, or the end of a search for one path alone, beyond the planning time.
inline constexpr char kContradictoryTime[] = "contradictory_time";
/// What is left of the round trip of an answer that came after the time limit.
inline constexpr char kUntoldTime[] = "untold_time";
/// What a failed attempt did not tell of, and counts all the same.
inline constexpr char kUntoldFailure[] = "untold_failure";
/// How long a search went on beyond the limit with a path in hand, if longer than kMuchTime_s.
inline constexpr char kOverrunTime[] = "overrun_time";
/// By how much a path costs more than the last improvement.
inline constexpr char kContradictoryCost[] = "contradictory_cost";
inline constexpr OddTimes kOddTimes[] = {
    {kToldTime,
     "were told to have taken more time than passed until the answer came, up to {:.3g} s: the "
     "round trip counts in its place"},
    {kContradictoryTime,
     "were told times of which a part is longer than the total, or a planning time that ends "
     "before the first improvement, or, where none was asked for, before the search, by up to "
     "{:.3g} s: planning time and total are taken as the longer of them, parts as shares of it"},
    {kUntoldTime,
     "were answered after the time limit though less time was told; up to {:.3g} s are not "
     "accounted for"},
    {kUntoldFailure,
     "failed in more time than was told, up to {:.3g} s more: the round trip counts in its place, "
     "the limit at most"},
    {kOverrunTime,
     "searched on after the time limit, for up to {:.3g} s: what they improved then is in no curve "
     "over time, and no measure of path quality counts their paths, which may owe to it"},
    {kContradictoryCost,
     "were told improvements that cost less than the path that came of them, by up to {:.3g}: none "
     "counts as cheaper than that"},
};
inline constexpr std::size_t kNumOddTimes = std::size(kOddTimes);
/// Largest of each of kOddTimes; 0 if there is none.
using OddTimesFound = std::array<double, kNumOddTimes>;

/// Where kOverrunTime stands.
inline constexpr std::size_t kOverrunIndex = [] {
  std::size_t i = 0;
  while (std::string_view(kOddTimes[i].counter) != kOverrunTime) ++i;
  return i;
}();
/// Whether a path may owe to a search that went on after the limit: no measure of it counts.
inline bool OwesToOverrun(const OddTimesFound& run) { return run[kOverrunIndex] > 0; }

/// A line on each of kOddTimes that runs have, beginning with the contestant's name.
std::vector<std::string> DescribeOddTimes(const std::string& contestant,
                                          const std::vector<OddTimesFound>& runs);

/// How the attempts of one contestant and trial at one problem ended.
struct Outcome {
  enum class Kind {
    kForward,     ///< Solved from start to goal.
    kBackward,    ///< Solved from goal to start, and not from start to goal.
    kFailure,     ///< Out of time, memory or search space.
    kUnsolvable,  ///< Start or goal found invalid.
    kRejected,    ///< The referee found the path invalid.
    kNoAnswer,    ///< The planner died or fell silent.
    kRefused,     ///< The request was refused, or cancelled before there was an answer.
  };
  Kind kind = Kind::kNoAnswer;
  bool claimed = false;
  double time_s = 0;  ///< To the confirmed path, failed attempts before it included; else infinite.
  double solving_time_s = 0;  ///< Of the attempt that found it alone; else infinite.
  int trial = 1;
  /// The longest that anybody had for an attempt at this problem; 0: not known.
  double time_limit_s = 0;

  bool confirmed() const { return kind == Kind::kForward || kind == Kind::kBackward; }
};

/// Either may be null, not both: success counts first, forward before backward; then a path that
/// was rejected, an invalid end, no answer, a request refused; failure if there was nothing else.
Outcome FoldAttempts(const Attempt* forward, const Attempt* backward);

/// The outcomes of one contestant on one set.
struct Outcomes {
  std::map<int, std::vector<Outcome>> by_problem;  ///< By index; the trials in ascending order.
  double time_limit_s = 0;                         ///< Its longest of a single attempt.

  int num_runs() const;
};

/// Of each contestant what all of them tried; none has a problem if there is none in common.
std::map<std::string, Outcomes> OnCommonProblems(std::map<std::string, Outcomes> contestants);

/// By problem set, then by contestant.
using OutcomesBySet = std::map<std::string, std::map<std::string, Outcomes>>;
/// The attempts may come in any order.
OutcomesBySet GroupOutcomes(const std::vector<Attempt>& attempts);

/// All sets as one, by contestant. Its problems are numbered from 0, by set and index; the time
/// limit is the longest.
std::map<std::string, Outcomes> PoolSets(const OutcomesBySet& sets);

}  // namespace planbench
