#include "planner_ara/joint_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include "common/random.h"
#include "planning/plan_result.h"

namespace planbench {
namespace {

constexpr double kSpacing = 0.05;  // of the positions tried, rad
// Of the positions of the others: what is drawn, what is tried of it, which is that with which the
// joint is free at both ends, and what it takes to tell.
constexpr int kMostDrawn = 1000;
constexpr int kMostTried = 10;
constexpr int kLeastTried = 5;

// By position, whether the joint is free there, the others as they are in `others`.
std::vector<unsigned char> AreFree(EdgeChecker* edges, int joint, std::span<const double> positions,
                                   std::span<const double> others) {
  std::vector<double> qs;
  for (const double position : positions) {
    qs.insert(qs.end(), others.begin(), others.end());
    *(qs.end() - edges->space().size() + joint) = position;
  }
  std::vector<unsigned char> free(positions.size());
  edges->CheckStates(qs, static_cast<int>(positions.size()), free);
  return free;
}

std::optional<double> FindWall(EdgeChecker* edges, int j, std::span<const double> start,
                               std::span<const double> goal) {
  const std::array ends = {start[static_cast<std::size_t>(j)], goal[static_cast<std::size_t>(j)]};
  const double way = edges->space().Difference(j, ends[0], ends[1]);
  std::vector<double> between;
  const int num = static_cast<int>(std::abs(way) / kSpacing);
  for (int i = 1; i < num; ++i) between.push_back(WrapAngle(ends[0] + way * i / num));
  std::vector<int> times_blocked(between.size(), 0);
  const auto blocks = [&](std::span<const double> others) {
    const std::vector<unsigned char> free = AreFree(edges, j, between, others);
    for (std::size_t i = 0; i < free.size(); ++i) times_blocked[i] += free[i] == 0 ? 1 : 0;
    return std::ranges::count(free, 0) > 0;
  };
  if (!blocks(start) || !blocks(goal)) return std::nullopt;
  std::mt19937_64 random(1);
  Configuration others(start.size());
  int tried = 0;
  for (int drawn = 0; drawn < kMostDrawn && tried < kMostTried; ++drawn) {
    std::ranges::transform(edges->space().joints(), others.begin(), [&](const auto& joint) {
      return joint.lower + (joint.upper - joint.lower) * UniformFraction(&random);
    });
    if (std::ranges::count(AreFree(edges, j, ends, others), 0) > 0) continue;
    if (!blocks(others)) return std::nullopt;
    ++tried;
  }
  if (tried < kLeastTried) return std::nullopt;
  return between[static_cast<std::size_t>(std::ranges::max_element(times_blocked) -
                                          times_blocked.begin())];
}

}  // namespace

std::vector<std::optional<double>> FindWalls(EdgeChecker* edges, std::span<const double> start,
                                             std::span<const double> goal) {
  const JointSpace& space = edges->space();
  std::vector<std::optional<double>> walls(start.size());
  for (int j = 0; j < space.size(); ++j) {
    if (space.joint(j).continuous) {
      walls[static_cast<std::size_t>(j)] = FindWall(edges, j, start, goal);
    }
  }
  return walls;
}

}  // namespace planbench
