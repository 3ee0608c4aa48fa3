#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "robot_model/robot_folder.h"

namespace planbench {

/// Which configurations SamplePairs draws, and which pairs it looks at.
struct PairSampling {
  /// Joint indices: these are drawn (DrawPositions). All others are at their defaults, or follow
  /// these.
  std::vector<int> joints;
  int samples = 0;
  std::uint64_t seed = 0;
};

/// How often pairs of links met in random configurations.
struct PairSamples {
  struct Pair {
    int link_a = -1;  ///< Below link_b.
    int link_b = -1;
    int contacts = 0;       ///< Configurations in which spheres of the two touch.
    bool is_moved = true;   ///< By one of the joints that are drawn, one against the other.
    bool anywhere = false;  ///< By a planar or floating joint (AnywhereByPose).
  };
  int samples = 0;
  int free = 0;             ///< Configurations in which no pair touches.
  std::vector<Pair> pairs;  ///< All that are checked (Robot::ChecksLinks), of links with spheres.
  int free_if_moved = 0;    ///< Configurations in which no pair touches that is moved.

  /// Pairs that met in none, but for those that may be anywhere: samples do not tell of them.
  std::vector<std::pair<int, int>> Never() const;
  /// Pairs that met in nearly all (95 %, as MoveIt's Setup Assistant has it), likewise: their
  /// spheres overlap by construction.
  std::vector<std::pair<int, int>> Always() const;
  /// Pairs that may be anywhere.
  std::vector<std::pair<int, int>> Anywhere() const;
  /// Pairs in contact that are not moved.
  std::vector<std::pair<int, int>> HeldInContact() const;
  /// Moved pairs that met, those that met most often first; `at_most` of them.
  std::vector<Pair> MostOften(std::size_t at_most) const;
};

/// Draws configurations and looks which spheres of the robot touch. The same seed gives the same
/// samples.
PairSamples SamplePairs(const Robot& robot, const PairSampling& sampling);

/// Pairs of links that touch in one configuration (full positions), of those that are checked.
std::vector<std::pair<int, int>> PairsInContact(const Robot& robot,
                                                const std::vector<double>& full_positions);

}  // namespace planbench
