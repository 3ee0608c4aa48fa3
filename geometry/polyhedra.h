#pragma once

#include "geometry/shapes.h"

namespace planbench {

/// The closed surface of a box centred at the origin; edge lengths in m, normals outwards.
TriangleMesh BoxMesh(const Eigen::Vector3d& size);

/// The closed surface of an upright prism about the z axis, centred at the origin, whose base has
/// its `sides` corners `radius` from the axis; lengths in m, normals outwards.
TriangleMesh PrismMesh(double radius, double length, int sides);

}  // namespace planbench
