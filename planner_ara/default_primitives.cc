#include "planner_ara/default_primitives.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner_ara/lattice.h"
#include "robot_model/motion_bound.h"

namespace planbench {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// m, of prismatic joints: long ones (rails, gantries, bases) and short ones (torsos, booms).
constexpr double kTravelOfARail = 1;
constexpr double kShortSlide = 0.1;
constexpr double kLongestSlide = 0.3;  // 0.5: two arms on a rail miss the way between things

bool IsRail(const JointSpace::Joint& joint) {
  return joint.prismatic && joint.upper - joint.lower > kTravelOfARail;
}

double LongMove(const JointSpace::Joint& joint, bool is_major) {
  if (IsRail(joint)) return std::min((joint.upper - joint.lower) / 5, kLongestSlide);
  return joint.prismatic ? kShortSlide : (is_major ? 20 : 40) * kDegree;
}

// The divisor of `whole` nearest to `wanted`, `wanted` itself if none is within a third of it.
int NearestDivisor(int whole, int wanted) {
  for (int off = 0; 3 * off <= wanted; ++off) {
    for (const int candidate : {wanted - off, wanted + off}) {
      if (candidate > 0 && whole % candidate == 0) return candidate;
    }
  }
  return wanted;
}

}  // namespace

std::vector<double> JointReaches(const Robot& robot, const PlanningGroup& group) {
  std::vector<LinkSphere> balls = robot.spheres.empty() ? robot.enclosing_spheres : robot.spheres;
  if (balls.empty()) {
    for (int link = 0; link < robot.model.num_links(); ++link) {
      balls.push_back({link, Eigen::Vector3d::Zero(), 0});
    }
  }
  return MotionBound(robot.model, group, robot.model.DefaultPositions(), balls).reach();
}

std::vector<char> MajorJoints(const JointSpace& space, std::span<const double> reaches,
                              const Arms& arms) {
  std::vector<double> longest(static_cast<std::size_t>(arms.num) + 1, 0.0);  // by arm
  const auto longest_beside = [&](std::size_t j) -> double& {
    return longest[static_cast<std::size_t>(arms.of_joint[j])];
  };
  for (std::size_t j = 0; j < reaches.size(); ++j) {
    if (space.joint(static_cast<int>(j)).prismatic) continue;
    longest_beside(j) = std::max(longest_beside(j), reaches[j]);
  }
  std::vector<char> major;
  for (std::size_t j = 0; j < reaches.size(); ++j) {
    major.push_back(space.joint(static_cast<int>(j)).prismatic ||
                    reaches[j] >= longest_beside(j) / 2);
  }
  return major;
}

double DefaultCell(const JointSpace::Joint& joint) {
  if (joint.continuous) return kDegree;
  const double range = joint.upper - joint.lower;
  // Wide ranges have larger cells: a lattice can number so many only.
  return std::max(joint.prismatic ? std::min(0.005, range / 40) : kDegree,
                  range / (Lattice::kMaxCells - 1));
}

MotionPrimitives DefaultPrimitives(const JointSpace& space, std::span<const double> discretization,
                                   std::span<const char> major,
                                   const std::vector<std::vector<char>>& on_one_arm) {
  const auto n = static_cast<std::size_t>(space.size());
  std::vector<int> cells;
  for (std::size_t j = 0; j < n; ++j) {
    const JointSpace::Joint& joint = space.joint(static_cast<int>(j));
    const double size = std::min(LongMove(joint, major[j] != 0), (joint.upper - joint.lower) / 3);
    const int whole = std::max(1, static_cast<int>(size / discretization[j] + 1e-9));
    const int circle = static_cast<int>(std::lround(2 * std::numbers::pi / discretization[j]));
    cells.push_back(joint.continuous ? NearestDivisor(circle, whole) : whole);
  }
  MotionPrimitives primitives;
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<int> move(n, 0);
    move[j] = cells[j];
    primitives.long_moves.push_back(move);
    move[j] = cells[j] / 2;
    if (move[j] > 0) primitives.short_moves.push_back(move);
  }
  const auto moves_in_pairs = [&](std::size_t j) {
    const JointSpace::Joint& joint = space.joint(static_cast<int>(j));
    return joint.prismatic ? IsRail(joint) : major[j] != 0;
  };
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      if (!moves_in_pairs(a) || !moves_in_pairs(b) || on_one_arm[a][b] == 0) continue;
      for (const int sign : {1, -1}) {
        std::vector<int> move(n, 0);
        move[a] = cells[a];
        move[b] = sign * cells[b];
        primitives.long_moves.push_back(std::move(move));
      }
    }
  }
  return primitives;
}

}  // namespace planbench
