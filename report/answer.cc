#include "report/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "common/lookup.h"
#include "report/doubts.h"
#include "report/table.h"
#include "report/trained.h"
#include "report/wording.h"

namespace planbench {
namespace {

/// "97.5 % of the problems (95 % interval 92.3 to 99.2)"
std::string SolvedShare(const Outcomes& outcomes) {
  const SuccessSummary s = SummarizeSuccess(outcomes);
  return fmt::format("{:.1f} % of the problems (95 % interval {:.1f} to {:.1f})", 100 * s.share,
                     100 * s.interval.lower, 100 * s.interval.upper);
}

std::string MedianTime(const Outcomes& outcomes) {
  const TimeSummary s = SummarizeTimes(outcomes);
  if (s.solved_s.count == 0) return "";
  std::string text = fmt::format(", in a median of {} ms", FormatNumber(1e3 * s.solved_s.median));
  if (s.median_interval_s) {
    text += fmt::format(" ({} to {})", FormatNumber(1e3 * s.median_interval_s->lower),
                        FormatNumber(1e3 * s.median_interval_s->upper));
  }
  return text;
}

/// What a contestant is called here, where its figures are of all sets.
std::string Called(const ComparedSessions& compared, const std::string& name) {
  const std::string mark = MarkOf(compared, ContestantCalled(compared, name));
  return mark.empty() ? name : name + " " + mark;
}

/// The pairs of the leader over all sets.
std::vector<const ComparedPair*> LeadersPairs(const ComparedSessions& compared,
                                              const std::vector<ComparedPair>& pairs) {
  const bool several = compared.outcomes().size() > 1;
  std::vector<const ComparedPair*> of_leader;
  for (const ComparedPair& pair : pairs) {
    if (several && pair.set != kAllSets) continue;
    if (pair.first == compared.contestants().front().name) of_leader.push_back(&pair);
  }
  return of_leader;
}

bool NobodySolvedAny(const ComparedSessions& compared) {
  return std::all_of(compared.pooled().begin(), compared.pooled().end(),
                     [](const auto& one) { return SummarizeSuccess(one.second).confirmed == 0; });
}

/// Those that rank as `name` does, itself included, as they are called.
std::vector<std::string> RankAlike(const ComparedSessions& compared, const std::string& name) {
  const int rank = ContestantCalled(compared, name).rank;
  std::vector<std::string> alike;
  for (const ComparedContestant& one : compared.contestants()) {
    if (one.rank == rank) alike.push_back(Called(compared, one.name));
  }
  return alike;
}

/// The beginning of the sentence on the first of several: "Of 3 contestants A ranks first by
/// penalised mean time: it"
std::string WhoRanksFirst(const ComparedSessions& compared, const char* rule) {
  const std::string& leader = compared.contestants().front().name;
  const std::size_t num = compared.contestants().size();
  const std::vector<std::string> alike = RankAlike(compared, leader);
  if (alike.size() == 1) {
    return fmt::format("Of {} contestants {} ranks first by {}: it", num, alike.front(), rule);
  }
  return fmt::format("Of {} contestants {} rank alike{} by {}: {}", num, Enumerated(alike),
                     alike.size() < num ? ", before all others," : "", rule, alike.front());
}

std::string WhoIsBest(const ComparedSessions& compared) {
  const std::string& leader = compared.contestants().front().name;
  const Outcomes& outcomes = compared.pooled_common().at(leader);
  const char* rule = std::isnan(SummarizeTimes(outcomes).penalised_mean_s)
                         ? "the share solved, as time limits are not known"
                         : "penalised mean time";
  const std::string begin =
      compared.contestants().size() == 1 ? Called(compared, leader) : WhoRanksFirst(compared, rule);
  return fmt::format("{} solved {}{}, over {}{} of {}.", begin, SolvedShare(outcomes),
                     MedianTime(outcomes), TriedDifferentProblems(compared) ? "the " : "",
                     Count(NumCommonProblems(compared), "problem"),
                     Count(static_cast<int>(compared.common().size()), "set") +
                         (TriedDifferentProblems(compared) ? " that all of them tried" : ""));
}

std::string ByHowMuch(const ComparedSessions& compared, const ComparedPair& next) {
  const std::string called = Called(compared, next.second);
  const std::vector<std::string> alike = RankAlike(compared, next.second);
  std::string text;
  if (ContestantCalled(compared, next.second).rank == compared.contestants().front().rank) {
    text = called;
  } else if (alike.size() == 1) {
    text = fmt::format("The next, {},", called);
  } else {
    text = fmt::format("The next, {}, rank alike: {}", Enumerated(alike), called);
  }
  text += " solved " + SolvedShare(compared.pooled_common().at(next.second));
  if (const auto& ratio = next.result.ratio) {
    // Told the other way round: how many times as long the second takes.
    const auto inverse = [](double value) { return RatioText(1 / value, FormatNumber(1 / value)); };
    text += fmt::format(
        " and took {} times as long on the {} that both solved in the median (geometric mean",
        inverse(ratio->mean), Count(ratio->num_pairs, "problem"));
    if (const auto& interval = ratio->interval) {
      text += fmt::format(", 95 % interval {} to {})", inverse(interval->upper),
                          inverse(interval->lower));
      if (interval->lower <= 1 && interval->upper >= 1) {
        text += ", which leaves open which of the two is faster";
      }
    } else {
      text += "), too few to tell which of the two is faster";
    }
    if (next.result.num_zero > 0) {
      text += fmt::format("; {} with a time of 0 left out", next.result.num_zero);
    }
  }
  return text + ".";
}

/// In how many sets a contestant ranks first, and in how many of these others rank alike.
std::pair<int, int> SetsLed(const ComparedSessions& compared, const std::string& name) {
  int num_first = 0, num_shared = 0;
  for (const auto& set : compared.outcomes()) {
    const std::map<std::string, Outcomes> by_contestant = OnCommonProblems(set.second);
    const auto own = by_contestant.find(name);
    if (own == by_contestant.end() || own->second.by_problem.empty()) continue;
    const RankKey key = RankKeyOf(own->second);
    bool is_first = true, is_shared = false;
    for (const auto& [other, outcomes] : by_contestant) {
      if (other == name) continue;
      const RankKey of_other = RankKeyOf(outcomes);
      is_first = is_first && key <= of_other;
      is_shared = is_shared || key == of_other;
    }
    num_first += is_first;
    num_shared += is_first && is_shared;
  }
  return {num_first, num_shared};
}

/// `num_tests`: those that the p-values are adjusted for.
std::string HowSure(const ComparedSessions& compared,
                    const std::vector<const ComparedPair*>& of_leader, std::size_t num_tests) {
  // Of too few problems the test cannot show anything, whatever the times.
  const int fewest = FewestDifferences(num_tests);
  std::vector<std::string> near, open, untested;
  for (const ComparedPair* pair : of_leader) {
    const SignedRankTest& test = pair->result.test;
    if (pair->adjusted_p <= kTestLevel && test.negative > test.positive) {
      if (IsNearOne(pair->result)) near.push_back(Called(compared, pair->second));
      continue;
    }
    const bool too_few = pair->adjusted_p > kTestLevel && pair->result.num_problems < fewest;
    (too_few ? untested : open).push_back(Called(compared, pair->second));
  }
  const std::string& leader = of_leader.front()->first;
  const std::string called = Called(compared, leader);
  std::string text;
  if (of_leader.size() == 1 && !untested.empty()) {
    text = fmt::format("With {} it cannot be tested whether {} is faster than {}: {} would do",
                       Count(of_leader.front()->result.num_problems, "problem"), called,
                       untested.front(), fewest);
  } else if (of_leader.size() == 1) {
    text = fmt::format("Problem by problem {} {} {} beyond chance (signed-rank test, 5 % level)",
                       called, open.empty() ? "is faster than" : "is not shown to be faster than",
                       Called(compared, of_leader.front()->second));
  } else if (untested.size() == of_leader.size()) {
    text = fmt::format(
        "Too few problems to test whether {} is faster than any of the {} others: {} would do "
        "(signed-rank tests, 5 % level after Holm's correction)",
        called, of_leader.size(), fewest);
  } else {
    const std::size_t num_shown = of_leader.size() - open.size() - untested.size();
    text = fmt::format(
        "Problem by problem {} is faster than {} others beyond chance (signed-rank tests, 5 % "
        "level after Holm's correction)",
        called,
        num_shown == of_leader.size() ? fmt::format("each of the {}", num_shown)
                                      : fmt::format("{} of the {}", num_shown, of_leader.size()));
    if (!open.empty()) text += "; not than " + Named(open);
    if (!untested.empty()) {
      text += fmt::format("; too few problems for the test with {} ({} would do)", Named(untested),
                          fewest);
    }
  }
  if (!near.empty()) {
    text += fmt::format(
        "; {} within 5 % of it, which may be of the processes rather than of the planners: several "
        "sessions tell",
        Named(near) + (near.size() == 1 ? " is" : " are"));
  }
  if (compared.outcomes().size() > 1) {
    const auto [num_first, num_shared] = SetsLed(compared, leader);
    text +=
        fmt::format("; it ranks first in {} of the {} sets", num_first, compared.outcomes().size());
    if (num_shared > 0) text += fmt::format(", in {} of them with others alike", num_shared);
  }
  return text;
}

/// How far the planners' own word can be trusted.
std::string Rejections(const ComparedSessions& compared) {
  int claimed = 0, rejected = 0, late = 0;
  for (const ComparedContestant& contestant : compared.contestants()) {
    if (compared.sessions()[contestant.session].imported) continue;
    for (const StoredRun* run : contestant.runs) {
      claimed += run->claimed;
      rejected += run->status == PlanStatus::kInvalidPath;
      late += run->claimed && run->status == PlanStatus::kTimedOut;
    }
  }
  if (claimed == 0) return "no path was claimed to the referee";
  const int judged = claimed - late;
  if (judged == 0) return Count(late, "path") + " came, after the time limit";
  std::string text = rejected == 0 ? "the referee confirmed " : "the referee rejected ";
  if (judged == 1) {
    text += late == 0 ? "the one path claimed" : "the one path claimed in time";
  } else if (rejected == 0) {
    text += fmt::format("every one of {} paths", judged);
  } else {
    text += fmt::format("{} of {} paths", rejected, judged);
  }
  if (late > 0) text += fmt::format(", and {} more came after the time limit", late);
  return text;
}

/// Where nobody can be compared.
std::string NoRuns(const ComparedSessions& compared) {
  int num_recorded = 0, num_planned = 0, num_missing = 0;
  for (const StoredSession& session : compared.sessions()) {
    const int num_runs = static_cast<int>(session.runs.size());
    num_recorded += num_runs;
    num_planned += session.num_runs;
    num_missing += std::max(0, session.num_runs - num_runs);
  }
  const std::string text = num_recorded == 0 ? "No runs are recorded" : "No run counts";
  return num_missing == 0 ? text + "."
                          : fmt::format("{}: {} of {} {} missing.", text, num_missing, num_planned,
                                        num_missing == 1 ? "is" : "are");
}

}  // namespace

std::vector<std::string> Answer(const ComparedSessions& compared,
                                const std::vector<ComparedPair>& pairs) {
  if (compared.contestants().empty()) return {NoRuns(compared)};
  if (NobodySolvedAny(compared)) {
    const std::size_t num = compared.contestants().size();
    const std::string nobody = num == 1
                                   ? compared.contestants().front().name + " solved no problem"
                                   : fmt::format("None of {} contestants solved a problem", num);
    return {nobody + "; " + Rejections(compared) + "."};
  }
  std::vector<std::string> sentences;
  const std::map<std::string, std::string> untold_times = UntoldTimes(compared);
  const auto add_doubts = [&](const ComparedContestant& contestant) {
    if (std::string trained = DescribeTraining(compared, contestant); !trained.empty()) {
      sentences.push_back(std::move(trained));
    }
    if (auto untold = Lookup(untold_times, contestant.name)) sentences.push_back(*untold);
  };
  if (compared.common().empty()) {
    return {fmt::format("None of {} contestants ranks first: there is no problem that all of them "
                        "tried.",
                        compared.contestants().size()),
            (pairs.empty() ? "Nobody tried a problem that another tried; "
                           : "Those who tried some in common are compared problem by problem; ") +
                Rejections(compared) + "."};
  }
  sentences.push_back(WhoIsBest(compared));
  add_doubts(compared.contestants().front());
  const std::vector<const ComparedPair*> of_leader = LeadersPairs(compared, pairs);
  if (of_leader.empty()) {
    sentences.push_back("There is nothing to compare it with; " + Rejections(compared) + ".");
  } else {
    sentences.push_back(ByHowMuch(compared, *of_leader.front()));
    add_doubts(ContestantCalled(compared, of_leader.front()->second));
    const std::string& set = of_leader.front()->set;
    const auto num_tests = static_cast<std::size_t>(std::count_if(
        pairs.begin(), pairs.end(), [&](const ComparedPair& pair) { return pair.set == set; }));
    sentences.push_back(HowSure(compared, of_leader, num_tests) + "; " + Rejections(compared) +
                        ".");
  }
  return sentences;
}

}  // namespace planbench
