#include "benchmark_driver/schedule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "common/error.h"

namespace planbench {
namespace {

std::vector<const ProblemSetSummary*> SelectSets(const std::vector<std::string>& names,
                                                 const ProblemSetsMessage& served) {
  std::vector<const ProblemSetSummary*> selected;
  std::vector<std::string_view> known;
  for (const ProblemSetSummary& set : served.sets) {
    known.push_back(set.name);
    if (names.empty()) selected.push_back(&set);
  }
  for (const std::string& name : names) {
    const auto found = std::find_if(served.sets.begin(), served.sets.end(),
                                    [&](const ProblemSetSummary& set) { return set.name == name; });
    if (found == served.sets.end()) {
      throw InputError(
          fmt::format("--sets: the scene server has no problem set '{}'; it serves: {}", name,
                      fmt::join(known, ", ")));
    }
    selected.push_back(&*found);
  }
  return selected;
}

}  // namespace

std::vector<ScheduledRun> MakeSchedule(const DriverOptions& options,
                                       const ProblemSetsMessage& served) {
  const PlanRequest& request = options.conditions.request;
  std::vector<ScheduledRun> schedule;
  for (const ProblemSetSummary* set : SelectSets(options.sets, served)) {
    std::vector<int> indices;
    if (options.problem_indices.empty()) {
      indices = set->indices;
    } else {
      std::set_intersection(set->indices.begin(), set->indices.end(),
                            options.problem_indices.begin(), options.problem_indices.end(),
                            std::back_inserter(indices));
    }
    if (indices.empty()) {
      throw InputError(
          set->indices.empty()
              ? fmt::format("the problem set '{}' is empty", set->name)
              : fmt::format("--problems-range selects no problem of '{}', which has {} "
                            "from {} to {}",
                            set->name, set->indices.size(), set->indices.front(),
                            set->indices.back()));
    }
    for (const int index : indices) {
      for (const std::string& planner : options.planners) {
        for (int trial = 1; trial <= options.trials; ++trial) {
          for (const Direction direction : options.directions) {
            schedule.push_back({planner, set->name, index, direction, trial,
                                request.seed + static_cast<std::uint64_t>(trial) - 1,
                                fmt::format("{}/{}/{}/{}/{}/{}", request.run_id, set->name, index,
                                            planner, EnumName(direction), trial)});
          }
        }
      }
    }
  }
  return schedule;
}

}  // namespace planbench
