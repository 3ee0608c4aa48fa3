#include "planning/told_edges.h"

#include <fmt/format.h>

namespace planbench {

ToldSampling SamplingOf(std::optional<EdgeCheck> method, std::optional<double> resolution_m,
                        const std::map<std::string, std::string>& settings) {
  if (method == EdgeCheck::kCertified) return {resolution_m, ""};
  if (const auto fraction = settings.find(kSegmentFraction); fraction != settings.end()) {
    return {std::nullopt, fmt::format("{} {}", kSegmentFraction, fraction->second)};
  }
  return {resolution_m, settings.contains(kEdgeWeights) ? kEdgeWeights : ""};
}

std::string DescribeEdges(std::optional<EdgeCheck> method, std::optional<double> resolution_m,
                          const std::map<std::string, std::string>& settings) {
  std::string text = method ? std::string(EnumName(*method)) : "as the robot says";
  if (method == EdgeCheck::kCertified) return text;
  const ToldSampling sampling = SamplingOf(method, resolution_m, settings);
  if (method && sampling.resolution_m) text += fmt::format(" at {} m", *sampling.resolution_m);
  if (!sampling.own.empty()) text += ", own sampling: " + sampling.own;
  return text;
}

}  // namespace planbench
