#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace planbench {

/// URDF text in the words of version 1.0.
struct Urdf10 {
  std::string text;
  /// Per link which of its <collision>, from 0, are capsules. In the text they are cylinders.
  std::map<std::string, std::set<int>> capsules;
};

/// Says in URDF 1.0, all that urdfdom reads before its version 5.1, what 1.1 brought (quat_xyzw of
/// an <origin>, capsules), whichever version the text claims. What 1.2 brought (limits of
/// acceleration) has no say here. Refuses (InputError with file and line) other versions, and
/// orientations that are none or two. `origin` names the text.
Urdf10 ToUrdf10(std::string_view text, const std::string& origin);

}  // namespace planbench
