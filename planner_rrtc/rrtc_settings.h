#pragma once

#include <map>
#include <string>

#include "common/yaml.h"
#include "planner_rrtc/joint_sampler.h"
#include "planner_rrtc/ompl_algorithms.h"
#include "planner_rrtc/rrt_connect.h"

namespace planbench {

/// Settings of planner_rrtc.
struct RrtcSettings {
  /// Name of our own planner among the algorithms.
  static constexpr std::string_view kRrtConnect = "RRT-Connect";

  /// `algorithm`: RRT-Connect (RrtConnect), or the name of a planner of OMPL; null: RRT-Connect.
  const OmplAlgorithm* ompl_algorithm = nullptr;
  /// `sampler`: uniform or halton.
  SamplerKind sampler = SamplerKind::kUniform;
  /// `range`, `extension` (connect or step), `balance`, `domain_radius`. The range holds for every
  /// algorithm that grows trees by motions of a limited length, the others for RRT-Connect.
  RrtConnect::Settings rrt_connect;
  /// `ompl`: a map of parameters of OMPL's planner, by OMPL's names.
  std::map<std::string, std::string> ompl_parameters;

  std::string_view AlgorithmName() const {
    return ompl_algorithm != nullptr ? ompl_algorithm->name : kRrtConnect;
  }
};

/// Reads settings; keys that are missing keep their values in `defaults`. Throws InputError for
/// unknown keys, algorithms (naming the known ones), and bad values.
RrtcSettings ReadRrtcSettings(const YamlNode& node, const RrtcSettings& defaults);

/// The settings that are in effect, as text.
std::map<std::string, std::string> DescribeSettings(const RrtcSettings& settings);

/// The planner's own and the request's over them. Throws InputError as ReadRrtcSettings does, and
/// for `algorithm` and `ompl`, which a request cannot change.
RrtcSettings SettingsOfRequest(const RrtcSettings& settings,
                               const std::map<std::string, std::string>& parameters);

}  // namespace planbench
