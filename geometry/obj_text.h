#pragma once

#include <string>
#include <string_view>

#include "geometry/polygons.h"

namespace planbench {

/// What a Wavefront OBJ file tells of surfaces. Readers stumble over much of what is written in the
/// field: numbers such as .5, comments behind them, indented lines. Throws InputError naming `file`
/// and the line for vertices and faces that cannot be read.
Polygons ReadObj(std::string_view text, const std::string& file);

}  // namespace planbench
