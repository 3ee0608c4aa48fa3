#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/segment.h"
#include "geometry/shapes.h"

namespace planbench {

/// A triangle whose corners are in a row as what it is: its longest edge, from which nothing of it
/// is further than 1e-6 of its length; a point if all are in one place. Nothing of others.
std::optional<Segment> AsLine(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                              const Eigen::Vector3d& c);

/// The triangles of a mesh that say what it encloses: those that have an area, and slivers (AsLine)
/// in the place of those that are there. These, of which those that share edges are in a row, tell
/// what edges are on one line; each such edge gets a sliver to one corner on it for all of a part.
/// So what any slivers there can close is closed, by those that its orientation needs, and nothing
/// is opened. A sliver that is in no row with its neighbours, as in the walls of a film, is there
/// as it stands and closes what it does, unless one of its edges is its alone (others left out
/// likewise do not count) and on no line: no surface with it is closed. Vertices must be joined.
std::vector<std::array<std::uint32_t, 3>> SurfaceTriangles(const TriangleMesh& mesh);

}  // namespace planbench
