#pragma once

#include <string>
#include <vector>

#include "geometry/mesh_loader.h"
#include "robot_model/robot_model.h"
#include "sphere_fitting/link_body.h"

namespace planbench {

/// A robot's links that have collision geometry.
struct LinkBodies {
  std::vector<int> links;  ///< Link indices, ascending.
  std::vector<LinkBody> bodies;
  /// What is odd about their meshes, one line each: not closed, turned inside out, parts that
  /// disagree about where their outside is, triangles without area, sizes that no link has. Of
  /// other shapes such sizes.
  std::vector<std::string> remarks;
};

/// Reads all collision geometry of a robot, meshes included. Throws InputError for files that
/// cannot be found or read.
LinkBodies ReadLinkBodies(const RobotModel& model, const ResourceResolver& resources);

/// The sets, one for each of the links, as one sphere model.
std::vector<LinkSphere> ToLinkSpheres(const LinkBodies& links,
                                      const std::vector<std::vector<Ball>>& sets);

}  // namespace planbench
