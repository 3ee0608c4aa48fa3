#include "report/answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "collision/collision_model.h"
#include "common/lookup.h"
#include "messaging/asked_runs.h"
#include "results/disputed_ends.h"
#include "results/quality.h"
#include "results/reproduce.h"
#include "results/training.h"
#include "results/untold_times.h"

namespace planbench {
namespace {

std::string Count(int count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

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

const ComparedContestant& ContestantCalled(const ComparedSessions& compared,
                                           const std::string& name) {
  const auto& all = compared.contestants();
  return *std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
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

/// Whether contestants tried other problems than those that all of them tried.
bool TriedDifferentProblems(const ComparedSessions& compared) {
  return std::any_of(compared.pooled().begin(), compared.pooled().end(), [&](const auto& one) {
    const auto common = compared.pooled_common().find(one.first);
    return common == compared.pooled_common().end() ||
           common->second.by_problem.size() < one.second.by_problem.size();
  });
}

int NumCommonProblems(const ComparedSessions& compared) {
  const auto& common = compared.pooled_common();
  return common.empty() ? 0 : static_cast<int>(common.begin()->second.by_problem.size());
}

constexpr std::size_t kMostNamed = 4;

/// "A, B and 3 more"
std::string Named(const std::vector<std::string>& names) {
  const std::size_t num_named = std::min(names.size(), kMostNamed);
  return fmt::format(
      "{}{}",
      fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(num_named), ", "),
      names.size() > num_named ? fmt::format(" and {} more", names.size() - num_named) : "");
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

/// "A, B and C", or as Named
std::string Enumerated(std::vector<std::string> names) {
  if (names.size() < 2 || names.size() > kMostNamed + 1) return Named(names);
  const std::string last = std::move(names.back());
  names.pop_back();
  return Named(names) + " and " + last;
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
    text = fmt::format("Too few problems to test whether {} is faster than {}: {}, {} would do",
                       called, untested.front(), of_leader.front()->result.num_problems, fewest);
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
  const char* verb = rejected == 0 ? "confirmed" : "rejected";
  std::string text = fmt::format("the referee {} ", verb);
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

/// What the logger saw of the bus, by which all others heard the same session.
std::string OnTheBus(const BusRecord& bus) {
  std::vector<std::string> odd;
  const auto add = [&](std::int64_t count, const char* one, const char* several, const char* what) {
    if (count > 0) odd.push_back(fmt::format("{} {} {}", count, count == 1 ? one : several, what));
  };
  add(bus.lost, "message", "messages", "did not reach the logger");
  add(bus.dropped, "message was", "messages were", "more than it could keep up with");
  add(bus.malformed, "packet was", "packets were", "none of LCM's");
  add(bus.contradictions, "message", "messages", "told otherwise than those believed");
  if (odd.empty()) return "no message was lost on the bus, as far as the logger saw.";
  const std::string not_told =
      bus.parts_not_told > 0 ? fmt::format("; of {} it is not known",
                                           Count(static_cast<int>(bus.parts_not_told), "part"))
                             : "";
  return fmt::format(
      "on the bus {}{}; runs are sent until they are recorded, so that none is missing for that.",
      fmt::join(odd, ", "), not_told);
}

/// What the time limits of a set make of its figures; "" if they are known and the same for all.
std::string OnTheLimits(const std::string& set,
                        const std::map<std::string, Outcomes>& by_contestant) {
  const bool unknown = std::any_of(by_contestant.begin(), by_contestant.end(), [](const auto& one) {
    return std::isnan(SummarizeTimes(one.second).penalised_mean_s);
  });
  if (unknown) {
    return set + ": time limits are not known, and so are the penalised means of those who failed.";
  }
  const std::set<double> limits_s = LimitsOn(by_contestant);
  if (limits_s.size() < 2) return "";
  return fmt::format(
      "{}: time limits differ ({} to {} s): who had longer could solve more. {} Penalised means "
      "count every failure as ten times the longest.",
      set, FormatNumber(*limits_s.begin()), FormatNumber(*limits_s.rbegin()), kLimitsNote);
}

/// What contestants that tried different problems are ranked by.
std::string OnDifferentProblems(const ComparedSessions& compared) {
  std::vector<std::string> numbers;
  for (const ComparedContestant& one : compared.contestants()) {
    numbers.push_back(
        fmt::format("{} {}", one.name, compared.pooled().at(one.name).by_problem.size()));
  }
  const int num_common = NumCommonProblems(compared);
  return fmt::format("The contestants tried different problems ({}): {}.", Named(numbers),
                     num_common == 0
                         ? "none that all of them tried, so that none ranks first"
                         : fmt::format("they rank by the {} that all of them tried", num_common));
}

/// How many runs a session is still to make again, since they were disturbed.
std::ptrdiff_t CountToRepeat(const StoredSession& session) {
  if (!RepeatsDisturbed(session.flags)) return 0;
  return std::count_if(session.runs.begin(), session.runs.end(), [](const StoredRun& run) {
    RunStanding standing;
    standing.disturbed = run.disturbed;
    standing.repeats = run.repeats;
    return OwesRepeat(standing);
  });
}

std::string LeftOut(const std::string& name, const std::map<std::string, std::string>& left_out) {
  std::vector<std::string> problems;
  for (const auto& [problem, reason] : left_out) problems.push_back(problem);
  return fmt::format("{}: {} left out, since the scene server refused {}: {} ({}: {}).", name,
                     Count(static_cast<int>(problems.size()), "problem"),
                     problems.size() == 1 ? "it" : "them", fmt::join(problems, ", "),
                     problems.front(), left_out.begin()->second);
}

/// That some of what a contestant is tried on is what it has learned from; "" if none is.
std::string Trained(const ComparedSessions& compared, const ComparedContestant& contestant) {
  const std::vector<std::string> sets = SetsLearnedFrom(compared, contestant);
  if (sets.empty()) return "";
  return fmt::format(
      "{} has learned from {}, on which it is tried here: its figures there are no test.",
      contestant.name, fmt::join(sets, ", "));
}

/// DescribeUntoldTimes of each session, by contestant.
std::map<std::string, std::string> UntoldTimes(const ComparedSessions& compared) {
  std::map<std::size_t, std::map<std::string, std::vector<AnswerTimes>>> by_session;
  for (const ComparedContestant& contestant : compared.contestants()) {
    if (compared.sessions()[contestant.session].imported) continue;
    for (const StoredRun* run : contestant.runs) {
      by_session[contestant.session][contestant.name].push_back(
          {.status = run->status,
           .told_s = run->total_time_s + run->phases.simplification_s,
           .roundtrip_s = run->roundtrip_time_s,
           .waited_s = run->waiting_s.value_or(0) + run->steal_s.value_or(0)});
    }
  }
  std::map<std::string, std::string> lines;
  for (const auto& [session, by_contestant] : by_session) {
    lines.merge(DescribeUntoldTimes(by_contestant));
  }
  return lines;
}

/// DescribeDisputedEnds, by contestant.
std::map<std::string, std::string> DisputedEnds(const ComparedSessions& compared) {
  std::map<std::string, std::vector<JudgedOutcomes>> judged;
  for (const auto& [set, by_contestant] : compared.outcomes()) {
    for (const auto& [name, outcomes] : by_contestant) {
      const ComparedContestant& one = ContestantCalled(compared, name);
      const auto settings = ParseSettings(one.settings);
      judged[set].push_back({name, one.session, Lookup(settings, "collision_model").value_or(""),
                             &outcomes, settings.contains(kFirstPathOf)});
    }
  }
  return DescribeDisputedEnds(judged);
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
    if (std::string trained = Trained(compared, contestant); !trained.empty()) {
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

std::vector<std::string> Cautions(const ComparedSessions& compared) {
  std::vector<std::string> cautions;
  for (const std::string& set : compared.other_sets()) {
    cautions.push_back(
        fmt::format("{}: other scenes than those of the set of this name before; nothing is "
                    "compared with them.",
                    set));
  }
  if (TriedDifferentProblems(compared)) cautions.push_back(OnDifferentProblems(compared));
  for (const auto& [set, by_contestant] : compared.outcomes()) {
    if (const std::string limits = OnTheLimits(set, by_contestant); !limits.empty()) {
      cautions.push_back(limits);
    }
  }
  for (std::size_t i = 0; i < compared.sessions().size(); ++i) {
    const StoredSession& session = compared.sessions()[i];
    const std::string& name = compared.session_names()[i];
    const int num_runs = static_cast<int>(session.runs.size());
    const int num_awaiting = compared.num_awaiting()[i];
    int num_lacking = session.num_runs - num_runs - num_awaiting - session.num_not_asked;
    for (const auto& [contestant, number] : session.strangers) num_lacking -= number;
    if (session.imported) {
      cautions.push_back(fmt::format(
          "{}: {} runs from elsewhere, on another machine or under other conditions; no referee "
          "judged their paths: confirmed are those that the file calls solved, in time.",
          name, num_runs));
    } else if (!session.described) {
      cautions.push_back(fmt::format(
          "{}: the session's own message is missing; its conditions are not known.", name));
    } else if (!session.finished) {
      const auto num_to_repeat = CountToRepeat(session);
      cautions.push_back(fmt::format(
          "{}: did not finish: {} of {} runs are recorded{}.", name, num_runs, session.num_runs,
          num_to_repeat == 0
              ? ""
              : fmt::format(", {} of them still to be made again (--resume)", num_to_repeat)));
    } else if (num_lacking > 0) {
      cautions.push_back(
          fmt::format("{}: {} of {} runs are not recorded.", name, num_lacking, session.num_runs));
    } else if (num_runs >= session.num_runs) {
      cautions.push_back(fmt::format("{}: all {} runs are recorded; it took {} s.", name, num_runs,
                                     FormatNumber(session.total_time_s)));
    }
    if (session.num_not_asked > 0) {
      const std::string reason = session.why_not_asked.Summary();
      cautions.push_back(
          fmt::format("{}: {} could not be asked for or judged{}: counted as missing, not as "
                      "failed; {}.",
                      name, Count(session.num_not_asked, num_runs > 0 ? "more run" : "run"),
                      reason.empty() ? "" : fmt::format(" ({})", reason),
                      WhatMakesThem(session.num_not_asked, session.num_unjudgeable)));
    }
    for (const auto& [contestant, number] : session.strangers) {
      cautions.push_back(fmt::format(
          "{}: {} of '{}', which the session does not have as a contestant: damaged, and counted "
          "as missing.",
          name, Count(number, "more record"), contestant));
    }
    if (num_awaiting > 0) {
      cautions.push_back(fmt::format(
          "{}: {} found nothing in one direction while the other is missing: counted as missing, "
          "too, not as failed.",
          name, Count(num_awaiting, "more run")));
    }
    if (!session.left_out.empty()) cautions.push_back(LeftOut(name, session.left_out));
    if (session.finished && session.bus) cautions.push_back(name + ": " + OnTheBus(*session.bus));
    for (const std::string& warning : session.warnings) cautions.push_back(name + ": " + warning);
    if (Lookup(session.flags, "parallel") == "true") {
      cautions.push_back(fmt::format(
          "{}: the planners worked at once (--parallel): all times were measured under load.",
          name));
    }
    if (const auto problems = Lookup(session.flags, "problems-per-process").value_or("");
        !problems.empty()) {
      cautions.push_back(fmt::format(
          "{}: the planners were started anew after so many problems (--problems-per-process {}).",
          name, problems));
    }
  }
  for (const std::string& name : compared.without_runs()) {
    cautions.push_back(name + ": no run counts.");
  }
  const std::map<std::string, std::string> untold_times = UntoldTimes(compared);
  const std::map<std::string, std::string> disputed_ends = DisputedEnds(compared);
  for (const ComparedContestant& contestant : compared.contestants()) {
    if (std::string trained = Trained(compared, contestant); !trained.empty()) {
      cautions.push_back(std::move(trained));
    }
    std::vector<OddTimesFound> odd_times;
    for (const StoredRun* run : contestant.runs) odd_times.push_back(run->odd_times_s);
    for (std::string& line : DescribeOddTimes(contestant.name, odd_times)) {
      cautions.push_back(std::move(line));
    }
    for (const auto* lines : {&untold_times, &disputed_ends}) {
      if (auto line = Lookup(*lines, contestant.name)) cautions.push_back(*std::move(line));
    }
    std::vector<std::optional<bool>> simplified;
    for (const StoredRun* run : contestant.runs) {
      if (run->confirmed()) simplified.push_back(run->simplified_valid);
    }
    if (std::string note = RejectedSimplifiedNote(contestant.name, simplified); !note.empty()) {
      cautions.push_back(std::move(note));
    }
  }
  return cautions;
}

std::string WithoutMeshRobot(const ComparedSessions& compared) {
  std::vector<std::string> by_meshes, by_enclosing, by_others;
  for (const ComparedContestant& one : compared.contestants()) {
    const auto model = Lookup(ParseSettings(one.settings), "collision_model").value_or("");
    (model == EnumName(CollisionModel::kMeshes)      ? by_meshes
     : model == EnumName(CollisionModel::kEnclosing) ? by_enclosing
                                                     : by_others)
        .push_back(one.name);
  }
  std::string text = "Planners and referee judge by the collision model of each contestant.";
  const auto add = [&](const std::vector<std::string>& names, const char* sentence) {
    if (names.empty()) return;
    const bool are_all = names.size() == compared.contestants().size();
    text += fmt::format(fmt::runtime(sentence),
                        are_all ? "all" : fmt::format("{}", fmt::join(names, ", ")));
  };
  add(by_meshes,
      " Of {} it is the robot's own meshes and solids: what was confirmed is free on the true "
      "geometry.");
  add(by_enclosing,
      " Of {} it is spheres that contain the robot's meshes and solids: what was confirmed is free "
      "on the true geometry, too.");
  add(by_others,
      " No robot with meshes judged the paths besides (--referee-robot), so that what those of {} "
      "are worth on the true geometry is not known.");
  return text + " Success tells what was claimed and what was confirmed.";
}

}  // namespace planbench
