#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "robot_model/robot_folder.h"

namespace planbench {

/// How often pairs of links met in random configurations.
struct PairSamples {
  struct Pair {
    int link_a = -1;  ///< Below link_b.
    int link_b = -1;
    int contacts = 0;  ///< Configurations in which spheres of the two touch.
  };
  int samples = 0;
  std::vector<Pair> pairs;  ///< All that could be checked: links with spheres, not adjacent.

  /// Pairs that met in none.
  std::vector<std::pair<int, int>> Never() const;
  /// Pairs that met in nearly all (95 %, as MoveIt's Setup Assistant has it): their spheres overlap
  /// by construction.
  std::vector<std::pair<int, int>> Always() const;
};

/// Draws configurations of all joints of a robot, uniformly within their limits (continuous ones
/// within [-pi, pi]; planar and floating ones stay at the identity), and looks which of its spheres
/// touch. The same seed gives the same samples.
PairSamples SamplePairs(const RobotModel& model, const std::vector<LinkSphere>& spheres,
                        int samples, std::uint64_t seed);

/// Pairs of links that touch in one configuration (full positions), of those that could be checked
/// and are not in `allowed`.
std::vector<std::pair<int, int>> PairsInContact(const RobotModel& model,
                                                const std::vector<LinkSphere>& spheres,
                                                const std::vector<std::pair<int, int>>& allowed,
                                                const std::vector<double>& full_positions);

/// Share of random configurations, drawn as SamplePairs does, in which none of those pairs touch.
double FreeShare(const RobotModel& model, const std::vector<LinkSphere>& spheres,
                 const std::vector<std::pair<int, int>>& allowed, int samples, std::uint64_t seed);

}  // namespace planbench
