#pragma once

#include <string>

#include "geometry/shapes.h"

namespace planbench {

/// Throws InputError naming `owner` if the shape has a negative or non-finite size, or is a mesh
/// without triangles, with a vertex that is not finite, or with a triangle of vertices it does not
/// have.
void RequireSolid(const Shape& shape, const std::string& owner);

}  // namespace planbench
