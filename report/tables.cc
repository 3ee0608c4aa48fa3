#include "report/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "common/numbers.h"
#include "planning/path_measures.h"
#include "report/session_tables.h"
#include "report/trained.h"
#include "results/quality.h"

namespace planbench {
namespace {

Estimate Milliseconds(double value_s, const std::optional<Interval>& interval_s) {
  Estimate estimate{kMsPerS * value_s, interval_s};
  if (estimate.interval) {
    estimate.interval->lower *= kMsPerS;
    estimate.interval->upper *= kMsPerS;
  }
  return estimate;
}

/// Calls `visit` with each set, contestant and its outcomes, in the contestants' order.
template <typename Visit>
void ForEach(const ComparedSessions& compared, Visit visit) {
  for (const auto& [set, by_contestant] : compared.outcomes()) {
    for (const ComparedContestant& contestant : compared.contestants()) {
      const auto found = by_contestant.find(contestant.name);
      if (found != by_contestant.end()) visit(set, contestant, found->second);
    }
  }
}

/// In the page's order, also those without rows.
std::vector<Table> MakeTables(const ComparedSessions& compared,
                              const std::vector<ComparedPair>& pairs) {
  return {SessionTable(compared, false), SuccessTable(compared),  TimeTable(compared),
          DirectionTable(compared),      PairTable(pairs),        QualityTable(compared),
          PhaseTable(compared),          FailureTable(compared),  MeshTable(compared),
          ChangeTable(compared),         ConditionTable(compared)};
}

/// The bodies that a reason names ("'a' and 'b'"), or all of it.
std::string ContactOf(const std::string& reason) {
  const std::size_t begin = reason.find('\'');
  const std::size_t middle = reason.find("' and '", begin + 1);
  if (begin == std::string::npos || middle == std::string::npos) return reason;
  const std::size_t end = reason.find('\'', middle + 7);
  return reason.substr(begin, end == std::string::npos ? end : end + 1 - begin);
}

int NumRejectedSimplified(const ComparedContestant& contestant, const std::string& set) {
  const std::vector<const StoredRun*> runs = ConfirmedRuns(contestant, set);
  return static_cast<int>(std::count_if(runs.begin(), runs.end(), [](const StoredRun* run) {
    return run->simplified_valid == std::optional(false);
  }));
}

/// "'a' and 'b' (3)"; "" if there is none.
std::string Commonest(const std::map<std::string, int>& counts) {
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? "" : fmt::format("{} ({})", most->first, most->second);
}

}  // namespace

std::set<double> LimitsOn(const std::map<std::string, Outcomes>& by_contestant) {
  std::set<double> limits_s;
  for (const auto& [name, outcomes] : by_contestant) {
    if (outcomes.time_limit_s > 0) limits_s.insert(outcomes.time_limit_s);
  }
  return limits_s;
}

std::string LimitsNote(const ComparedSessions& compared) {
  std::vector<std::string> sets;
  for (const auto& [set, by_contestant] : compared.outcomes()) {
    if (LimitsOn(by_contestant).size() > 1) sets.push_back(set);
  }
  if (sets.empty()) return "";
  return fmt::format("Time limits differ on {}. {}", fmt::join(sets, ", "), kLimitsNote);
}

Table SuccessTable(const ComparedSessions& compared) {
  Table table{
      "success",
      "Success",
      "Runs are problems times trials; both directions of one count as one. Claimed: the planner "
      "says that it found a path. Confirmed: the referee agrees. The share is the mean over the "
      "problems of the share of their trials confirmed, with Wilson's 95 % interval for as many "
      "cases as there are problems. Forward: confirmed from start to goal. Backward: from goal to "
      "start, and not from start to goal. Failed: out of time, memory or search space. Blocked: "
      "start or goal invalid. Rejected: the referee rejected the path. No answer: the planner died "
      "or fell silent. Refused: the request was refused, or cancelled. Where the two directions of "
      "a run without a confirmed path ended differently, the first that fits counts: rejected, "
      "blocked, no answer, refused, failed.",
      {{"set", "set"},
       {"contestant", "contestant"},
       {"problems", "problems", Style::kCount},
       {"runs", "runs", Style::kCount},
       {"claimed", "claimed", Style::kCount},
       {"confirmed", "confirmed", Style::kCount},
       {"confirmed_percent", "% [95 %]", Style::kShare, true},
       {"forward", "forward", Style::kCount},
       {"backward", "backward", Style::kCount},
       {"failed", "failed", Style::kCount},
       {"blocked", "blocked", Style::kCount},
       {"rejected", "rejected", Style::kCount},
       {"no_answer", "no answer", Style::kCount},
       {"refused", "refused", Style::kCount}},
      {}};
  ForEach(compared, [&](const std::string& set, const ComparedContestant& contestant,
                        const Outcomes& outcomes) {
    SuccessSummary s = SummarizeSuccess(outcomes);
    using Kind = Outcome::Kind;
    table.rows.push_back({set, contestant.name, s.num_problems, s.num_runs, s.claimed, s.confirmed,
                          Percent(s.share, s.interval), s.kinds[Kind::kForward],
                          s.kinds[Kind::kBackward], s.kinds[Kind::kFailure],
                          s.kinds[Kind::kUnsolvable], s.kinds[Kind::kRejected],
                          s.kinds[Kind::kNoAnswer], s.kinds[Kind::kRefused]});
  });
  return table;
}

Table TimeTable(const ComparedSessions& compared) {
  Table table{
      "times",
      "Planning time, ms",
      "From request and scene at hand to the first confirmed path, failed attempts before it "
      "included. Solved is a problem with a confirmed path in one trial at least; it counts once, "
      "by the median of such trials. The median's 95 % interval lies between order statistics. "
      "Penalised mean (PAR-10): over all runs, one without a confirmed path as ten times the "
      "longest limit that anybody had on its problem. It has no interval: it hangs on a few "
      "failures, on the tail of what any resampling would go by.",
      {{"set", "set"},
       {"contestant", "contestant"},
       {"problems_solved", "problems solved", Style::kCount},
       {"median_ms", "median [95 %]", Style::kNumber, true},
       {"mean_ms", "mean", Style::kNumber},
       {"lower_quartile_ms", "25 %", Style::kNumber},
       {"upper_quartile_ms", "75 %", Style::kNumber},
       {"percentile_95_ms", "95 %", Style::kNumber},
       {"penalised_mean_ms", "penalised mean", Style::kNumber}},
      {}};
  ForEach(compared, [&](const std::string& set, const ComparedContestant& contestant,
                        const Outcomes& outcomes) {
    const TimeSummary s = SummarizeTimes(outcomes);
    table.rows.push_back({set, contestant.name, s.solved_s.count,
                          Milliseconds(s.solved_s.median, s.median_interval_s),
                          kMsPerS * s.solved_s.mean, kMsPerS * s.solved_s.lower_quartile,
                          kMsPerS * s.solved_s.upper_quartile, kMsPerS * s.solved_s.percentile_95,
                          kMsPerS * s.penalised_mean_s});
  });
  return table;
}

Table DirectionTable(const ComparedSessions& compared) {
  Table table{
      "directions",
      "Planning time of confirmed attempts by direction, ms",
      "Of the contestants that searched from goal to start, too. Attempts of either direction for "
      "themselves, without what an attempt before them took; a problem counts once, by the median "
      "of its confirmed ones. Of a trial with confirmed paths of both directions success, times, "
      "curves, path quality, phases and mesh verdicts count the one from start to goal.",
      {{"set", "set"},
       {"contestant", "contestant"},
       {"direction", "direction"},
       {"attempts", "attempts", Style::kCount},
       {"confirmed", "confirmed", Style::kCount},
       {"problems_solved", "problems solved", Style::kCount},
       {"median_ms", "median", Style::kNumber},
       {"mean_ms", "mean", Style::kNumber},
       {"lower_quartile_ms", "25 %", Style::kNumber},
       {"upper_quartile_ms", "75 %", Style::kNumber},
       {"percentile_95_ms", "95 %", Style::kNumber}},
      {}};
  ForEach(compared,
          [&](const std::string& set, const ComparedContestant& contestant, const Outcomes&) {
            const auto of_direction = [&](Direction direction) {
              std::vector<const StoredRun*> runs;
              for (const StoredRun* run : contestant.runs) {
                if (run->problem_set == set && run->direction == direction) runs.push_back(run);
              }
              return runs;
            };
            if (of_direction(Direction::kBackward).empty()) return;
            for (const Direction direction : EnumValues<Direction>()) {
              const std::vector<const StoredRun*> runs = of_direction(direction);
              if (runs.empty()) continue;
              int confirmed = 0;
              ValuesByProblem times_ms;
              for (const StoredRun* run : runs) {
                if (!run->confirmed()) continue;
                ++confirmed;
                times_ms[run->problem_index].push_back(kMsPerS *
                                                       run->time_s.value_or(run->roundtrip_time_s));
              }
              const Summary s = SummarizeByProblem(times_ms);
              table.rows.push_back({set, contestant.name, std::string(EnumName(direction)),
                                    static_cast<int>(runs.size()), confirmed, s.count, s.median,
                                    s.mean, s.lower_quartile, s.upper_quartile, s.percentile_95});
            }
          });
  return table;
}

Table PairTable(const std::vector<ComparedPair>& pairs) {
  Table table{
      "pairs",
      "Problem by problem",
      "Problems: that both tried. Faster, slower: those that the first solved faster, or alone, "
      "and the other way round. Both: those that both solved, in more than 0 s. Time ratio: "
      "geometric mean of first / second over these, with Student's 95 % interval of the "
      "logarithms' mean (six problems at least). p: Wilcoxon's signed-rank test of the logarithms, "
      "two-sided, problems that only one solved included and ties left out; beside it adjusted for "
      "all pairs of the set (Holm). Effect: rank-biserial correlation, -1 if the first is always "
      "faster, 1 if always slower; here ties count, with the lowest ranks and no side.",
      {{"set", "set"},
       {"first", "first"},
       {"second", "second"},
       {"problems", "problems", Style::kCount},
       {"faster", "faster", Style::kCount},
       {"slower", "slower", Style::kCount},
       {"tied", "tied", Style::kCount},
       {"problems_in_ratio", "both", Style::kCount},
       {"time_ratio", "time ratio [95 %]", Style::kRatio, true},
       {"p", "p", Style::kPValue},
       {"p_holm", "p (Holm)", Style::kPValue},
       {"effect", "effect", Style::kNumber}},
      {}};
  std::vector<PairedComparison> rows;
  for (const ComparedPair& pair : pairs) {
    const PairedComparison& r = pair.result;
    rows.push_back(r);
    table.rows.push_back({pair.set, pair.first, pair.second, r.num_problems, r.wins.won,
                          r.wins.lost, r.wins.tied, r.num_in_ratio(),
                          r.ratio ? Cell(Estimate{r.ratio->mean, r.ratio->interval}) : Cell(),
                          r.test.p_value, pair.adjusted_p, r.test.rank_biserial});
  }
  table.note = fmt::format("{}{}{}{}", kProblemTimeNote, table.note, ZeroTimesNote(rows),
                           NearRatiosNote(rows));
  return table;
}

Table QualityTable(const ComparedSessions& compared) {
  Table table{"quality",
              "Path quality",
              "Measures are the referee's, of confirmed runs, tip travel and clearance at its "
              "samples of the path; a problem counts once, by the median of its runs, one that was "
              "confirmed in both directions by its path from start to goal. Ratio: to the "
              "reference, which is the contestant of highest rank that has such values on the "
              "set; geometric mean over the problems that both have values of (both), with "
              "Student's 95 % interval. Problems at which either's is 0, as the smoothness of a "
              "straight path, have no ratio and are none of them. Medians over different "
              "problems do not compare. Simplified: as each planner does it, which is alike for "
              "planbench's and those that are built on its library alone. Rejected: confirmed runs "
              "whose simplified path the referee rejected, which are left out.",
              {{"set", "set"},
               {"contestant", "contestant"},
               {"measure", "measure"},
               {"unit", "unit"},
               {"path", "path"},
               {"problems", "problems", Style::kCount},
               {"lower_quartile", "25 %", Style::kNumber},
               {"median", "median", Style::kNumber},
               {"upper_quartile", "75 %", Style::kNumber},
               {"reference", "reference"},
               {"problems_in_ratio", "both", Style::kCount},
               {"ratio_to_reference", "ratio [95 %]", Style::kRatio, true},
               {"simplified_rejected", "rejected", Style::kCount}},
              {}};
  for (const auto& [set, by_contestant] : compared.outcomes()) {
    for (const PathMeasure& measure : PathMeasures()) {
      for (const bool raw : {true, false}) {
        const std::string* reference = nullptr;
        std::map<std::string, ValuesByProblem> all;
        for (const ComparedContestant& contestant : compared.contestants()) {
          if (!by_contestant.contains(contestant.name)) continue;
          ValuesByProblem& values = all[contestant.name];
          values = MeasuredByProblem(contestant, set, measure.name, raw);
          const Summary s = SummarizeByProblem(values);
          const int rejected = raw ? 0 : NumRejectedSimplified(contestant, set);
          // That all are rejected is told of what was measured of their raw paths.
          if (s.count == 0 &&
              (rejected == 0 || MeasuredByProblem(contestant, set, measure.name, true).empty())) {
            continue;
          }
          Cell in_ratio, ratio;
          if (reference != nullptr) {
            const auto estimate = CompareByProblem(values, all.at(*reference));
            in_ratio = estimate ? estimate->num_pairs : 0;
            if (estimate) ratio = Estimate{estimate->mean, estimate->interval};
          } else if (s.count > 0) {
            reference = &contestant.name;
          }
          table.rows.push_back({set, contestant.name, std::string(measure.name),
                                std::string(measure.unit), std::string(raw ? "raw" : "simplified"),
                                s.count, s.lower_quartile, s.median, s.upper_quartile,
                                reference == nullptr ? std::string() : *reference, in_ratio, ratio,
                                raw ? Cell() : Cell(rejected)});
        }
      }
    }
  }
  return table;
}

Table PhaseTable(const ComparedSessions& compared) {
  Table table{
      "phases",
      "Where the time goes, ms",
      "Means over confirmed runs, of one confirmed in both directions the attempt from start to "
      "goal; the first four are a partition of the time to the end of the search, of the attempts "
      "of which the planner tells it. Simplification comes after "
      "planning and is no part of any planning time; its mean is over the attempts that had any.",
      {{"set", "set"},
       {"contestant", "contestant"},
       {"attempts", "attempts", Style::kCount},
       {"setup_ms", "set-up", Style::kNumber},
       {"collision_ms", "collision checking", Style::kNumber},
       {"guidance_ms", "guidance", Style::kNumber},
       {"search_ms", "search", Style::kNumber},
       {"simplification_ms", "simplification", Style::kNumber}},
      {}};
  ForEach(compared, [&](const std::string& set, const ComparedContestant& contestant,
                        const Outcomes&) {
    const std::vector<const StoredRun*> runs = ConfirmedRuns(contestant, set);
    if (runs.empty()) return;
    const PhaseTimes mean = MeanPhases(runs);
    const auto phase = [&](double time_s) {
      return mean.AreTold() ? Cell(kMsPerS * time_s) : Cell();
    };
    const auto simplification_s = mean.Simplification();
    table.rows.push_back({set, contestant.name, static_cast<int>(runs.size()), phase(mean.setup_s),
                          phase(mean.collision_s), phase(mean.guidance_s), phase(mean.search_s),
                          simplification_s ? Cell(kMsPerS * *simplification_s) : Cell()});
  });
  return table;
}

Table FailureTable(const ComparedSessions& compared) {
  Table table{
      "failures",
      "Attempts without a confirmed path",
      "Attempts, each direction and trial for itself, that ended alike; reasons that differ "
      "in their figures alone are one, worded as the first. In parentheses how many of a "
      "problem if several.",
      {{"set", "set"},
       {"contestant", "contestant"},
       {"status", "status"},
       {"reason", "reason"},
       {"attempts", "attempts", Style::kCount},
       {"problems", "problems"}},
      {}};
  ForEach(compared, [&](const std::string& set, const ComparedContestant& contestant,
                        const Outcomes&) {
    for (const FailureGroup& group : GroupFailures(contestant, set)) {
      std::vector<std::string> problems;
      for (const auto& [problem, count] : group.problems) {
        problems.push_back(count == 1 ? fmt::format("{}", problem)
                                      : fmt::format("{} ({})", problem, count));
      }
      table.rows.push_back({set, contestant.name, std::string(EnumName(group.status)), group.reason,
                            group.num_runs, fmt::format("{}", fmt::join(problems, ", "))});
    }
  });
  return table;
}

Table MeshTable(const ComparedSessions& compared) {
  Table table{
      "meshes",
      "What was claimed, confirmed, and true of the robot's meshes",
      "Runs, of which both directions count as one. Claimed: the planner says that it found a "
      "path. Confirmed: the referee agrees, with the planners' own collision model. Valid: so does "
      "the exact geometry of the meshes, of the "
      "confirmed paths that it judged; the share is the mean over the problems with such paths of "
      "the share of them valid, with Wilson's 95 % interval for as many cases as there are "
      "problems. Depth: median over the raw paths that the meshes do not allow, where they first "
      "touch. "
      "Median: planning "
      "time of the paths judged. "
      "Commonest contact: of these paths, in parentheses how many.",
      {{"set", "set"},
       {"contestant", "contestant"},
       {"claimed", "claimed", Style::kCount},
       {"confirmed", "confirmed", Style::kCount},
       {"judged", "judged by meshes", Style::kCount},
       {"valid", "valid", Style::kCount},
       {"valid_percent", "% [95 %]", Style::kShare, true},
       {"simplified_judged", "simplified, judged", Style::kCount},
       {"simplified_valid", "valid", Style::kCount},
       {"depth_mm", "depth, mm", Style::kNumber},
       {"median_ms", "median, ms", Style::kNumber},
       {"commonest_contact", "commonest contact"}},
      {}};
  ForEach(compared, [&](const std::string& set, const ComparedContestant& contestant,
                        const Outcomes& outcomes) {
    int judged = 0, valid = 0, simple_judged = 0, simple_valid = 0;
    std::map<int, std::vector<bool>> valid_by_problem;  // of those judged
    std::map<std::string, int> contacts;
    std::vector<double> depths_m;
    std::vector<double> times_s;
    for (const StoredRun* run : ConfirmedRuns(contestant, set)) {
      simple_judged += run->mesh_valid_simple.has_value();
      simple_valid += run->mesh_valid_simple.value_or(false);
      if (!run->mesh_valid) continue;
      ++judged;
      times_s.push_back(run->time_s.value_or(0));
      valid += *run->mesh_valid;
      valid_by_problem[run->problem_index].push_back(*run->mesh_valid);
      if (!*run->mesh_valid) ++contacts[ContactOf(run->mesh_reason)];
      if (run->mesh_depth_m) depths_m.push_back(*run->mesh_depth_m);
    }
    if (judged == 0) return;
    double sum_of_shares = 0;
    for (const auto& [problem, of_problem] : valid_by_problem) {
      sum_of_shares += static_cast<double>(std::count(of_problem.begin(), of_problem.end(), true)) /
                       static_cast<double>(of_problem.size());
    }
    const int num_problems = static_cast<int>(valid_by_problem.size());
    const SuccessSummary success = SummarizeSuccess(outcomes);
    table.rows.push_back(
        {set, contestant.name, success.claimed, success.confirmed, judged, valid,
         Percent(sum_of_shares / num_problems, WilsonInterval(sum_of_shares, num_problems)),
         simple_judged, simple_valid,
         depths_m.empty() ? Cell() : Cell(1e3 * Summarize(depths_m).median),
         kMsPerS * Summarize(times_s).median, Commonest(contacts)});
  });
  return table;
}

std::vector<std::string> TableNames() {
  std::vector<std::string> names;
  for (const Table& table : MakeTables(ComparedSessions({}), {})) names.push_back(table.name);
  return names;
}

std::vector<Table> AllTables(const ComparedSessions& compared,
                             const std::vector<ComparedPair>& pairs) {
  std::vector<Table> tables = MakeTables(compared, pairs);
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  if (const std::string limits = LimitsNote(compared); !limits.empty()) {
    for (Table& table : tables) {
      const bool has_times =
          table.name == "times" || table.name == "pairs" || table.name == "changes";
      if (has_times) table.note += " " + limits;
    }
  }
  for (Table& table : tables) MarkTrained(compared, &table);
  return tables;
}

}  // namespace planbench
