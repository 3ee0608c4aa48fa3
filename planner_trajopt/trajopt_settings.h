#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/enum_names.h"
#include "common/yaml.h"

namespace planbench {

enum class TrajoptAlgorithm { kStomp, kChomp };
template <>
struct EnumNames<TrajoptAlgorithm> {
  static constexpr auto kNames = std::to_array<std::string_view>({"STOMP", "CHOMP"});
};

/// Settings of planner_trajopt, each by its name.
struct TrajoptSettings {
  TrajoptAlgorithm algorithm = TrajoptAlgorithm::kStomp;
  /// That are optimised: those between start and goal.
  int waypoints = 48;
  /// Distance from obstacles from which on they cost nothing, m.
  double clearance = 0.05;
  /// Weight of the squared length of motions beside the cost of obstacles, where what is optimised
  /// has to get out of these first ...
  double smoothness = 0.001;
  double given_smoothness = 0.3;  ///< ... and of a path given that is free and to become shorter.
  /// Iterations that a guess has at most.
  int iterations = 200;
  /// A guess is given up after this many iterations without a lower cost.
  int patience = 10;
  /// Initial guesses at most, beside a path that is given. None (`unlimited`): until the time
  /// limit.
  std::optional<int> guesses;

  // Of STOMP:
  int rollouts = 16;  ///< Noisy trajectories an iteration.
  /// Largest standard deviation of a joint's noise, as a part of its range (of a turn, for
  /// continuous joints).
  double noise = 0.05;
  double gain = 10;  ///< Of an iteration's update.

  // Of CHOMP:
  double step = 0.1;            ///< Largest motion of a joint in an iteration, rad or m.
  double gradient_step = 0.02;  ///< Of the finite differences, rad or m.

  /// The algorithm's name and how many guesses it has.
  std::string VariantName() const;
};

/// Reads settings; keys that are missing keep their values in `defaults`. Throws InputError for
/// unknown keys and algorithms, bad values or none, and keys of the algorithm that is not chosen.
TrajoptSettings ReadTrajoptSettings(const YamlNode& node, const TrajoptSettings& defaults);

/// The settings that are in effect, as text.
std::map<std::string, std::string> DescribeSettings(const TrajoptSettings& settings);

/// The planner's own and the request's over them. Throws InputError as ReadTrajoptSettings does,
/// and for `algorithm` and `guesses`, which a request cannot change.
TrajoptSettings SettingsOfRequest(const TrajoptSettings& settings,
                                  const std::map<std::string, std::string>& parameters);

}  // namespace planbench
