#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "collision/link_geometry.h"
#include "collision/simd/ball_tree.h"
#include "collision/simd/mesh_tree.h"
#include "geometry/solid_mesh.h"

namespace planbench {

/// The collision geometry of a link as the vectorised engine takes it, in the link's frame: spheres
/// stay what they are, all else is triangles, cylinders as prisms of so many sides that nothing of
/// them is further than 0.02 mm outside of the cylinder. The triangles stand under balls about
/// given middles, those of a sphere model of the link: balls about its surface reach further beyond
/// it.
struct LinkMeshes {
  int link;
  BallTree tree;  ///< Its leaves are spheres, and balls around clusters of triangles.
  /// Those of its meshes that have an inside, with all of their vertices.
  struct Closed {
    std::shared_ptr<const SolidMesh> mesh;
    std::vector<Eigen::Vector3d> vertices;
  };
  std::vector<Closed> closed;
  std::vector<Eigen::Vector3d> points;  ///< One of every connected part.
};

struct RobotMeshes {
  /// `middles`: spheres of the links. Balls are made about their centres, and enclose triangles
  /// whatever their radii are.
  RobotMeshes(const std::vector<LinkGeometry>& geometry, const std::vector<LinkSphere>& middles);

  std::vector<LinkMeshes> links;
  struct Cluster {
    int link;
    std::vector<Corners> triangles;  ///< Up to kWide, in the link's frame.
  };
  std::vector<Cluster> clusters;
};

}  // namespace planbench
