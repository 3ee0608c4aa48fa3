#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "collision/link_geometry.h"
#include "collision/simd/ball_tree.h"
#include "collision/simd/mesh_tree.h"
#include "geometry/mesh_surface.h"
#include "geometry/solid_mesh.h"

namespace planbench {

/// The collision geometry of a link, or of an object attached to it, as the vectorised engine takes
/// it, in the link's frame: spheres stay what they are, all else is triangles, cylinders as prisms
/// of so many sides (4096 at most, for a radius of 65 m) that nothing of them is further than 0.02
/// mm outside of the cylinder. The triangles stand under balls about given middles, those of a
/// sphere model of the link: balls about its surface reach further beyond it.
struct LinkMeshes {
  int link;
  BallTree tree;  ///< Its leaves are spheres, and balls around patches.
  /// Those of its meshes that have an inside, with all of their vertices.
  struct Closed {
    std::shared_ptr<const SolidMesh> mesh;
    std::vector<Eigen::Vector3d> vertices;
  };
  std::vector<Closed> closed;
  std::vector<Eigen::Vector3d> points;  ///< One of every connected part.
  MeshSurface surface;                  ///< Of the triangles.
};

struct RobotMeshes {
  /// `middles`: spheres of the links. Balls are made about their centres, and enclose triangles
  /// whatever their radii are.
  RobotMeshes(const std::vector<LinkGeometry>& geometry, const std::vector<LinkSphere>& middles);
  /// Of one link alone.
  RobotMeshes(const LinkGeometry& geometry, const std::vector<Ball>& middles);

  std::vector<LinkMeshes> links;
  /// Neighbouring triangles of a patch.
  struct Group {
    std::vector<Corners> triangles;        ///< Up to kWide, in the link's frame.
    std::vector<Eigen::Vector3d> corners;  ///< Around what of them belongs to the patch.
    Hull hull;                             ///< Of these.
  };
  /// What of a link's triangles is in one ball. What they have outside of it others have.
  struct Patch {
    int link;
    std::vector<Group> groups;  ///< Up to kWide.
    /// Of connected parts that this patch answers for, a corner each.
    std::vector<Eigen::Vector3d> points;
  };
  std::vector<Patch> patches;

 private:
  void Add(const LinkGeometry& link, const std::vector<Ball>& middles);
};

}  // namespace planbench
