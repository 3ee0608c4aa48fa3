#include "planner_trajopt/trajopt_settings.h"

#include <fmt/format.h>

#include <initializer_list>

namespace planbench {
namespace {

constexpr int kMostWaypoints = 1000;
constexpr int kMany = 1'000'000;

// Products and squares of these are numbers still, in single precision, too.
constexpr double kLeastPositive = 1e-6;
constexpr double kMostOfAll = 1e6;

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
  node.RequireValues();
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
    if (const auto value = node.Find(key)) *setting = value->IntWithin(least, most);
  };
  const auto number = [&node](const char* key, double least, double* setting) {
    if (const auto value = node.Find(key)) *setting = value->DoubleWithin(least, kMostOfAll);
  };
  count("waypoints", 1, kMostWaypoints, &settings.waypoints);
  count("iterations", 1, kMany, &settings.iterations);
  count("patience", 1, kMany, &settings.patience);
  count("rollouts", 2, kMostWaypoints, &settings.rollouts);
  if (const auto value = node.Find("guesses")) {
    settings.guesses.reset();
    if (value->String() != "unlimited") settings.guesses = value->IntWithin(1, kMany);
  }
  number("clearance", kLeastPositive, &settings.clearance);
  number("noise", kLeastPositive, &settings.noise);
  number("gain", kLeastPositive, &settings.gain);
  number("step", kLeastPositive, &settings.step);
  number("gradient_step", kLeastPositive, &settings.gradient_step);
  number("smoothness", 0, &settings.smoothness);
  number("given_smoothness", 0, &settings.given_smoothness);
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
  return ReadTrajoptSettings(request, settings);
}

}  // namespace planbench
