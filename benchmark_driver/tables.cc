#include "benchmark_driver/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "benchmark_driver/effort_table.h"
#include "benchmark_driver/failure_list.h"
#include "benchmark_driver/published_study.h"
#include "benchmark_driver/session_results.h"
#include "benchmark_driver/text_table.h"
#include "common/lookup.h"
#include "planning/told_edges.h"
#include "results/comparison.h"
#include "results/disputed_ends.h"
#include "results/quality.h"
#include "results/training.h"
#include "results/untold_times.h"

namespace planbench {
namespace {

/// Below a table that has such rows.
constexpr char kPublishedNote[] =
    "published: arXiv 2406.09623, Xeon E5-6248R, 60 s a request, no referee, ARA* backward where "
    "forward had failed, RRT-Connect once. Problems that planbench generates follow the study's "
    "recipe and are not the same files; --problems takes the originals.\n";

const PublishedFigures* PublishedBeside(const SetResults& set, const ContestantResults& one) {
  return one.contestant->published.empty() ? nullptr
                                           : FindPublished(set.name, one.contestant->published);
}

std::string PublishedName(const PublishedFigures& row) {
  return "published " + std::string(row.algorithm);
}

std::string Count(int count) { return fmt::format("{}", count); }
std::string Count(std::optional<int> count) { return count ? Count(*count) : "-"; }

std::string Percent(double share, const Interval& interval) {
  return fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100 * share, 100 * interval.lower,
                     100 * interval.upper);
}

std::string WithInterval(const std::string& value, const std::optional<Interval>& interval,
                         std::string (*format)(double)) {
  if (!interval) return value;
  return fmt::format("{} [{}, {}]", value, format(interval->lower), format(interval->upper));
}

/// Calls `row` with every set and contestant, `heading` before each set.
template <typename Heading, typename Row>
void ForEachRow(const SessionResults& results, Heading heading, Row row) {
  for (const SetResults& set : results.sets()) {
    heading(set);
    for (const ContestantResults& one : set.contestants) row(set, one);
  }
}

std::string SuccessTable(const SessionResults& results) {
  TextTable table(
      "Success",
      {"contestant", "runs", "claimed", "confirmed", "% [95 %]", "fwd", "bwd", "failed", "blocked"},
      1);
  bool published = false;
  bool one_trial = false, more_trials = false;
  bool trained = false;
  ForEachRow(
      results, [&](const SetResults& set) { table.AddHeading(set.name); },
      [&](const SetResults& set, const ContestantResults& one) {
        using Kind = Outcome::Kind;
        SuccessSummary s = SummarizeSuccess(one.outcomes);
        if (!one.is_reference) (s.num_runs > s.num_problems ? more_trials : one_trial) = true;
        trained = trained || one.is_trained;
        table.Add({one.label(), Count(s.num_runs), Count(s.claimed),
                   one.is_reference ? "-" : Count(s.confirmed), Percent(s.share, s.interval),
                   Count(s.kinds[Kind::kForward]), Count(s.kinds[Kind::kBackward]),
                   Count(s.kinds[Kind::kFailure]), Count(s.kinds[Kind::kUnsolvable])});
        if (const PublishedFigures* row = PublishedBeside(set, one)) {
          published = true;
          const int claimed = row->solved_forward + row->solved_backward.value_or(0);
          table.Add({PublishedName(*row), Count(row->num_problems), Count(claimed), "-",
                     Percent(static_cast<double>(claimed) / row->num_problems,
                             WilsonInterval(claimed, row->num_problems)),
                     Count(row->solved_forward), Count(row->solved_backward), Count(row->failed),
                     Count(row->unsolvable)});
        }
      });
  std::string notes =
      "runs: problems x trials; both directions of one are one. claimed: the planner says that it "
      "found a path. confirmed: the referee agrees; all that follows counts these. %: share "
      "confirmed, mean over the problems of that of their trials, with Wilson's interval for as "
      "many cases as there are problems. fwd, bwd: found "
      "from start to goal, or else from goal to start. failed: out of time, memory or search "
      "space. blocked: start or goal invalid. Other runs were rejected by the referee, got no "
      "answer, or were refused or cancelled.\n";
  if (one_trial && more_trials) {
    notes += "Contestants whose answer does not depend on the seed make one trial.\n";
  }
  if (trained) notes += std::string(kTrainedNote) + "\n";
  if (published) notes += kPublishedNote;
  return table.Format(notes) + "\n";
}

std::string TimeTable(const SessionResults& results) {
  TextTable table("Planning time, ms",
                  {"contestant", "solved", "median [95 %]", "mean", "95 %", "penalised mean"}, 1);
  bool published = false;
  ForEachRow(
      results, [&](const SetResults& set) { table.AddHeading(set.name); },
      [&](const SetResults& set, const ContestantResults& one) {
        const TimeSummary s = SummarizeTimes(one.outcomes);
        table.Add({one.label(), Count(s.solved_s.count),
                   WithInterval(Milliseconds(s.solved_s.median), s.median_interval_s, Milliseconds),
                   Milliseconds(s.solved_s.mean), Milliseconds(s.solved_s.percentile_95),
                   Milliseconds(s.penalised_mean_s)});
        if (const PublishedFigures* row = PublishedBeside(set, one)) {
          published = true;
          table.Add({"  of the solving attempt", Count(s.solving_s.count),
                     Milliseconds(s.solving_s.median), Milliseconds(s.solving_s.mean),
                     Milliseconds(s.solving_s.percentile_95), "-"});
          const std::string median = row->median_from_s == row->median_to_s
                                         ? fmt::format("~{}", Milliseconds(row->median_from_s))
                                         : fmt::format("{}-{}", Milliseconds(row->median_from_s),
                                                       Milliseconds(row->median_to_s));
          table.Add({PublishedName(*row),
                     Count(row->solved_forward + row->solved_backward.value_or(0)), median, "-",
                     "-", "-"});
        }
      });
  std::string notes =
      "From request and scene at hand to the first confirmed path, failed attempts before it "
      "included; simplification and the bus are not. solved: problems with a confirmed path in one "
      "trial at least; each counts once, by the median of such trials. [95 %]: between order "
      "statistics. 95 %: of the problems are faster. penalised mean: over all runs, one without a "
      "confirmed path as ten times the longest limit that anybody had on its problem (PAR-10).\n";
  if (published) {
    notes += std::string(kPublishedNote) +
             "Its medians are read off a plot and of the attempt that succeeded, as the row above "
             "them.\n";
  }
  return table.Format(notes) + "\n";
}

/// Pairs of contestants that tried a problem in common: with the first one, or all. p-values are
/// adjusted for all of them in either table, as in the report's.
std::string PairTable(const SessionResults& results, bool all) {
  TextTable table(
      "Problem by problem",
      {"contestant", "against", "problems", "won %", "both", "time ratio [95 %]", "p (Holm)"}, 2);
  std::vector<PairedComparison> shown;
  for (const SetResults& set : results.sets()) {
    table.AddHeading(set.name);
    const auto& contestants = set.contestants;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;  // against whom, and who
    std::vector<PairedComparison> of_set;
    for (std::size_t a = 0; a < contestants.size(); ++a) {
      for (std::size_t b = a + 1; b < contestants.size(); ++b) {
        const PairedComparison pair = Compare(contestants[b].outcomes, contestants[a].outcomes);
        if (pair.num_problems == 0) continue;
        pairs.emplace_back(a, b);
        of_set.push_back(pair);
      }
    }
    const std::vector<double> adjusted = AdjustedPValues(of_set);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (pairs[i].first > 0 && !all) continue;
      const PairedComparison& pair = of_set[i];
      shown.push_back(pair);
      const auto format = [](double value) {
        return RatioText(value, fmt::format("{:.3g}", value));
      };
      table.Add(
          {contestants[pairs[i].second].label(), contestants[pairs[i].first].label(),
           Count(pair.num_problems), Number(100 * pair.wins.Share(), 1), Count(pair.num_in_ratio()),
           pair.ratio ? WithInterval(format(pair.ratio->mean), pair.ratio->interval, format) : "-",
           adjusted[i] < 1e-4 ? "< 0.0001" : Number(adjusted[i], 4)});
    }
  }
  if (shown.empty()) return "";
  const std::string notes = fmt::format(
      "{}problems: that both tried. won: share of them that the first solved faster, or alone; a "
      "tie is half. both: those that both solved, in more than 0 ms. time ratio: geometric mean of "
      "first / second over these, with Student's interval, of six at least; below 1 the first is "
      "faster. p: Wilcoxon's signed-rank test of those that either solved, two-sided, adjusted for "
      "all pairs of the set (Holm), which tables.txt shows.{}{}\n",
      kProblemTimeNote, ZeroTimesNote(shown), NearRatiosNote(shown));
  return table.Format(notes) + "\n";
}

/// Planning times of the attempts themselves, by direction.
std::string DirectionTable(const SessionResults& results) {
  TextTable table("Planning time of confirmed attempts by direction, ms",
                  {"contestant", "dir.", "attempts", "confirmed", "problems", "median", "mean",
                   "25 %", "75 %", "95 %"},
                  2);
  ForEachRow(
      results, [&](const SetResults& set) { table.AddHeading(set.name); },
      [&](const SetResults&, const ContestantResults& one) {
        for (const Direction direction : EnumValues<Direction>()) {
          int attempts = 0, confirmed = 0;
          ValuesByProblem times_s;
          for (const RunRow* run : one.runs) {
            if (run->direction != direction) continue;
            ++attempts;
            if (!run->confirmed()) continue;
            ++confirmed;
            times_s[run->problem_index].push_back(run->time_s);
          }
          if (attempts == 0) continue;
          const Summary s = SummarizeByProblem(times_s);
          table.Add({one.label(), direction == Direction::kForward ? "fwd" : "bwd", Count(attempts),
                     Count(confirmed), Count(s.count), Milliseconds(s.median), Milliseconds(s.mean),
                     Milliseconds(s.lower_quartile), Milliseconds(s.upper_quartile),
                     Milliseconds(s.percentile_95)});
        }
      });
  return table.Format(
             "Attempts of either direction for themselves. problems: those with a confirmed one, "
             "which count once, by the median of these.\n") +
         "\n";
}

/// Class of planner by contestant's name, of those that made runs; empty if all are of one.
std::map<std::string, std::string> ClassesIfSeveral(const SessionResults& results) {
  std::map<std::string, std::string> classes;
  std::set<std::string> distinct;
  for (const SetResults& set : results.sets()) {
    for (const ContestantResults& one : set.contestants) {
      if (one.runs.empty()) continue;
      const std::string& planner_class = *one.runs.front()->planner_class;
      classes[one.contestant->name] = planner_class;
      distinct.insert(planner_class);
    }
  }
  if (distinct.size() < 2) classes.clear();
  return classes;
}

/// How many runs other work on the machine held up (machine.h), of which some are still to be made
/// again; "" if none.
std::string Disturbances(const SessionResults& results, int num_to_repeat) {
  int runs = 0, disturbed = 0, repeated = 0;
  for (const SetResults& set : results.sets()) {
    for (const ContestantResults& contestant : set.contestants) {
      for (const RunRow* run : contestant.runs) {
        ++runs;
        disturbed += run->disturbed;
        repeated += run->repeated;
      }
    }
  }
  if (disturbed + repeated == 0) return "";
  std::string text = fmt::format(
      "{} of {} runs were DISTURBED by other work on the machine beyond "
      "--max-disturbance",
      disturbed, runs);
  if (num_to_repeat > 0) {
    text += fmt::format("; {} of them still to be made again (--resume)", num_to_repeat);
  }
  if (repeated > 0) text += fmt::format("; {} had been, and were made again", repeated);
  if (num_to_repeat + repeated == 0) text += "; --repeat-disturbed makes such runs again";
  return BreakLines(text + ".\n");
}

/// Whose times are odd, whose word on start or goal is disputed and whose simplified paths were
/// rejected, a line each; "" if nobody's.
std::string Remarks(const SessionResults& results) {
  std::map<std::string, std::vector<OddTimesFound>> odd_times;
  std::map<std::string, std::vector<AnswerTimes>> answer_times;
  std::map<std::string, std::vector<std::optional<bool>>> simplified;
  std::map<std::string, std::vector<JudgedOutcomes>> judged;
  for (const SetResults& set : results.sets()) {
    for (const ContestantResults& one : set.contestants) {
      const std::string& name = one.contestant->name;
      JudgedOutcomes& of_set = judged[set.name].emplace_back();
      of_set.contestant = name;
      if (const auto model = one.contestant->collision_model) {
        of_set.collision_model = EnumName(*model);
      }
      of_set.outcomes = &one.outcomes;
      of_set.has_first_path = !one.contestant->first_path_of.empty();
      for (const RunRow* run : one.runs) {
        odd_times[name].push_back(run->odd_times_s);
        answer_times[name].push_back(run->answer_times);
      }
      for (const RunRow* run : ConfirmedRuns(one.runs)) {
        simplified[name].push_back(run->simplified_valid);
      }
    }
  }
  std::string text;
  for (const auto& [name, of_runs] : odd_times) {
    for (const std::string& line : DescribeOddTimes(name, of_runs)) text += BreakLines(line);
  }
  for (const auto& [name, line] : DescribeUntoldTimes(answer_times)) text += BreakLines(line);
  for (const auto& [name, line] : DescribeDisputedEnds(judged)) text += BreakLines(line);
  for (const auto& [name, verdicts] : simplified) {
    text += BreakLines(RejectedSimplifiedNote(name, verdicts));
  }
  return text;
}

/// How a contestant's edges were checked; without runs, how they are to be.
std::string EdgesOf(const Contestant& contestant, const SessionResults& results) {
  for (const SetResults& set : results.sets()) {
    for (const ContestantResults& one : set.contestants) {
      if (one.contestant->name == contestant.name && !one.runs.empty()) {
        return *one.runs.front()->edges;
      }
    }
  }
  return DescribeEdges(contestant.edge_check, contestant.edge_resolution_m, {});
}

/// What the contestants are, and what holds of all the figures.
std::string Preface(const SessionConditions& conditions, const SessionResults& results,
                    int num_to_repeat, std::optional<int> problems_per_process) {
  std::string text = "Contestants\n";
  const std::map<std::string, std::string> classes = ClassesIfSeveral(results);
  for (const Contestant& one : results.contestants()) {
    std::string line = results.LabelOf(one);
    if (const std::string own = Lookup(classes, one.name).value_or(""); !own.empty()) {
      line += ", " + own;
    }
    if (!one.about.empty()) line += ": " + one.about;
    if (one.collision_model) {
      line += fmt::format(" [{}, edges {}]", EnumName(*one.collision_model), EdgesOf(one, results));
    }
    text += BreakLines(line + "\n");
  }
  if (conditions.parallel) {
    text += BreakLines(
        "All times were measured UNDER LOAD: the planners worked at once (--parallel).\n");
  }
  if (problems_per_process) {
    text += BreakLines(fmt::format(
        "The planners were started anew after so many problems (--problems-per-process {}).\n",
        *problems_per_process));
  }
  return text + Remarks(results) + Disturbances(results, num_to_repeat) + "\n";
}

/// What is in no table since it was not made, or awaits what was not, and why; "" if nothing. Of
/// `num_runs` that have a record.
std::string Missing(int num_runs, int num_without_record, int num_owed,
                    const SessionResults& results) {
  const int num_not_asked = results.num_not_asked();
  const int num_awaiting = results.num_awaiting();
  const int num_missing = num_without_record + num_not_asked;
  std::string text;
  if (num_missing > 0) {
    text = fmt::format("{} OF {} RUNS ARE MISSING: they were not made, and no figure counts them.",
                       num_missing, num_runs + num_without_record);
  }
  if (num_not_asked > 0) {
    text += fmt::format(" {} of them could not be asked for or judged", num_not_asked);
    const std::string reason = results.why_not_asked().Summary();
    text += reason.empty() ? "." : fmt::format(" ({}).", reason);
  }
  if (num_owed > 0) {
    text += fmt::format(
        " {} of them the session was to make before it was resumed, with other planners, sets, "
        "problems or trials.",
        num_owed);
  }
  if (num_awaiting > 0) {
    text += fmt::format(
        "{}{} more found nothing in one direction while the other is missing: what comes of {} is "
        "not known, and no figure counts {} either.",
        text.empty() ? "" : " ", num_awaiting, num_awaiting == 1 ? "it" : "them",
        num_awaiting == 1 ? "it" : "them");
  }
  return text.empty() ? "" : BreakLines(text + "\n", 0) + "\n";
}

/// Which problems are in no table, and why; "" if none.
std::string LeftOut(const std::map<std::string, std::string>& left_out) {
  if (left_out.empty()) return "";
  std::string text = fmt::format(
      "{} PROBLEM{} LEFT OUT, since the scene server refuses {}; no figure counts {}.\n",
      left_out.size(), left_out.size() == 1 ? " IS" : "S ARE", left_out.size() == 1 ? "it" : "them",
      left_out.size() == 1 ? "it" : "them");
  for (const auto& [problem, reason] : left_out) {
    text += BreakLines(fmt::format("  {}: {}\n", problem, reason));
  }
  return text + "\n";
}

}  // namespace

SessionTables MakeTables(const SessionConditions& conditions, const RunRows& runs,
                         const std::vector<Attempt>& references, int num_missing,
                         const std::map<std::string, std::string>& left_out, int num_owed,
                         int num_to_repeat, std::optional<int> problems_per_process,
                         const std::string& referee_misfits) {
  const SessionResults results(conditions, runs, references);
  const std::string missing =
      Missing(static_cast<int>(runs.size()), num_missing, num_owed, results) + LeftOut(left_out);
  if (results.sets().empty()) return {missing + "No runs.\n", missing + "No runs.\n"};
  const std::string begin = missing +
                            Preface(conditions, results, num_to_repeat, problems_per_process) +
                            SuccessTable(results) + TimeTable(results);
  const std::string meshes = MeshTable(results, referee_misfits);
  return {begin + PairTable(results, false) + meshes + FailureSummary(results),
          begin + DirectionTable(results) + PairTable(results, true) + EffortTables(results) +
              meshes + FailureList(results)};
}

}  // namespace planbench
