#include "results/disputed_ends.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "collision/collision_model.h"

namespace planbench {
namespace {

/// Session, collision model and index, of one set.
using ProblemKey = std::tuple<std::size_t, std::string, int>;

bool AnyIs(const std::vector<Outcome>& trials, bool (*is)(const Outcome&)) {
  return std::any_of(trials.begin(), trials.end(), is);
}

}  // namespace

std::map<std::string, std::string> DescribeDisputedEnds(
    const std::map<std::string, std::vector<JudgedOutcomes>>& sets) {
  struct Disputed {
    int count = 0;
    std::string first;
  };
  std::map<std::string, Disputed> by_contestant;
  for (const auto& [set, contestants] : sets) {
    std::set<ProblemKey> confirmed;
    for (const JudgedOutcomes& one : contestants) {
      for (const auto& [problem, trials] : one.outcomes->by_problem) {
        const auto is_confirmed = [](const Outcome& trial) { return trial.confirmed(); };
        if (AnyIs(trials, is_confirmed))
          confirmed.emplace(one.session, one.collision_model, problem);
      }
    }
    for (const JudgedOutcomes& one : contestants) {
      if (one.has_first_path || one.collision_model.empty() ||
          one.collision_model == EnumName(CollisionModel::kVoxels)) {
        continue;
      }
      for (const auto& [problem, trials] : one.outcomes->by_problem) {
        const auto is_blocked = [](const Outcome& trial) {
          return trial.kind == Outcome::Kind::kUnsolvable;
        };
        const ProblemKey key(one.session, one.collision_model, problem);
        if (!AnyIs(trials, is_blocked) || !confirmed.contains(key)) continue;
        Disputed& disputed = by_contestant[one.contestant];
        if (disputed.count++ == 0) disputed.first = fmt::format("{} {}", set, problem);
      }
    }
  }
  std::map<std::string, std::string> lines;
  for (const auto& [name, disputed] : by_contestant) {
    lines[name] = fmt::format(
        "{}: called start or goal invalid on {} problem{} of which a path is confirmed by the same "
        "collision model ({}{}).",
        name, disputed.count, disputed.count == 1 ? "" : "s", disputed.first,
        disputed.count == 1 ? "" : " the first");
  }
  return lines;
}

}  // namespace planbench
