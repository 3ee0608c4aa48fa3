#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/shapes.h"
#include "report/table.h"

namespace planbench {

/// To 0.01 mm, or 1e-5 of a quaternion.
double RoundedPosition(double value);
/// [x, y, z]
Json PointJson(const Eigen::Vector3d& p);
/// [x, y, z, qx, qy, qz, qw]
Json PoseJson(const Eigen::Isometry3d& X);
/// The same, behind what is in a list.
void AppendPose(const Eigen::Isometry3d& X, Json* list);

/// {type, ...}. A mesh is named alone, {type: "mesh", mesh: id}; `meshes` then has by this id, a
/// text of its content:
///   {low: [x, y, z], size: [x, y, z] of the box around it, m,
///    vertices: base64 of unsigned 16-bit numbers, three a vertex, from 0 at the low side of the
///      box to 65535 at the other,
///    triangles: base64 of numbers of vertices, three a triangle: of 16 bits, or of 32 bits if
///      there are more than 65536 vertices; all little-endian}
/// What is no mesh (SharedMesh::fault) has no triangles there.
Json ShapeJson(const Shape& shape, Json* meshes);

}  // namespace planbench
