#pragma once

#include <string>
#include <string_view>

#include "geometry/polygons.h"

namespace planbench {

/// The polygons of a PLY file (ASCII, or binary of either byte order). Triangle strips (element
/// `tristrips`, where -1 begins another) become triangles. Throws InputError naming `file`, and the
/// line or the element, for files that are cut off (or may be: the last line needs no end where no
/// longer number could stand there), or hold more than their header tells, corners that are no
/// vertex, and vertices that are not finite.
Polygons ReadPly(std::string_view data, const std::string& file);

}  // namespace planbench
