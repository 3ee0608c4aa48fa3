#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "report/table.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// A robot's collision geometry as 3D views draw it.
struct ShownBodies {
  std::map<int, Json> shapes;    ///< By link: [{shape, pose (in the link)}, ...] (shape_json.h).
  Json meshes = Json::object();  ///< Those that the shapes name, by id (ShapeJson).
  std::string coarser;           ///< A sentence, if meshes have fewer triangles than their files.
  std::string why_not;           ///< Why there are none; empty if there are.
};

/// A robot, with what stands for it in 3D views. Not thread-safe.
class ShownRobot {
 public:
  /// What pages hold and browsers draw, a dozen copies of the robot at a time, without being slow.
  static constexpr std::size_t kMostTriangles = 200'000;

  ShownRobot() = default;
  explicit ShownRobot(Robot robot, std::size_t most_triangles = kMostTriangles);

  const Robot& robot() const { return robot_; }
  /// Reads the meshes when it is asked for them first. If they have more triangles than
  /// `most_triangles`, vertices are joined, the nearest ones first, until they have not; a mesh is
  /// left as fine as it takes to know it again.
  const ShownBodies& bodies() const;

 private:
  Robot robot_;
  std::size_t most_triangles_ = kMostTriangles;
  mutable std::optional<ShownBodies> bodies_;
};

}  // namespace planbench
