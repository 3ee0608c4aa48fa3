#pragma once

#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// The collision geometry of a link as its URDF has it, in the link's frame, meshes loaded.
struct LinkGeometry {
  int link;
  std::vector<PlacedShape> shapes;
};

/// That of every link that has any, in link order. Throws InputError for a mesh that cannot be
/// read.
std::vector<LinkGeometry> LoadLinkGeometry(const Robot& robot);

/// Throws InputError unless it is what the model `meshes` needs: if there is none, or a shape that
/// is not solid.
void RequireSolid(const Robot& robot, const std::vector<LinkGeometry>& links);

/// What is odd about the sizes of it (OddSize), a line each: what else reads the meshes says
/// nothing of it.
std::vector<std::string> OddSizes(const Robot& robot, const std::vector<LinkGeometry>& links);

/// Balls that cover it, as bounds on its motion take them: vertices, bounding spheres.
std::vector<LinkSphere> CoverOf(const std::vector<LinkGeometry>& links);

}  // namespace planbench
