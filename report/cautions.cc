#include "report/cautions.h"

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
#include "report/doubts.h"
#include "report/tables.h"
#include "report/wording.h"
#include "results/quality.h"
#include "results/reproduce.h"

namespace planbench {
namespace {

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

}  // namespace

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
    if (std::string trained = DescribeTraining(compared, contestant); !trained.empty()) {
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
    for (const auto& set : compared.outcomes()) {
      for (const StoredRun* run : ConfirmedRuns(contestant, set.first)) {
        simplified.push_back(run->simplified_valid);
      }
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
