#pragma once

#include <optional>
#include <string>

#include "geometry/shapes.h"

namespace planbench {

/// No link is larger, m, and no joint further from the next.
inline constexpr double kGreatestExtent = 20;

/// What to check of a shape of a link, its mesh loaded, if no link is of that size: of a mesh its
/// unit, where it is larger than that or smaller than a millimetre; nothing if all is well.
std::optional<std::string> OddSize(const std::string& link, const Shape& shape);

}  // namespace planbench
