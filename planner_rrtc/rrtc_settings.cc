#include "planner_rrtc/rrtc_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "planner_rrtc/ompl_algorithms.h"
#include "planning/experience.h"
#include "planning/told_edges.h"

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

std::optional<double> ReadRange(const YamlNode& node) {
  if (node.IsScalar() && node.String() == "default") return std::nullopt;
  return node.PositiveDouble();
}

}  // namespace

std::string_view RrtcSettings::AlgorithmName() const {
  return ompl_algorithm != nullptr ? ompl_algorithm->name : kRrtConnect;
}

std::string RrtcSettings::VariantName() const {
  if (ompl_algorithm != nullptr) {
    const std::string_view variant = ompl_algorithm->variant;
    return fmt::format("{} (OMPL{}{})", AlgorithmName(), variant.empty() ? "" : ", ", variant);
  }
  std::string variant =
      fmt::format("{}, {}", EnumName(extension), balance ? "balanced" : "alternating");
  const bool connect = extension == Extension::kConnect;
  if (connect && balance) variant = "balanced";
  if (!connect && !balance && range) variant = "canonical";
  if (domain_radius > 0) variant += ", dynamic domain";
  if (!experience.empty()) variant += ", experience";
  return fmt::format("{} ({})", AlgorithmName(), variant);
}

double ShrinkingRange(std::int64_t iterations) {
  constexpr double kFirst = 2;
  constexpr double kLast = 0.6;
  constexpr double kHalfLife = 50;
  return kLast + (kFirst - kLast) * std::exp2(-static_cast<double>(iterations) / kHalfLife);
}

RrtcSettings ReadRrtcSettings(const YamlNode& node, const RrtcSettings& defaults) {
  node.AllowOnly({"algorithm", "sampler", "range", "extension", "balance", "domain_radius",
                  "experience", "recall", "metric", kSegmentFraction, "ompl"});
  node.RequireValues();
  RrtcSettings settings = defaults;
  if (const auto value = node.Find("algorithm")) settings.ompl_algorithm = ReadAlgorithm(*value);
  const bool is_ompl = settings.ompl_algorithm != nullptr;
  if (const auto value = node.Find("sampler")) {
    settings.sampler = value->Enum<SamplerKind>();
    if (is_ompl && settings.ompl_algorithm->draws_near) {
      value->Fail(fmt::format("is of samples from the whole space, and {} draws near others alone",
                              settings.AlgorithmName()));
    }
  }
  for (const char* key : {"extension", "balance", "domain_radius", "experience", "recall"}) {
    const auto value = node.Find(key);
    if (value && is_ompl) value->Fail("is for RRT-Connect only, not for OMPL's planners");
  }
  if (const auto value = node.Find("range")) settings.range = ReadRange(*value);
  if (const auto value = node.Find("extension")) settings.extension = value->Enum<Extension>();
  if (const auto value = node.Find("balance")) settings.balance = value->Bool();
  if (const auto value = node.Find("domain_radius")) {
    settings.domain_radius = value->NonNegativeDouble();
  }
  if (const auto value = node.Find("experience")) settings.experience = value->String();
  if (const auto value = node.Find("recall")) {
    settings.recall = ReadRecall(*value, settings.experience);
  }
  for (const char* key : {"metric", kSegmentFraction, "ompl"}) {
    const auto value = node.Find(key);
    if (value && !is_ompl) value->Fail("is for OMPL's planners only, not for RRT-Connect");
  }
  if (const auto value = node.Find("metric")) settings.metric = value->Enum<Metric>();
  if (const auto value = node.Find(kSegmentFraction)) {
    settings.longest_valid_segment_fraction = value->DoubleWithin(1e-6, 1);
    settings.segment_fraction_origin = value->Where();
  }
  if (const auto value = node.Find("ompl")) {
    for (const std::string& key : value->Keys()) {
      settings.ompl_parameters[key] = value->At(key).String();
    }
  }
  return settings;
}

std::map<std::string, std::string> DescribeSettings(const RrtcSettings& settings) {
  std::map<std::string, std::string> text = {
      {"algorithm", std::string(settings.AlgorithmName())},
      {"range", settings.range ? fmt::format("{}", *settings.range) : "default"}};
  const OmplAlgorithm* ompl_algorithm = settings.ompl_algorithm;
  if (ompl_algorithm == nullptr || !ompl_algorithm->draws_near) {
    text["sampler"] = EnumName(settings.sampler);
  }
  if (ompl_algorithm != nullptr) {
    text["metric"] = EnumName(settings.metric);
    if (const auto fraction = settings.longest_valid_segment_fraction) {
      text[kSegmentFraction] = fmt::format("{}", *fraction);
    }
    for (const auto& [key, value] : settings.ompl_parameters) text["ompl." + key] = value;
    return text;
  }
  text["extension"] = EnumName(settings.extension);
  text["balance"] = settings.balance ? "true" : "false";
  text["domain_radius"] = fmt::format("{}", settings.domain_radius);
  if (!settings.experience.empty()) {
    text["experience"] = settings.experience;
    text["recall"] = fmt::format("{}", settings.recall);
  }
  return text;
}

RrtcSettings SettingsOfRequest(const RrtcSettings& settings,
                               const std::map<std::string, std::string>& parameters) {
  if (parameters.empty()) return settings;
  YamlNode request = YamlNode::Parse("{}", "request parameters");
  for (const auto& [key, text] : parameters) {
    request.Override(key, text, "request parameter " + key);
  }
  request.AllowOnly({"sampler", "range", "extension", "balance", "domain_radius", "recall"});
  return ReadRrtcSettings(request, settings);
}

}  // namespace planbench
