#include "results/entrants.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <sstream>

namespace planbench {

AskedDirections ParseEntrants(std::string_view text) {
  AskedDirections asked;
  std::istringstream stream{std::string(text)};
  for (std::string entrant; stream >> entrant;) {
    const std::size_t equals = entrant.rfind('=');
    if (equals == std::string::npos) continue;
    const auto directions = ParseEnum<Directions>(entrant.substr(equals + 1));
    if (directions) asked.emplace(entrant.substr(0, equals), *directions);
  }
  return asked;
}

bool IsAsked(const AskedDirections& asked, std::string_view planner, Directions directions) {
  const auto [begin, end] = asked.equal_range(planner);
  return std::any_of(begin, end, [&](const auto& one) { return one.second == directions; });
}

}  // namespace planbench
