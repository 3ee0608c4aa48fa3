#include "results/ompl_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/error.h"
#include "common/lookup.h"

namespace planbench {
namespace {

constexpr char kApproximate[] = "Approximate solution";

PlanStatus StatusNamed(const std::string& text) {
  static const std::map<std::string, PlanStatus> statuses = {
      {"Exact solution", PlanStatus::kSolved},
      {"Invalid start", PlanStatus::kStartInvalid},
      {"Invalid goal", PlanStatus::kGoalInvalid},
      {"Unrecognized goal type", PlanStatus::kInvalidRequest},
      {"Crash", PlanStatus::kNoAnswer},
      {"Abort", PlanStatus::kCancelled},
      {"Infeasible", PlanStatus::kExhausted}};
  if (const auto own = ParseEnum<PlanStatus>(text)) return *own;
  return Lookup(statuses, text).value_or(PlanStatus::kTimedOut);
}

int Whole(const OmplProperties& properties, const std::string& name, int otherwise) {
  constexpr double kMost = 1e9;
  const auto value = FindAmount(properties, name);
  if (value && *value > kMost) {
    throw InputError(fmt::format("{}: {} is out of range", name, *value));
  }
  return value ? static_cast<int>(*value) : otherwise;
}

/// Nothing without a status, or with one that is not among them.
std::optional<std::string> StatusName(const OmplStatuses& statuses,
                                      const OmplProperties& properties) {
  return Lookup(statuses, Whole(properties, "status", -1));
}

void SetProblem(const std::string& experiment, const OmplProperties& properties, StoredRun* run) {
  run->problem_set = experiment;
  run->problem_index = 1;
  const std::size_t slash = experiment.rfind('/');
  if (slash != std::string::npos) {
    int index = 0;
    const char* last = experiment.data() + experiment.size();
    const auto [end, error] = std::from_chars(experiment.data() + slash + 1, last, index);
    if (error == std::errc() && end == last && index >= 0) {
      run->problem_set = experiment.substr(0, slash);
      run->problem_index = index;
    }
  }
  if (const auto set = properties.find("problem_set"); set != properties.end()) {
    run->problem_set = set->second;
  }
  run->problem_index = Whole(properties, "problem_index", run->problem_index);
  if (const auto direction = properties.find("direction"); direction != properties.end()) {
    run->direction = ParseEnum<Direction>(direction->second).value_or(Direction::kForward);
  }
}

}  // namespace

std::optional<double> FindNumber(const OmplProperties& properties, const std::string& name) {
  const auto found = properties.find(name);
  if (found == properties.end()) return std::nullopt;
  const std::string& text = found->second;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw InputError(fmt::format("{}: '{}' is no number", name, text));
  }
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<double> FindAmount(const OmplProperties& properties, const std::string& name) {
  const auto value = FindNumber(properties, name);
  if (value && *value < 0) throw InputError(fmt::format("{}: {} is negative", name, *value));
  return value;
}

OmplStatuses NumberStatuses(const std::vector<std::string>& names) {
  OmplStatuses statuses;
  for (const std::string& name : names) {
    statuses.emplace(static_cast<std::int64_t>(statuses.size()), name);
  }
  return statuses;
}

OmplStatuses StatusesOfOmpl() {
  return NumberStatuses({"Unknown status", "Invalid start", "Invalid goal",
                         "Unrecognized goal type", "Timeout", kApproximate, "Exact solution",
                         "Crash", "Abort", "Infeasible"});
}

void AddProgress(const OmplProperties& sample, StoredRun* run) {
  const auto time_s = FindAmount(sample, "time");
  const auto cost = FindNumber(sample, "best_cost");
  const bool better = cost && (run->progress.empty() || *cost < run->progress.back().cost);
  if (!time_s || !better) return;
  PlanProgress progress;
  progress.elapsed_s = *time_s;
  progress.cost = *cost;
  run->progress.push_back(progress);
}

std::size_t OmplSession::Contestant(const std::string& planner, const std::string& settings) {
  for (std::size_t i = 0; i < session_.contestants.size(); ++i) {
    const StoredContestant& known = session_.contestants[i];
    if (known.name == planner && known.settings == settings) return i;
  }
  session_.contestants.push_back({planner, settings});
  return session_.contestants.size() - 1;
}

StoredRun& OmplSession::AddRun(std::size_t contestant, std::int64_t experiment_id,
                               const std::string& experiment, double time_limit_s,
                               const OmplStatuses& statuses, const OmplProperties& properties) {
  StoredRun run;
  run.id = static_cast<std::int64_t>(session_.runs.size()) + 1;
  run.contestant = contestant;
  SetProblem(experiment, properties, &run);
  SetTrial(experiment_id, properties, &run);
  SetStatus(statuses, properties, &run);
  run.time_limit_s = time_limit_s;
  run.time_s = FindAmount(properties, "time");
  const auto total_time_s = FindAmount(properties, "total_time");
  run.total_time_s = total_time_s.value_or(run.time_s.value_or(0));
  tells_total_.push_back(total_time_s.has_value());
  const auto measure = [&](const std::string& property, const char* name, MeasuredValues* values) {
    // A clearance below zero is how deep a path goes.
    const bool is_signed = std::string_view(name) == "clearance";
    const auto value =
        is_signed ? FindNumber(properties, property) : FindAmount(properties, property);
    if (value) (*values)[name] = *value;
  };
  for (const auto& [property, name] :
       {std::pair("solution_length", "path_length"), std::pair("solution_smoothness", "smoothness"),
        std::pair("solution_clearance", "clearance")}) {
    measure(property, name, &run.measures);
    measure(std::string("simplified_") + property, name, &run.measures_simple);
  }
  if (properties.contains("simplified_correct_solution")) {
    run.JudgeSimplified(Whole(properties, "simplified_correct_solution", 1) != 0);
  }
  run.phases.simplification_s = FindAmount(properties, "simplification_time").value_or(0);
  session_.runs.push_back(std::move(run));
  return session_.runs.back();
}

StoredSession OmplSession::Take(const std::filesystem::path& file,
                                std::vector<std::string>* warnings) {
  if (num_contradictions_ > 0) {
    warnings->push_back(
        fmt::format("{}: status and solved contradict each other in {} runs: what counts is solved",
                    file.string(), num_contradictions_));
  }
  if (num_unnamed_ > 0) {
    warnings->push_back(fmt::format(
        "{}: {} runs have a status that no list names: they are solved if solved says so",
        file.string(), num_unnamed_));
  }
  CountToFirstSolutions(file, warnings);
  const bool several = session_.contestants.size() > 1;
  std::map<std::string, int> num_named, numbers;
  for (const StoredContestant& one : session_.contestants) ++num_named[one.name];
  for (StoredContestant& one : session_.contestants) {
    const std::string planner = one.name;
    one.settings = "planner = " + planner + "\n" + one.settings;
    one.name = several ? name_ + ": " + planner : name_;
    if (num_named[planner] > 1) one.name += fmt::format(" #{}", ++numbers[planner]);
  }
  return std::move(session_);
}

void OmplSession::CountToFirstSolutions(const std::filesystem::path& file,
                                        std::vector<std::string>* warnings) {
  int num_untold = 0;
  for (std::size_t i = 0; i < session_.runs.size(); ++i) {
    StoredRun& run = session_.runs[i];
    if (!run.claimed || tells_total_[i]) continue;
    if (!run.progress.empty()) {
      const double first_s = run.progress.front().elapsed_s;
      run.time_s = std::min(run.time_s.value_or(first_s), first_s);
    } else if (run.time_s) {
      ++num_untold;
    }
  }
  if (num_untold == 0) return;
  warnings->push_back(fmt::format(
      "{}: of {} of its paths no cost over time is told: as planning time the whole search counts, "
      "though an anytime planner's goes on after its first solution",
      file.string(), num_untold));
}

/// An experiment's trials stay those that it calls so where no other experiment has them.
void OmplSession::SetTrial(std::int64_t experiment_id, const OmplProperties& properties,
                           StoredRun* run) {
  Trials& trials = trials_[{run->contestant, run->problem_set, run->problem_index}];
  const int number = ++trials.num_runs[{experiment_id, run->direction}];
  const int given = Whole(properties, "trial", number);
  const auto [place, is_new] = trials.numbers.try_emplace({experiment_id, given}, given);
  if (is_new && !trials.taken.insert(given).second) {
    place->second = *trials.taken.rbegin() + 1;
    trials.taken.insert(place->second);
  }
  run->trial = place->second;
  if (trials.made.emplace(run->trial, run->direction).second) return;
  throw InputError(fmt::format("trial: '{}' has trial {} of problem {} of '{}', {}, twice",
                               session_.contestants[run->contestant].name, given,
                               run->problem_index, run->problem_set, EnumName(run->direction)));
}

/// `solved` counts, not the status: that means what the list says which names it, and a database
/// keeps but one of the lists of its logs.
void OmplSession::SetStatus(const OmplStatuses& statuses, const OmplProperties& properties,
                            StoredRun* run) {
  const std::optional<std::string> name = StatusName(statuses, properties);
  const PlanStatus named = name ? StatusNamed(*name) : PlanStatus::kTimedOut;
  const bool claims = named == PlanStatus::kSolved;
  const bool approximate =
      Whole(properties, "approximate_solution", name == kApproximate ? 1 : 0) == 1;
  const bool solved = Whole(properties, "solved", claims ? 1 : 0) == 1 && !approximate;
  if (name && solved != claims) ++num_contradictions_;
  if (solved) {
    run->status = PlanStatus::kSolved;
  } else if (claims) {
    run->status = PlanStatus::kTimedOut;
    run->message = fmt::format("not solved, though its status is '{}'", *name);
  } else {
    run->status = named;
    run->message = name.value_or("");
  }
  if (!name && properties.contains("status")) {
    ++num_unnamed_;
    if (!solved) run->message = "status " + properties.at("status") + ", which no list names";
  }
  if (solved && Whole(properties, "correct_solution", 1) == 0) {
    run->status = PlanStatus::kInvalidPath;
    run->message = "OMPL found the path incorrect";
  }
  run->claimed = run->confirmed() || run->status == PlanStatus::kInvalidPath;
}

}  // namespace planbench
