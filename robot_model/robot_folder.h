#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/yaml.h"
#include "geometry/mesh_loader.h"
#include "robot_model/edge_check.h"
#include "robot_model/robot_model.h"
#include "robot_model/voxel_settings.h"

namespace planbench {

/// A robot as planbench uses it: what `robots/<name>/robot.yaml` and the files it names describe.
/// Immutable after loading.
///
/// robot.yaml:
///   name: fetch
///   urdf: fetch.urdf
///   srdf: fetch.srdf               # optional: groups with their states, pairs that are never
///                                  #   checked, virtual joints, sphere approximations (Srdf)
///   spheres: spheres.yaml          # or a URDF or SRDF with spheres (ReadLinkSpheres); optional:
///                                  #   without any the spheres and voxels models cannot be used
///   enclosing_spheres: enclosing.yaml   # optional, likewise: those of the enclosing model, which
///                                       #   contain every body of the URDF (make_spheres)
///   edge_resolution_m: 0.02        # optional, default 0.02; from 1e-6 to 1
///   edge_check: certified          # or fixed; optional, default certified
///   groups:                        # instead of the SRDF's; needed without one
///     - name: arm_with_torso
///       joints: [torso_lift_joint, ...]
///       tip_link: gripper_link     # or a list: one an arm; the joints move it
///       states: {tuck: [0.1, ...]}                # optional: named configurations
///   virtual_joints:                # optional, instead of the SRDF's: how the robot stands in its
///                                  #   surroundings; fixed, planar or floating
///     - {name: world_joint, type: fixed, parent_frame: world, child_link: base_link}
///   allowed_pairs: [[link_a, link_b], ...]       # optional: never checked against each other,
///                                                #   beside those of the SRDF
///   checked_pairs: [[link_a, link_b], ...]       # optional: checked though a joint connects them,
///                                                #   beside those of the SRDF (Srdf)
///   links_without_spheres: [link, ...]           # optional: links with a body that `spheres`
///                                                #   leaves out by intention; others are warned of
///   planners: {ara: ara.yaml, rrtc: rrtc.yaml}   # optional: settings files by planner name
///   voxels:                        # optional: the grid of the voxels model (VoxelSettings);
///     resolution_m: 0.02           #   without it the reach of the robot, without walls
///     lower: [-1, -1, 0]           # m, base frame
///     upper: [1, 1, 2]
///     walls: true                  # whether all outside of the box counts as occupied
///     hollow: false                # optional: objects are their surface alone
struct Robot {
  std::string name;
  std::filesystem::path folder;
  std::string content_id;  ///< Content hash of robot.yaml, the URDF, the SRDF and what it has
                           ///< checked, and both spheres: equal robots, equal ids.
  RobotModel model;
  std::vector<PlanningGroup> groups;
  std::map<std::string, std::string> why_no_group;  ///< Srdf::why_no_group, if the groups are its.
  std::vector<VirtualJoint> virtual_joints;
  std::vector<LinkSphere> spheres;            ///< Sorted by link.
  std::vector<std::string> unchecked_links;   ///< With a body and no sphere, not by intention.
  std::filesystem::path spheres_file;         ///< That took the place of the folder's, absolute.
  std::vector<LinkSphere> enclosing_spheres;  ///< Those of the enclosing model, likewise.
  std::vector<std::pair<int, int>> allowed_pairs;  ///< Link indices.
  std::vector<std::pair<int, int>> checked_pairs;  ///< Link indices, likewise.
  double edge_resolution_m = 0.02;
  EdgeCheck edge_check = EdgeCheck::kCertified;
  std::optional<VoxelSettings> voxels;
  /// By planner name, the field that names a file of its settings, from the folder.
  std::map<std::string, YamlNode> planner_settings;
  ResourceResolver resources;  ///< For the collision meshes the URDF names.
  /// What was taken otherwise than written, is missing, in doubt (states turned more than once), or
  /// cannot be used (states outside the limits), one line each; whoever loads a robot for a user
  /// says it.
  std::vector<std::string> warnings;
  std::string referee_misfits;  ///< RefereeMisfits, of a robot that judges another's paths.

  /// The group of that name; throws InputError naming the known ones, or why the SRDF's group of
  /// that name is none. An empty name is the first
  /// group.
  const PlanningGroup& Group(const std::string& group_name) const;

  /// Whether two links are never checked against each other, whatever a scene says: they are rigid
  /// to each other, or allowed_pairs names them.
  bool NeverChecks(int link_a, int link_b) const;
  /// Whether two links are checked against each other where a scene does not say: all but those
  /// that are never checked, and those that a joint connects (RobotModel::Joined), unless
  /// checked_pairs names them.
  bool ChecksLinks(int link_a, int link_b) const;
};

/// Loads a robot folder, or one that ships by its name (FindRobotFolder); throws InputError naming
/// file, line and field. `spheres`: a file whose spheres take the place of the folder's `spheres`,
/// unless empty.
Robot LoadRobot(const std::filesystem::path& folder_or_name,
                const std::map<std::string, std::filesystem::path>& packages = {},
                const std::filesystem::path& spheres = {});

/// The robot whose meshes judge paths: the folder holds a robot.yaml, or, itself or else in its
/// folder `urdf`, exactly one .urdf file, whose groups are then those of `planning_robot` (matched
/// by joint and link names); if there is no such folder it is the robot of that name that ships.
/// The folder also serves package:// URIs. Throws InputError if it has neither, or lacks a joint or
/// link of the planning groups, or if neither robot has the other's root link, held by joints
/// outside the groups: scenes are in the planning robot's base frame. Finds, and warns of, its
/// referee_misfits.
Robot LoadRefereeRobot(const std::filesystem::path& folder_or_name, const Robot& planning_robot,
                       const std::map<std::string, std::filesystem::path>& packages = {});

}  // namespace planbench
