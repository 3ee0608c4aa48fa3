#include "planning/free_goal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "planning/goal_sampler.h"

namespace planbench {
namespace {

/// Checked at once, between two looks at the clock.
constexpr int kBatch = 16;
constexpr std::uint64_t kSeed = 1;

/// A joint whose side of the box is all outside its limits; -1 if there is none.
int FindJointOutOfReach(const JointSpace& space, const GoalBox& goal) {
  for (int j = 0; j < space.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    const JointSpace::Joint& joint = space.joint(j);
    if (joint.continuous) continue;
    if (goal.lower[k] > joint.upper + JointSpace::kLimitTolerance) return j;
    if (goal.upper[k] < joint.lower - JointSpace::kLimitTolerance) return j;
  }
  return -1;
}

/// The part of the box within joint limits and within half a turn of the nominal point, from which
/// it is one way round to every point.
GoalBox ReachablePart(const JointSpace& space, GoalBox goal) {
  constexpr double kHalfTurn = std::numbers::pi - 1e-9;
  for (int j = 0; j < space.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    const JointSpace::Joint& joint = space.joint(j);
    const double low = joint.continuous ? goal.nominal[k] - kHalfTurn : joint.lower;
    const double high = joint.continuous ? goal.nominal[k] + kHalfTurn : joint.upper;
    goal.lower[k] = std::min(std::max(goal.lower[k], low), high);
    goal.upper[k] = std::max(std::min(goal.upper[k], high), low);
    goal.nominal[k] = std::clamp(goal.nominal[k], goal.lower[k], goal.upper[k]);
  }
  return goal;
}

}  // namespace

std::string FindFault(EdgeChecker* edges, const Configuration& q, const std::string& what) {
  if (edges->IsValidState(q)) return "";
  if (const auto fault = edges->space().FindLimitFault(q)) {
    return fmt::format("{}: {}", what, *fault);
  }
  const std::optional<Contact> contact = edges->checker().FindContact(q);
  if (!contact) return fmt::format("{} is in collision", what);
  return fmt::format("{} is in collision: {}", what, Describe(*contact));
}

GoalFinding FindFreeGoal(EdgeChecker* edges, GoalBox* goal,
                         const std::function<bool()>& should_stop) {
  const std::string fault = FindFault(edges, goal->nominal, "goal");
  if (fault.empty()) return {};
  const JointSpace& space = edges->space();
  if (goal->lower == goal->upper || FindJointOutOfReach(space, *goal) >= 0) {
    return {GoalVerdict::kInvalid, fault};
  }

  GoalBox part = ReachablePart(space, *goal);
  GoalSampler sampler(space, part, kSeed);
  const std::size_t n = part.nominal.size();
  int num_tried = 0;
  std::vector<double> batch(kBatch * n);
  std::vector<unsigned char> valid(kBatch);
  while (num_tried < kGoalTries && !should_stop()) {
    const int num = std::min(kBatch, kGoalTries - num_tried);
    for (int i = 0; i < num; ++i) {
      const Configuration q = sampler.Sample();
      std::copy(q.begin(), q.end(), batch.begin() + static_cast<std::ptrdiff_t>(i * n));
    }
    const std::span<unsigned char> verdicts(valid.data(), static_cast<std::size_t>(num));
    edges->CheckStates({batch.data(), static_cast<std::size_t>(num) * n}, num, verdicts);
    num_tried += num;
    const auto found = std::find(verdicts.begin(), verdicts.end(), 1);
    if (found == verdicts.end()) continue;
    const double* q = batch.data() + static_cast<std::size_t>(found - verdicts.begin()) * n;
    for (std::size_t k = 0; k < n; ++k) {
      // Samples are wrapped, boxes are not.
      const double offset = space.Difference(static_cast<int>(k), part.nominal[k], q[k]);
      part.nominal[k] = std::clamp(part.nominal[k] + offset, part.lower[k], part.upper[k]);
    }
    *goal = std::move(part);
    return {};
  }
  // The cause first: tables have room for the beginning.
  return {num_tried < kGoalTries ? GoalVerdict::kUndecided : GoalVerdict::kInvalid,
          fmt::format("{}; no valid point among {} tried of its region", fault, num_tried)};
}

GoalFinding KeepFreeGoals(EdgeChecker* edges, const Configuration& start,
                          std::vector<GoalBox>* goals, const std::function<bool()>& should_stop) {
  std::set<GoalBox> met;
  std::erase_if(*goals, [&met](const GoalBox& goal) { return !met.insert(goal).second; });
  std::vector<GoalBox> free;
  GoalFinding first;
  for (GoalBox& goal : *goals) {
    GoalFinding finding = FindFreeGoal(edges, &goal, should_stop);
    if (finding.verdict == GoalVerdict::kUndecided) return finding;
    if (finding.verdict == GoalVerdict::kFree) {
      free.push_back(std::move(goal));
    } else if (first.fault.empty()) {
      first = std::move(finding);
    }
  }
  if (free.empty()) {
    if (goals->size() > 1) {
      first.fault += fmt::format("; none of the {} goals is valid", goals->size());
    }
    return first;
  }
  const JointSpace& space = edges->space();
  std::stable_sort(free.begin(), free.end(), [&](const GoalBox& a, const GoalBox& b) {
    return space.Distance(start, a.nominal) < space.Distance(start, b.nominal);
  });
  *goals = std::move(free);
  return {};
}

}  // namespace planbench
