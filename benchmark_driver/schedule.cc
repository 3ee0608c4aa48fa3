#include "benchmark_driver/schedule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
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

/// A permutation. (std::shuffle differs from library to library.)
std::vector<PlannedPlanner> Shuffled(std::vector<PlannedPlanner> planners, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::size_t i = planners.size(); i > 1; --i)
    std::swap(planners[i - 1], planners[random() % i]);
  return planners;
}

std::vector<Direction> AttemptsOf(Directions directions) {
  using enum Direction;
  switch (directions) {
    case Directions::kForward:
      return {kForward};
    case Directions::kBackward:
      return {kBackward};
    case Directions::kBoth:
    case Directions::kAuto:
      return {kForward, kBackward};
  }
  return {};
}

}  // namespace

PlannedPlanner PlanPlanner(const Contestant& contestant, Directions directions, int trials,
                           const std::map<std::string, NodeStatusMessage>& planners) {
  const NodeStatusMessage& planner = planners.at(contestant.planner);
  bool can_backward = planner.can_backward;
  bool bidirectional = planner.bidirectional;
  bool deterministic = planner.deterministic;
  if (!contestant.first_path_of.empty()) {
    const NodeStatusMessage& first = planners.at(contestant.first_path_of);
    can_backward = can_backward && first.can_backward;
    bidirectional = first.bidirectional;
    deterministic = deterministic && first.deterministic;
  }
  const bool is_forward = directions == Directions::kAuto && (bidirectional || !can_backward);
  return {planner.name, is_forward ? Directions::kForward : directions, deterministic ? 1 : trials};
}

PlannedCall PlanCall(const DriverOptions& options, std::vector<PlannedPlanner> planners,
                     const ProblemSetsMessage& served) {
  PlannedCall call;
  call.planners = std::move(planners);
  call.shard = options.shard;
  for (const ProblemSetSummary* set : SelectSets(options.sets, served)) {
    call.sets.push_back({set->name, SelectProblems(*set, options.problem_indices)});
  }
  const std::size_t num_parts = call.NumParts();
  if (static_cast<std::size_t>(call.shard.index) > num_parts && call.shard.count > 1) {
    throw InputError(
        fmt::format("--shard {}/{}: there are no more than {} parts, trials of problems",
                    call.shard.index, call.shard.count, num_parts));
  }
  return call;
}

std::vector<std::string> ShortOfRange(const DriverOptions& options, const PlannedCall& call) {
  std::vector<std::string> lines;
  const std::size_t wanted = options.problem_indices.size();
  for (const auto& [name, indices] : call.sets) {
    if (indices.size() >= wanted) continue;
    lines.push_back(fmt::format("--problems-range: of the {} problems of that range '{}' has {}",
                                wanted, name, indices.size()));
  }
  return lines;
}

std::uint64_t RunSeed(std::uint64_t session_seed, const std::string& problem_set, int problem_index,
                      Direction direction, int trial) {
  return Derive(session_seed, problem_set, problem_index, EnumName(direction), trial);
}

std::vector<ScheduledRun> MakeSchedule(const PlannedCall& call, const PlanRequest& request) {
  std::vector<ScheduledRun> schedule;
  for (const auto& [set, index, trial] : call.Trials()) {
    const std::uint64_t order = Derive(request.seed, "order", set, index, trial);
    for (const PlannedPlanner& planner : Shuffled(call.planners, order)) {
      if (trial > planner.trials) continue;
      std::optional<std::string> other;
      for (const Direction direction : AttemptsOf(planner.directions)) {
        schedule.push_back({planner.name, set, index, direction, trial,
                            RunSeed(request.seed, set, index, direction, trial),
                            fmt::format("{}/{}/{}/{}/{}/{}", request.run_id, set, index,
                                        planner.name, EnumName(direction), trial),
                            other, planner.directions == Directions::kBoth});
        if (planner.directions == Directions::kAuto) other = schedule.back().request_id;
      }
    }
  }
  return schedule;
}

}  // namespace planbench
