#include "report/shown_robot.h"

#include <utility>
#include <vector>

#include "collision/link_geometry.h"
#include "common/error.h"
#include "report/coarse_meshes.h"
#include "report/shape_json.h"
#include "robot_model/mesh_robot_id.h"

namespace planbench {

ShownRobot::ShownRobot(Robot robot, std::string mesh_robot_id, std::size_t most_triangles)
    : robot_(std::move(robot)),
      mesh_robot_id_(std::move(mesh_robot_id)),
      most_triangles_(most_triangles) {}

const ShownBodies& ShownRobot::bodies() const {
  if (bodies_) return *bodies_;
  ShownBodies& shown = bodies_.emplace();
  try {
    std::vector<LinkGeometry> bodies = LoadLinkGeometry(robot_);
    if (bodies.empty()) shown.why_not = "its URDF has no collision geometry";
    if (!mesh_robot_id_.empty() && mesh_robot_id_ != MeshRobotId(robot_)) {
      shown.remarks.emplace_back(
          "The robot's meshes are not those of the session: their files are others, or have "
          "changed.");
    }
    std::vector<std::vector<PlacedShape>*> all;
    for (LinkGeometry& body : bodies) all.push_back(&body.shapes);
    Coarsen("robot", most_triangles_, all, &shown.remarks);
    for (const LinkGeometry& body : bodies) {
      Json& shapes = shown.shapes[body.link];
      for (const PlacedShape& placed : body.shapes) {
        Json one;
        one["shape"] = ShapeJson(placed.shape, &shown.meshes);
        one["pose"] = PoseJson(placed.X_FS);
        shapes.push_back(std::move(one));
      }
    }
  } catch (const InputError& error) {
    shown.why_not = error.what();
  }
  return shown;
}

}  // namespace planbench
