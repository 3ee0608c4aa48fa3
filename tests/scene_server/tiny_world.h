#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "messaging/messages.h"
#include "robot_model/robot_folder.h"
#include "scene/problem.h"
#include "scene_server/scene_service.h"
#include "tests/support/temporary_folder.h"

namespace planbench {

/// The robot folder of `tiny`: a mast that lifts (prismatic, 0 to 0.5 m, along z) and swings
/// (continuous, about z), with an arm of 0.5 m along x at height lift + 0.1 m, of spheres of radius
/// 0.05 m, and a finger (prismatic, 0 to 0.3 m along x, outside the group) at its end. The group
/// "arm" is [swing, lift]; "lift_only" is [lift].
std::filesystem::path WriteTinyRobot(const TemporaryFolder& parent);

/// A folder with one URDF: `tiny` as its maker would describe it, the arm a mesh as tall as 1 m,
/// the finger fixed. With `below` base_link there are more links and joints.
std::filesystem::path WriteTinyMeshRobot(const TemporaryFolder& parent,
                                         const std::string& below = "");
/// What puts base_link on a pedestal that stands on a root link `world`.
inline constexpr char kPedestal[] =
    "<link name='world'/><joint name='stand' type='fixed'><parent link='world'/>"
    "<child link='base_link'/><origin xyz='0.1 0 0.8' rpy='0 0 1'/></joint>";

/// A can (radius 0.05 m, up to 0.2 m high) in the arm's way at swing = 0, a post at swing = pi that
/// only the extended finger reaches. From swing -1 to swing 1, lift 0.
Problem TinyProblem();
/// The start and goal of TinyProblem.
inline constexpr double kStartSwing = -1;
inline constexpr double kGoalSwing = 1;

/// Writes it as sceneNNNN.yaml and requestNNNN.yaml.
void WriteTinyProblem(const Problem& problem, const std::filesystem::path& set, int index);

/// A service of the tiny robot and the set "cans" with the problems 1, 2 and 5 (all TinyProblem,
/// but 2 without the post), in a temporary folder.
class TinyWorld {
 public:
  explicit TinyWorld(bool with_mesh_robot = false, const std::string& below_mesh_robot = "");

  const TemporaryFolder& folder() const { return folder_; }
  SceneService& service() { return *service_; }
  /// Asks for problem 1 and returns its scene's id.
  std::string SceneIdOfFirst();

 private:
  TemporaryFolder folder_;
  std::unique_ptr<SceneService> service_;
};

}  // namespace planbench
