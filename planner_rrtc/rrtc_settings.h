#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/yaml.h"
#include "planner_rrtc/flat_joints.h"
#include "planner_rrtc/joint_sampler.h"

namespace planbench {

struct OmplAlgorithm;

/// How a tree of RRT-Connect grows towards a sample.
enum class Extension {
  kStep,     ///< By one motion of at most the range: "EXTEND".
  kConnect,  ///< By one after the other until the sample or an obstacle is reached: "CONNECT".
};

template <>
struct EnumNames<Extension> {
  static constexpr auto kNames = std::to_array<std::string_view>({"step", "connect"});
};

/// Settings of planner_rrtc, each by its name.
struct RrtcSettings {
  /// Name of our own planner among the algorithms.
  static constexpr std::string_view kRrtConnect = "RRT-Connect";

  /// `algorithm`: kRrtConnect, or the name of a planner of OMPL; null: kRrtConnect.
  const OmplAlgorithm* ompl_algorithm = nullptr;
  /// Of samples from the whole space.
  SamplerKind sampler = SamplerKind::kUniform;
  /// Longest motion added to a tree, in the metric, of every algorithm that has such a limit
  /// (others take it for nothing, so that a line-up may give it to all). None (`default`): the
  /// algorithm's own choice, for RRT-Connect ShrinkingRange, for OMPL's its own.
  std::optional<double> range;

  // Of RRT-Connect:
  /// Of the tree that draws the sample; the other one always connects.
  Extension extension = Extension::kConnect;
  /// Grow the smaller tree (as Kuffner and LaValle's "balanced" variant); else they take turns.
  bool balance = true;
  /// Dynamic domain (Yershova, Jaillet, Simeon and LaValle, ICRA 2005): a node that failed to
  /// extend takes samples within this distance only, which shrinks with further failures and grows
  /// with successes (Jaillet, Yershova, LaValle and Simeon, IROS 2005), but not below the range.
  /// 0: off.
  double domain_radius = 0;
  /// `experience`: file of paths that were found before (PathLibrary), absolute or from the robot
  /// folder; empty: none.
  std::string experience;
  /// Of it, how many are followed at most before the trees grow.
  int recall = 1;

  // Of OMPL's planners:
  Metric metric = Metric::kL2;
  /// Edges are sampled so that neighbours are at most this part of the space's extent apart in the
  /// metric, whatever edge resolution a request names; certified edges are refused. None: as the
  /// request says.
  std::optional<double> longest_valid_segment_fraction;
  std::string segment_fraction_origin;  ///< "file:line: key" of that.
  /// `ompl`: a map of parameters of OMPL's planner, by OMPL's names.
  std::map<std::string, std::string> ompl_parameters;

  std::string_view AlgorithmName() const;
  /// The algorithm's name and what makes it this variant: "RRT-Connect (canonical)" extends by one
  /// step and alternates, as Kuffner and LaValle's first; "(balanced)" connects from both trees and
  /// grows the smaller one; OMPL's have "(OMPL)", and what of it is not as in OMPL.
  std::string VariantName() const;
};

/// The range of RRT-Connect after so many iterations: from 2 down to 0.6, the way halved every 50
/// iterations. Long motions are soon through where there is room; a search that goes on needs short
/// ones. docs/rrtc.md has the measurements.
double ShrinkingRange(std::int64_t iterations);

/// Reads settings; keys that are missing keep their values in `defaults`. Throws InputError for
/// unknown keys and algorithms (naming the known ones), bad values or none, and settings that the
/// algorithm has no use for, but `range`.
RrtcSettings ReadRrtcSettings(const YamlNode& node, const RrtcSettings& defaults);

/// The settings that are in effect, as text.
std::map<std::string, std::string> DescribeSettings(const RrtcSettings& settings);

/// The planner's own and the request's over them. Throws InputError as ReadRrtcSettings does, and
/// for `algorithm` and `ompl`, which a request cannot change.
RrtcSettings SettingsOfRequest(const RrtcSettings& settings,
                               const std::map<std::string, std::string>& parameters);

}  // namespace planbench
