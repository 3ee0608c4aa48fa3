#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messaging/messages.h"
#include "robot_model/robot_folder.h"
#include "scene/scene.h"
#include "scene_server/checker_cache.h"

namespace planbench {

/// Judges paths, independently of the planners: with the planning robot's geometry of the collision
/// model that was asked for, and, if there is one, with the meshes of a referee robot, which tell
/// whether the real robot would have collided. Thread-safe (one path at a time).
class PathReferee {
 public:
  /// `mesh_robot` may be null; else it has the groups of `robot` and the root link of one is a link
  /// of the other (see LoadRefereeRobot), and its meshes are loaded here (InputError if one is
  /// missing). Holds references to both.
  PathReferee(const Robot& robot, const Robot* mesh_robot);

  /// Judges at the asked step. Waypoints may name the group's joints in any order; a path that
  /// names other joints, or not all, is invalid. A model that has no exact geometry of its own is
  /// judged with spheres: `voxels`, which only rasterises the world that the spheres meet, and any
  /// that this build lacks. Meshes are judged without clearances, which cost too much. Throws
  /// InputError naming the field for a step that is not positive or too fine (JudgePath), an
  /// unknown group, a start or goal that cannot be resolved.
  PathCheckReplyMessage Judge(const PathCheckRequestMessage& request,
                              const std::shared_ptr<const Scene>& scene);

  /// Pairs of links of the mesh robot that touch in every configuration of a group, with the other
  /// joints as in `start` and without pairs that may (see FindStandingContacts). Needs a mesh
  /// robot.
  std::vector<std::pair<std::string, std::string>> StandingContacts(
      const std::string& group, const JointState& start, const AllowedCollisionMatrix& allowed);

 private:
  std::shared_ptr<const Scene> InMeshRobotsFrame(const std::string& scene_id,
                                                 const std::shared_ptr<const Scene>& scene,
                                                 const std::vector<double>& positions,
                                                 const std::vector<double>& mesh_positions);

  const Robot* robot_;
  const Robot* mesh_robot_;
  std::mutex mutex_;
  CheckerCache checkers_;
  std::optional<CheckerCache> mesh_checkers_;
  // The scene last judged by meshes, in the mesh robot's base frame, if that is another.
  std::string moved_id_;
  Eigen::Isometry3d moved_by_;
  std::shared_ptr<const Scene> moved_;
};

}  // namespace planbench
