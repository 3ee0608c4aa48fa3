#include "benchmark_driver/schedule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <random>
#include <string_view>
#include <utility>

#include "common/content_hash.h"
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

std::vector<int> SelectProblems(const ProblemSetSummary& set, const std::vector<int>& wanted) {
  std::vector<int> indices;
  if (wanted.empty()) {
    indices = set.indices;
  } else {
    std::set_intersection(set.indices.begin(), set.indices.end(), wanted.begin(), wanted.end(),
                          std::back_inserter(indices));
  }
  if (!indices.empty()) return indices;
  throw InputError(
      set.indices.empty()
          ? fmt::format("the problem set '{}' is empty", set.name)
          : fmt::format("--problems-range selects no problem of '{}', which has {} from {} to {}",
                        set.name, set.indices.size(), set.indices.front(), set.indices.back()));
}

/// Hash of a session's seed and what it is to decide. Below 2^63.
template <typename... Parts>
std::uint64_t Derive(std::uint64_t seed, const Parts&... parts) {
  ContentHash hash;
  hash.Add(static_cast<std::int64_t>(seed));
  (hash.Add(parts), ...);
  const std::string digits = hash.HexDigest().substr(0, 16);
  std::uint64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  return value >> 1;
}

/// A permutation of `entrants`. (std::shuffle differs from library to library.)
std::vector<Entrant> Shuffled(std::vector<Entrant> entrants, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::size_t i = entrants.size(); i > 1; --i)
    std::swap(entrants[i - 1], entrants[random() % i]);
  return entrants;
}

std::vector<Direction> AttemptsOf(const Entrant& entrant) {
  using enum Direction;
  switch (entrant.directions) {
    case Directions::kForward:
      return {kForward};
    case Directions::kBackward:
      return {kBackward};
    case Directions::kBoth:
      return {kForward, kBackward};
    case Directions::kAuto:
      if (entrant.IsAskedOnce()) return {kForward};
      return {kForward, kBackward};
  }
  return {};
}

}  // namespace

Entrant MakeEntrant(const Contestant& contestant, Directions directions,
                    const std::map<std::string, NodeStatusMessage>& planners) {
  const NodeStatusMessage& planner = planners.at(contestant.planner);
  Entrant entrant = {planner.name, directions, planner.can_backward, planner.bidirectional,
                     planner.deterministic};
  if (!contestant.first_path_of.empty()) {
    // Whether there is a path at all is the other's matter.
    const NodeStatusMessage& first = planners.at(contestant.first_path_of);
    entrant.can_backward = entrant.can_backward && first.can_backward;
    entrant.bidirectional = first.bidirectional;
    entrant.deterministic = entrant.deterministic && first.deterministic;
  }
  return entrant;
}

std::uint64_t RunSeed(std::uint64_t session_seed, const std::string& problem_set, int problem_index,
                      Direction direction, int trial) {
  return Derive(session_seed, problem_set, problem_index, EnumName(direction), trial);
}

std::vector<ScheduledRun> MakeSchedule(const DriverOptions& options,
                                       const std::vector<Entrant>& entrants,
                                       const ProblemSetsMessage& served) {
  const PlanRequest& request = options.conditions.request;
  std::vector<ScheduledRun> schedule;
  const auto add = [&](const std::string& set, int index, const Entrant& entrant, int trial) {
    std::optional<std::string> other;
    for (const Direction direction : AttemptsOf(entrant)) {
      ScheduledRun& run = schedule.emplace_back();
      run = {entrant.planner,
             set,
             index,
             direction,
             trial,
             RunSeed(request.seed, set, index, direction, trial),
             fmt::format("{}/{}/{}/{}/{}/{}", request.run_id, set, index, entrant.planner,
                         EnumName(direction), trial),
             other,
             entrant.directions == Directions::kBoth};
      if (entrant.directions == Directions::kAuto) other = run.request_id;
    }
  };
  const bool any_seeds_matter = std::any_of(entrants.begin(), entrants.end(),
                                            [](const Entrant& e) { return !e.deterministic; });
  const int num_trials = any_seeds_matter ? options.trials : 1;
  std::vector<std::pair<std::string, int>> problems;
  for (const ProblemSetSummary* set : SelectSets(options.sets, served)) {
    for (const int index : SelectProblems(*set, options.problem_indices)) {
      problems.emplace_back(set->name, index);
    }
  }
  // Counted trial by trial, so that each shard has its share of the first one, which is all that
  // deterministic contestants make, and that who they are changes nothing.
  const auto is_of_shard = [&](std::size_t problem, int trial) {
    const std::size_t part = static_cast<std::size_t>(trial - 1) * problems.size() + problem;
    return part % static_cast<std::size_t>(options.shard.count) ==
           static_cast<std::size_t>(options.shard.index - 1);
  };
  for (std::size_t problem = 0; problem < problems.size(); ++problem) {
    const auto& [set, index] = problems[problem];
    for (int trial = 1; trial <= num_trials; ++trial) {
      if (!is_of_shard(problem, trial)) continue;
      const std::uint64_t order = Derive(request.seed, "order", set, index, trial);
      for (const Entrant& entrant : Shuffled(entrants, order)) {
        if (trial == 1 || !entrant.deterministic) add(set, index, entrant, trial);
      }
    }
  }
  if (schedule.empty() && options.shard.count > 1) {
    throw InputError(fmt::format(
        "--shard {}/{}: there are no more than {} parts, trials of problems", options.shard.index,
        options.shard.count, problems.size() * static_cast<std::size_t>(num_trials)));
  }
  return schedule;
}

}  // namespace planbench
