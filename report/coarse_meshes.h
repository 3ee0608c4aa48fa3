#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/shapes.h"

namespace planbench {

/// Of a robot or a scene, each mesh as often as it is drawn: what browsers draw, a dozen copies of
/// the robot at a time, without being slow.
inline constexpr std::size_t kMostTrianglesShown = 200'000;

/// If the meshes of these bodies together have more than `most_triangles`, joins vertices, the
/// nearest ones first, until they have not, and adds a sentence about it to `remarks` ("The robot's
/// meshes are ..." if `whose` is "robot"). A mesh is left as fine as it takes to know it again.
void Coarsen(std::string_view whose, std::size_t most_triangles,
             const std::vector<std::vector<PlacedShape>*>& bodies,
             std::vector<std::string>* remarks);

}  // namespace planbench
