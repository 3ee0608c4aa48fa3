#include "report/doubts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <vector>

#include "common/lookup.h"
#include "report/trained.h"
#include "results/disputed_ends.h"
#include "results/training.h"
#include "results/untold_times.h"

namespace planbench {

std::string DescribeTraining(const ComparedSessions& compared,
                             const ComparedContestant& contestant) {
  const std::vector<std::string> sets = SetsLearnedFrom(compared, contestant);
  if (sets.empty()) return "";
  return fmt::format(
      "{} has learned from {}, on which it is tried here: its figures there are no test.",
      contestant.name, fmt::join(sets, ", "));
}

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

}  // namespace planbench
