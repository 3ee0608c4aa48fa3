#include "planner_trajopt/trajopt_settings.h"

#include <fmt/format.h>

#include <initializer_list>

namespace planbench {
namespace {

constexpr int kMostWaypoints = 1000;
constexpr int kMany = 1'000'000;

int ReadCount(const YamlNode& node, int least, int most) {
  const long long count = node.Int();
  if (count < least || count > most) {
    node.Fail(fmt::format("must be from {} to {}, found {}", least, most, count));
  }
  return static_cast<int>(count);
}

}  // namespace

std::string TrajoptSettings::VariantName() const {
  const std::string_view name = EnumName(algorithm);
  if (!guesses) return fmt::format("{} (restarted)", name);
  return *guesses == 1 ? fmt::format("{} (straight guess)", name)
                       : fmt::format("{} ({} guesses)", name, *guesses);
}

TrajoptSettings ReadTrajoptSettings(const YamlNode& node, const TrajoptSettings& defaults) {
  node.AllowOnly({"algorithm", "waypoints", "clearance", "smoothness", "given_smoothness",
                  "iterations", "patience", "guesses", "rollouts", "noise", "gain", "step",
                  "gradient_step"});
  TrajoptSettings settings = defaults;
  if (const auto value = node.Find("algorithm")) {
    settings.algorithm = value->Enum<TrajoptAlgorithm>();
  }
  const bool is_stomp = settings.algorithm == TrajoptAlgorithm::kStomp;
  const auto refuse = [&node](std::initializer_list<const char*> keys, std::string_view owner) {
    for (const char* key : keys) {
      if (const auto value = node.Find(key)) value->Fail(fmt::format("is for {} only", owner));
    }
  };
  if (is_stomp) {
    refuse({"step", "gradient_step"}, "CHOMP");
  } else {
    refuse({"rollouts", "noise", "gain"}, "STOMP");
  }
  const auto count = [&node](const char* key, int least, int most, int* setting) {
    if (const auto value = node.Find(key)) *setting = ReadCount(*value, least, most);
  };
  const auto positive = [&node](const char* key, double* setting) {
    if (const auto value = node.Find(key)) *setting = value->PositiveDouble();
  };
  count("waypoints", 1, kMostWaypoints, &settings.waypoints);
  count("iterations", 1, kMany, &settings.iterations);
  count("patience", 1, kMany, &settings.patience);
  count("rollouts", 2, kMostWaypoints, &settings.rollouts);
  if (const auto value = node.Find("guesses")) {
    settings.guesses.reset();
    if (value->String() != "unlimited") settings.guesses = ReadCount(*value, 1, kMany);
  }
  positive("clearance", &settings.clearance);
  positive("noise", &settings.noise);
  positive("gain", &settings.gain);
  positive("step", &settings.step);
  positive("gradient_step", &settings.gradient_step);
  const auto not_negative = [&node](const char* key, double* setting) {
    const auto value = node.Find(key);
    if (value && (*setting = value->Double()) < 0) value->Fail("must not be negative");
  };
  not_negative("smoothness", &settings.smoothness);
  not_negative("given_smoothness", &settings.given_smoothness);
  return settings;
}

std::map<std::string, std::string> DescribeSettings(const TrajoptSettings& settings) {
  std::map<std::string, std::string> text = {
      {"algorithm", std::string(EnumName(settings.algorithm))},
      {"waypoints", fmt::format("{}", settings.waypoints)},
      {"clearance", fmt::format("{}", settings.clearance)},
      {"smoothness", fmt::format("{}", settings.smoothness)},
      {"given_smoothness", fmt::format("{}", settings.given_smoothness)},
      {"iterations", fmt::format("{}", settings.iterations)},
      {"patience", fmt::format("{}", settings.patience)},
      {"guesses", settings.guesses ? fmt::format("{}", *settings.guesses) : "unlimited"}};
  if (settings.algorithm == TrajoptAlgorithm::kStomp) {
    text["rollouts"] = fmt::format("{}", settings.rollouts);
    text["noise"] = fmt::format("{}", settings.noise);
    text["gain"] = fmt::format("{}", settings.gain);
  } else {
    text["step"] = fmt::format("{}", settings.step);
    text["gradient_step"] = fmt::format("{}", settings.gradient_step);
  }
  return text;
}

TrajoptSettings SettingsOfRequest(const TrajoptSettings& settings,
                                  const std::map<std::string, std::string>& parameters) {
  if (parameters.empty()) return settings;
  YamlNode request = YamlNode::Parse("{}", "request parameters");
  for (const auto& [key, text] : parameters) {
    request.Override(key, text, "request parameter " + key);
  }
  request.AllowOnly({"waypoints", "clearance", "smoothness", "given_smoothness", "iterations",
                     "patience", "rollouts", "noise", "gain", "step", "gradient_step"});
  // A parameter without a value is a mistake, not a wish for the default.
  for (const std::string& key : request.Keys()) request.At(key).String();
  return ReadTrajoptSettings(request, settings);
}

}  // namespace planbench
