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

/// The triangles of a mesh that say what it encloses. Left out are those with two corners in one
/// place, and slivers (AsLine) that open what is closed without them: one after the other those
/// that have an edge of an odd number of triangles which no other sliver has, then those that have
/// three such edges, or two, with others. Slivers that close a part stay. Vertices must be joined.
std::vector<std::array<std::uint32_t, 3>> SurfaceTriangles(const TriangleMesh& mesh);

}  // namespace planbench
