#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "common/enum_names.h"

namespace planbench {

/// In which directions a contestant is asked to search.
enum class Directions {
  kAuto,  ///< Forward; then backward if that failed, unless it searches from both ends at once.
  kForward,
  kBackward,
  kBoth,
};
template <>
struct EnumNames<Directions> {
  static constexpr auto kNames =
      std::to_array<std::string_view>({"auto", "forward", "backward", "both"});
};

/// Among a session's flags: the planners that were asked, and in which directions: "ara=auto
/// rrtc=forward". Whose backward search is not asked for stands as forward, not as auto.
inline constexpr char kEntrants[] = "entrants";

/// By planner. One that was asked in several ways, as in a session that was merged of parts, has
/// several.
using AskedDirections = std::multimap<std::string, Directions, std::less<>>;

/// That text's; what is none of ours is left out.
AskedDirections ParseEntrants(std::string_view text);

/// Whether the planner was asked in these directions.
bool IsAsked(const AskedDirections& asked, std::string_view planner, Directions directions);

}  // namespace planbench
