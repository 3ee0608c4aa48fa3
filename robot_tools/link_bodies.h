#pragma once

#include <string>
#include <vector>

#include "geometry/mesh_loader.h"
#include "robot_model/robot_model.h"
#include "robot_tools/say_line.h"
#include "sphere_fitting/link_body.h"

namespace planbench {

/// A robot's links that have collision geometry.
struct LinkBodies {
  std::vector<int> links;  ///< Link indices, ascending.
  std::vector<LinkBody> bodies;
};

/// The collision geometry of each link of a robot, meshes loaded. Sizes that no link has are told.
/// Throws InputError for files that cannot be found or read.
std::vector<std::vector<PlacedShape>> LoadLinkShapes(const RobotModel& model,
                                                     const ResourceResolver& resources,
                                                     const SayLine& say);

/// Tells the same of a robot that can do without its meshes: those that cannot be read are told
/// too, those that cannot be found are left out.
void RemarkSizes(const RobotModel& model, const ResourceResolver& resources, const SayLine& say);

/// Bodies of the geometry that LoadLinkShapes loads. After its sizes also the rest that is odd
/// about meshes is told: those that are not closed or turned inside out, parts that disagree about
/// where their outside is, triangles without area. Throws InputError as LoadLinkShapes does.
LinkBodies ReadLinkBodies(const RobotModel& model, const ResourceResolver& resources,
                          const SayLine& say);

/// The links that the text of a URDF draws (<visual>) and gives no <collision>, in its order.
std::vector<std::string> LinksDrawnOnly(const std::string& urdf_text);

/// The sets, one for each of the links, as one sphere model.
std::vector<LinkSphere> ToLinkSpheres(const LinkBodies& links,
                                      const std::vector<std::vector<Ball>>& sets);

}  // namespace planbench
