#include "report/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

#include "common/numbers.h"
#include "common/version.h"
#include "planning/path_measures.h"
#include "report/answer.h"
#include "report/cautions.h"
#include "report/session_tables.h"
#include "report/tables.h"
#include "report/trained.h"
#include "results/curves.h"
#include "results/quality.h"

namespace planbench {
namespace {

Json Rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

/// Sets and contestants by their places.
class Places {
 public:
  explicit Places(const ComparedSessions& compared) {
    for (const auto& [set, by_contestant] : compared.outcomes()) {
      sets_.emplace(set, static_cast<int>(sets_.size()));
    }
    for (const ComparedContestant& one : compared.contestants()) {
      contestants_.emplace(one.name, static_cast<int>(contestants_.size()));
    }
  }
  int set(const std::string& name) const { return sets_.at(name); }
  int contestant(const std::string& name) const { return contestants_.at(name); }

 private:
  std::map<std::string, int> sets_;
  std::map<std::string, int> contestants_;
};

/// Every set, and all together if there are several, in the page's order.
std::vector<std::pair<std::string, const std::map<std::string, Outcomes>*>> SetsAndAll(
    const ComparedSessions& compared) {
  std::vector<std::pair<std::string, const std::map<std::string, Outcomes>*>> sets;
  for (const auto& [set, by_contestant] : compared.outcomes())
    sets.emplace_back(set, &by_contestant);
  if (sets.size() > 1) sets.emplace_back(kAllSets, &compared.pooled());
  return sets;
}

/// Of each contestant that tried the set what `make` makes of its outcomes, with its place.
template <typename Make>
Json ByContestant(const ComparedSessions& compared, const std::map<std::string, Outcomes>& set,
                  Make make) {
  Json json = Json::array();
  for (std::size_t i = 0; i < compared.contestants().size(); ++i) {
    const auto found = set.find(compared.contestants()[i].name);
    if (found == set.end()) continue;
    Json one = make(found->second, compared.contestants()[i]);
    if (one.is_null()) continue;
    one["contestant"] = i;
    json.push_back(std::move(one));
  }
  return json;
}

Json SuccessJson(const Outcomes& outcomes) {
  const SuccessSummary s = SummarizeSuccess(outcomes);
  return {{"share", Rounded(s.share)},
          {"lower", Rounded(s.interval.lower)},
          {"upper", Rounded(s.interval.upper)},
          {"claimed", s.claimed},
          {"confirmed", s.confirmed},
          {"runs", s.num_runs},
          {"claimed_share", Rounded(s.claimed_share)}};
}

Json TimesJson(const Outcomes& outcomes) {
  const TimeSummary s = SummarizeTimes(outcomes);
  Json json = {{"median", Rounded(kMsPerS * s.solved_s.median)},
               {"limit", kMsPerS * outcomes.time_limit_s}};
  json["lower"] = s.median_interval_s ? Rounded(kMsPerS * s.median_interval_s->lower) : Json();
  json["upper"] = s.median_interval_s ? Rounded(kMsPerS * s.median_interval_s->upper) : Json();
  // Every run, problem by problem.
  Json problems = Json::array(), trials = Json::array(), times = Json::array();
  for (const auto& [problem, of_problem] : outcomes.by_problem) {
    for (const Outcome& outcome : of_problem) {
      problems.push_back(problem);
      trials.push_back(outcome.trial);
      times.push_back(Rounded(kMsPerS * outcome.time_s));
    }
  }
  json["problem"] = std::move(problems);
  json["trial"] = std::move(trials);
  json["time"] = std::move(times);
  return json;
}

Json SurvivalJson(const Outcomes& outcomes) {
  Json time = Json::array(), share = Json::array(), lower = Json::array(), upper = Json::array();
  for (const SolvedBy& step : SolvedOverTime(outcomes)) {
    time.push_back(Rounded(kMsPerS * step.time_s));
    share.push_back(Rounded(step.share));
    lower.push_back(Rounded(step.interval.lower));
    upper.push_back(Rounded(step.interval.upper));
  }
  return {{"time", std::move(time)},
          {"share", std::move(share)},
          {"lower", std::move(lower)},
          {"upper", std::move(upper)},
          {"limit", kMsPerS * outcomes.time_limit_s}};
}

Json Rounded(const std::optional<double>& value) { return value ? Rounded(*value) : Json(); }

/// How a contestant improves on a set.
struct Improvement {
  AnytimeCurves curves;
  /// Its costs are of a kind of its own, and are over its own lowest ones, not over anybody's.
  bool has_own_costs = false;
};

/// By contestant's name.
std::map<std::string, Improvement> ImprovementsOn(const ComparedSessions& compared,
                                                  const std::string& set) {
  std::map<std::string, std::vector<const StoredRun*>> runs;  // on the set
  std::vector<const StoredRun*> with_lengths;
  std::map<std::string, Improvement> improvements;
  for (const ComparedContestant& contestant : compared.contestants()) {
    std::vector<const StoredRun*>& own = runs[contestant.name];
    for (const StoredRun* run : contestant.runs) {
      if (run->problem_set == set) own.push_back(run);
    }
    const bool are_lengths = CostsAreLengths(contestant.runs);
    improvements[contestant.name].has_own_costs = !are_lengths;
    if (are_lengths) with_lengths.insert(with_lengths.end(), own.begin(), own.end());
  }
  const LowestCosts shortest = FindLowestCosts(with_lengths);
  for (auto& [name, improvement] : improvements) {
    const std::vector<const StoredRun*>& own = runs.at(name);
    improvement.curves =
        ImprovementOverTime(own, improvement.has_own_costs ? FindLowestCosts(own) : shortest);
  }
  return improvements;
}

Json StepsJson(const std::vector<AnytimeStep>& steps) {
  Json time = Json::array(), median = Json::array(), lower = Json::array(), upper = Json::array();
  for (const AnytimeStep& step : steps) {
    time.push_back(Rounded(kMsPerS * step.time_s));
    median.push_back(Rounded(step.median));
    lower.push_back(Rounded(step.lower));
    upper.push_back(Rounded(step.upper));
  }
  return {{"time", std::move(time)},
          {"median", std::move(median)},
          {"lower", std::move(lower)},
          {"upper", std::move(upper)}};
}

Json ProfileJson(const std::vector<ProfileStep>& steps) {
  Json ratio = Json::array(), share = Json::array();
  for (const ProfileStep& step : steps) {
    ratio.push_back(Rounded(step.ratio));
    share.push_back(Rounded(step.share));
  }
  return {{"ratio", std::move(ratio)}, {"share", std::move(share)}};
}

/// Of each problem the time that pairs are compared by.
Json ProblemTimesJson(const Outcomes& outcomes) {
  Json problem = Json::array(), time = Json::array();
  for (const auto& [index, trials] : outcomes.by_problem) {
    problem.push_back(index);
    time.push_back(TookNoTime(trials) ? Json(0) : Rounded(kMsPerS * ProblemTime(trials)));
  }
  return {{"problem", std::move(problem)}, {"time", std::move(time)}};
}

/// Places of the contestants that have learned from the set.
Json TrainedJson(const ComparedSessions& compared, const std::string& set) {
  Json places = Json::array();
  for (std::size_t i = 0; i < compared.contestants().size(); ++i) {
    if (IsTrained(compared, set, compared.contestants()[i])) places.push_back(i);
  }
  return places;
}

/// The figures of one set; `is_all`: of all together.
Json SetJson(const ComparedSessions& compared, const std::string& name,
             const std::map<std::string, Outcomes>& set, bool is_all) {
  const auto each = [&](auto make) {
    return ByContestant(compared, set, [&](const Outcomes& outcomes, const ComparedContestant&) {
      return make(outcomes);
    });
  };
  Json json = {{"name", name}, {"all", is_all}};
  json["trained"] = TrainedJson(compared, name);
  const PerformanceProfiles profiles = ProfileTimes(set);
  json["profile_problems"] = profiles.num_problems;
  json["profile"] =
      ByContestant(compared, set, [&](const Outcomes&, const ComparedContestant& contestant) {
        return ProfileJson(profiles.by_contestant.at(contestant.name));
      });
  json["survival"] = each(SurvivalJson);
  if (is_all) return json;  // made of the sets by the page, but for what is a figure of its own
  json["problem_times"] = each(ProblemTimesJson);
  json["success"] = each(SuccessJson);
  json["times"] = each(TimesJson);
  json["quality"] = Json::array();
  for (const PathMeasure& measure : PathMeasures()) {
    const auto of_paths = [&](bool raw) {
      return ByContestant(
          compared, set, [&](const Outcomes&, const ComparedContestant& contestant) -> Json {
            const Summary s =
                SummarizeByProblem(MeasuredByProblem(contestant, name, measure.name, raw));
            if (s.count == 0) return nullptr;
            return {{"problems", s.count},
                    {"lower", Rounded(s.lower_quartile)},
                    {"median", Rounded(s.median)},
                    {"upper", Rounded(s.upper_quartile)}};
          });
    };
    json["quality"].push_back({{"raw", of_paths(true)}, {"simplified", of_paths(false)}});
  }
  json["phases"] = ByContestant(
      compared, set, [&](const Outcomes&, const ComparedContestant& contestant) -> Json {
        const std::vector<const StoredRun*> runs = ConfirmedRuns(contestant, name);
        const PhaseTimes mean = MeanPhases(runs);
        if (!mean.AreTold()) return nullptr;
        const double total = mean.setup_s + mean.collision_s + mean.guidance_s + mean.search_s;
        std::set<int> problems;
        for (const StoredRun* run : runs) {
          if (run->phases.AreTold()) problems.insert(run->problem_index);
        }
        return {{"problems", problems.size()},
                {"total", Rounded(kMsPerS * total)},
                {"shares",
                 {Rounded(mean.setup_s / total), Rounded(mean.collision_s / total),
                  Rounded(mean.guidance_s / total), Rounded(mean.search_s / total)}}};
      });
  const std::map<std::string, Improvement> improvements = ImprovementsOn(compared, name);
  const auto improvement = [&](std::vector<AnytimeStep> AnytimeCurves::*steps) {
    return ByContestant(
        compared, set, [&](const Outcomes& outcomes, const ComparedContestant& contestant) -> Json {
          const Improvement& of = improvements.at(contestant.name);
          if ((of.curves.*steps).empty()) return nullptr;
          Json figure = StepsJson(of.curves.*steps);
          figure["limit"] = kMsPerS * outcomes.time_limit_s;
          figure["own_costs"] = of.has_own_costs;
          return figure;
        });
  };
  json["anytime_cost"] = improvement(&AnytimeCurves::cost);
  json["anytime_bound"] = improvement(&AnytimeCurves::bound);
  return json;
}

/// Every attempt, as columns; reasons by their places in `reasons`.
Json AttemptsJson(const ComparedSessions& compared, const Places& places) {
  struct Entry {
    int set;
    int contestant;
    const StoredRun* run;
  };
  std::vector<Entry> entries;
  for (const ComparedContestant& contestant : compared.contestants()) {
    for (const StoredRun* run : contestant.runs) {
      entries.push_back({places.set(run->problem_set), places.contestant(contestant.name), run});
    }
  }
  std::map<std::string, int> reasons;
  Json reason_texts = Json::array();
  Json columns;
  for (const Entry& entry : entries) {
    const StoredRun& run = *entry.run;
    const auto [reason, is_new] = reasons.emplace(run.message, static_cast<int>(reasons.size()));
    if (is_new) reason_texts.push_back(run.message);
    columns["run"].push_back(run.id);
    columns["set"].push_back(entry.set);
    columns["contestant"].push_back(entry.contestant);
    columns["problem"].push_back(run.problem_index);
    columns["trial"].push_back(run.trial);
    columns["direction"].push_back(static_cast<int>(run.direction));
    columns["status"].push_back(static_cast<int>(run.status));
    columns["time"].push_back(run.time_s ? Rounded(kMsPerS * *run.time_s) : Json());
    const auto length = [](const MeasuredValues& measures) {
      const auto value = FindMeasure(measures, "path_length");
      return value ? Rounded(*value) : Json();
    };
    columns["length"].push_back(length(run.measures));
    columns["length_simplified"].push_back(length(run.measures_simple));
    columns["reason"].push_back(reason->second);
  }
  columns["reasons"] = std::move(reason_texts);
  columns["statuses"] = Json::array();
  for (const PlanStatus status : EnumValues<PlanStatus>()) {
    columns["statuses"].push_back(EnumName(status));
  }
  columns["directions"] = {EnumName(Direction::kForward), EnumName(Direction::kBackward)};
  return columns;
}

}  // namespace

Json FigureData(const ComparedSessions& compared, const std::vector<ComparedPair>& pairs,
                const std::vector<Table>& tables) {
  Json json;
  json["made_by"] = "planbench " + Version() + " (" + Commit() + ")";
  json["answer"] = Answer(compared, pairs);
  json["limits_note"] = LimitsNote(compared);
  json["without_mesh_robot"] = WithoutMeshRobot(compared);
  json["contestants"] = Json::array();
  for (const ComparedContestant& one : compared.contestants()) {
    json["contestants"].push_back({{"name", one.name},
                                   {"session", compared.session_names()[one.session]},
                                   {"settings", one.settings}});
  }
  json["sessions"] = compared.session_names();
  json["cautions"] = Cautions(compared);
  json["measures"] = Json::array();
  for (const PathMeasure& measure : PathMeasures()) {
    json["measures"].push_back(
        {{"name", measure.name}, {"unit", measure.unit}, {"meaning", measure.meaning}});
  }
  json["sets"] = Json::array();
  for (const auto& [name, set] : SetsAndAll(compared)) {
    json["sets"].push_back(SetJson(compared, name, *set, set == &compared.pooled()));
  }
  json["attempts"] = AttemptsJson(compared, Places(compared));
  json["tables"] = Json::array();
  for (const Table& table : tables) json["tables"].push_back(TableJson(table));
  if (compared.sessions().size() > 1) json["differences"] = TableJson(SessionTable(compared, true));
  return json;
}

}  // namespace planbench
