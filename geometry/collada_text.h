#pragma once

#include <string>

namespace planbench {

/// Refuses, by an InputError that names `file` and the line, what assimp has no message for in the
/// text of a COLLADA file, or takes for something else: units that are none, <skew> and <lookat>,
/// turns about axes that are not of unit length, arrays and lists of corners of another number than
/// they say, fans of triangles, hulls, skinned meshes, instances of what is not in the file, and of
/// what is within itself. Comments do not count.
void CheckCollada(std::string text, const std::string& file);

}  // namespace planbench
