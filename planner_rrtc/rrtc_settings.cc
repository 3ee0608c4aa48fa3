#include "planner_rrtc/rrtc_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "planner_rrtc/ompl_algorithms.h"

namespace planbench {
namespace {

const OmplAlgorithm* ReadAlgorithm(const YamlNode& node) {
  const std::string name = node.String();
  if (name == RrtcSettings::kRrtConnect) return nullptr;
  const OmplAlgorithm* algorithm = FindOmplAlgorithm(name);
  if (algorithm == nullptr) {
    std::vector<std::string_view> known = {RrtcSettings::kRrtConnect};
    for (const OmplAlgorithm& a : OmplAlgorithms()) known.push_back(a.name);
    node.Fail(fmt::format("unknown algorithm '{}'; known are {}", name, fmt::join(known, ", ")));
  }
  return algorithm;
}

double ReadDomainRadius(const YamlNode& node) {
  const double radius = node.Double();
  if (radius < 0) node.Fail(fmt::format("must not be negative, found {}", radius));
  return radius;
}

}  // namespace

std::string_view RrtcSettings::AlgorithmName() const {
  return ompl_algorithm != nullptr ? ompl_algorithm->name : kRrtConnect;
}

std::string RrtcSettings::VariantName() const {
  if (ompl_algorithm != nullptr) return fmt::format("{} (OMPL)", AlgorithmName());
  const std::string_view trees = balance ? "balanced" : "alternating";
  const bool connect = extension == Extension::kConnect;
  std::string variant(connect == balance ? (balance ? "balanced" : "canonical")
                                         : fmt::format("{}, {}", EnumName(extension), trees));
  if (domain_radius > 0) variant += ", dynamic domain";
  return fmt::format("{} ({})", AlgorithmName(), variant);
}

RrtcSettings ReadRrtcSettings(const YamlNode& node, const RrtcSettings& defaults) {
  node.AllowOnly(
      {"algorithm", "sampler", "range", "extension", "balance", "domain_radius", "ompl"});
  RrtcSettings settings = defaults;
  if (const auto value = node.Find("algorithm")) settings.ompl_algorithm = ReadAlgorithm(*value);
  if (const auto value = node.Find("sampler")) settings.sampler = value->Enum<SamplerKind>();
  if (const auto value = node.Find("range")) settings.range = value->PositiveDouble();
  if (const auto value = node.Find("extension")) settings.extension = value->Enum<Extension>();
  if (const auto value = node.Find("balance")) settings.balance = value->Bool();
  if (const auto value = node.Find("domain_radius")) {
    settings.domain_radius = ReadDomainRadius(*value);
  }
  if (const auto value = node.Find("ompl")) {
    for (const std::string& key : value->Keys()) {
      settings.ompl_parameters[key] = value->At(key).String();
    }
  }
  return settings;
}

std::map<std::string, std::string> DescribeSettings(const RrtcSettings& settings) {
  std::map<std::string, std::string> text = {{"algorithm", std::string(settings.AlgorithmName())},
                                             {"sampler", std::string(EnumName(settings.sampler))},
                                             {"range", fmt::format("{}", settings.range)}};
  if (settings.ompl_algorithm != nullptr) {
    for (const auto& [key, value] : settings.ompl_parameters) text["ompl." + key] = value;
    return text;
  }
  text["extension"] = EnumName(settings.extension);
  text["balance"] = settings.balance ? "true" : "false";
  text["domain_radius"] = fmt::format("{}", settings.domain_radius);
  return text;
}

RrtcSettings SettingsOfRequest(const RrtcSettings& settings,
                               const std::map<std::string, std::string>& parameters) {
  if (parameters.empty()) return settings;
  YamlNode request = YamlNode::Parse("{}", "request parameters");
  for (const auto& [key, text] : parameters) {
    request.Override(key, text, "request parameter " + key);
  }
  request.AllowOnly({"sampler", "range", "extension", "balance", "domain_radius"});
  // A parameter without a value is a mistake, not a wish for the default.
  for (const auto& [key, text] : parameters) request.At(key).String();
  return ReadRrtcSettings(request, settings);
}

}  // namespace planbench
