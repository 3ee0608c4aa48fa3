#pragma once

#include <string>
#include <string_view>

namespace planbench {

/// What a Wavefront OBJ file tells of surfaces, as plain as every reader understands it: vertices
/// (v), then polygons (f) of their numbers, counted from 1; "" if there is no polygon. Readers
/// stumble over much of what is written in the field: numbers such as .5, comments behind them,
/// indented lines. Throws InputError naming `file` and the line for vertices and faces that cannot
/// be read.
std::string PlainObj(std::string_view text, const std::string& file);

}  // namespace planbench
