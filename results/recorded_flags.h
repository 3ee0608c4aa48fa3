#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace planbench {

/// The driver's flags as a session records them: by name, one text each. Flags that take several
/// values, each after its own --FLAG, have them with commas between; in a value a comma and a
/// backslash stand behind a backslash.
bool TakesSeveralValues(std::string_view flag);
std::string JoinFlagValues(const std::vector<std::string>& values);

/// The values that were recorded of such a flag. Sessions of earlier versions did not mark commas:
/// of those, a value with commas is read as several.
std::vector<std::string> SplitFlagValues(std::string_view recorded);

}  // namespace planbench
