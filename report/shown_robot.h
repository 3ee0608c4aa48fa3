#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "report/coarse_meshes.h"
#include "report/table.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// A robot's collision geometry as 3D views draw it.
struct ShownBodies {
  std::map<int, Json> shapes;    ///< By link: [{shape, pose (in the link)}, ...] (shape_json.h).
  Json meshes = Json::object();  ///< Those that the shapes name, by id (ShapeJson).
  std::vector<std::string> remarks;  ///< Sentences: that they are coarser than their files, say.
  std::string why_not;               ///< Why there are none; empty if there are.
};

/// A robot, with what stands for it in 3D views. Not thread-safe.
class ShownRobot {
 public:
  ShownRobot() = default;
  /// `mesh_robot_id`: MeshRobotId of the session that is shown; "" if it, or a session, is unknown.
  explicit ShownRobot(Robot robot, std::string mesh_robot_id = "",
                      std::size_t most_triangles = kMostTrianglesShown);

  const Robot& robot() const { return robot_; }
  /// Reads the meshes when it is asked for them first, and says if they are not the session's. With
  /// more than `most_triangles` they are made coarser (Coarsen).
  const ShownBodies& bodies() const;

 private:
  Robot robot_;
  std::string mesh_robot_id_;
  std::size_t most_triangles_ = kMostTrianglesShown;
  mutable std::optional<ShownBodies> bodies_;
};

}  // namespace planbench
