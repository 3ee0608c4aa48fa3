#include "planning/plan_status.h"

#include <array>
#include <cstddef>

namespace planbench {
namespace {

constexpr std::array<std::string_view, kNumPlanStatuses> kStatusNames = {
    "SOLVED",          "TIMED_OUT", "EXHAUSTED", "START_INVALID", "GOAL_INVALID",
    "INVALID_REQUEST", "CANCELLED", "NO_ANSWER", "INVALID_PATH",  "MEMORY_LIMIT"};
constexpr std::array<std::string_view, 2> kDirectionNames = {"forward", "backward"};

}  // namespace

std::string_view PlanStatusName(PlanStatus status) {
  return kStatusNames.at(static_cast<std::size_t>(status));
}

std::optional<PlanStatus> ParsePlanStatus(std::string_view name) {
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (kStatusNames[i] == name) return static_cast<PlanStatus>(i);
  }
  return std::nullopt;
}

std::string_view DirectionName(Direction direction) {
  return kDirectionNames.at(static_cast<std::size_t>(direction));
}

std::optional<Direction> ParseDirection(std::string_view name) {
  for (std::size_t i = 0; i < kDirectionNames.size(); ++i) {
    if (kDirectionNames[i] == name) return static_cast<Direction>(i);
  }
  return std::nullopt;
}

}  // namespace planbench
