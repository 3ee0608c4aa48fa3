#pragma once

#include <filesystem>
#include <string>

#include "common/yaml.h"
#include "geometry/mesh_loader.h"
#include "robot_model/robot_folder.h"
#include "scene/problem.h"

namespace planbench {

/// Reads moveit_msgs/PlanningScene and moveit_msgs/MotionPlanRequest as YAML for a robot, in the
/// dialects of MotionBenchMaker and of MoveIt: keys in any order, optional ones absent, positions
/// and orientations as sequences ([x, y, z], [x, y, z, w]) or as maps ({x: .., y: ..}); also what
/// `rostopic echo` writes, and the message as the one field of a service's request or answer.
/// Meshes named by resource are loaded, their scale applied; relative paths are from the scene's
/// folder, packages the robot's.
///
/// Every frame that a header names is resolved (see FrameTree) into W, the robot's base frame at
/// the start of the problem: what the scene says with the robot in the scene's own robot_state,
/// which is as the start in all that it leaves open, what the request says with the robot at the
/// start. An empty one is the planning frame of the file. All poses come out canonical
/// (scene/pose.h). Objects attached in the start state of the request join those of the scene, or
/// take their place; if it says `is_diff: false`, it says all of them. Joints that follow others
/// are where those put them. `set` and `index` come from the file names (see ListProblemSet), ""
/// and 0 for other names. What was read otherwise than written is in Problem::warnings.
///
/// Throws InputError naming file, line and field, for malformed input, fields that the messages do
/// not have, what does not fit the robot (its name, joints, links, group, a start and, in every
/// set of goal constraints, a goal for each joint of the group or a pose that the tip reaches), and
/// what planbench would have to ignore although it bears on planning: link padding and scale,
/// object operations other than ADD, path constraints.
Problem ReadProblem(const std::filesystem::path& scene_file,
                    const std::filesystem::path& request_file, const Robot& robot);
/// The same for parsed files.
Problem ParseProblem(const YamlNode& planning_scene, const YamlNode& motion_plan_request,
                     const Robot& robot, const ResourceResolver& resources);

/// Writes the pair; reading it again gives an equal problem (equal content id, start, goal,
/// limits), and equal problems give equal bytes. What was not read must have, for that, an entry in
/// the matrix for every two links among its names that a joint connects: files name all pairs, and
/// "may not touch" there has such links checked. Orientations as xyzw, numbers in the shortest form
/// that reads back exactly. Throws InputError for capsules and octomaps, which files have no form
/// for here.
void WriteProblem(const Problem& problem, const std::filesystem::path& scene_file,
                  const std::filesystem::path& request_file);
std::string SceneToYaml(const Problem& problem);
std::string RequestToYaml(const Problem& problem);

}  // namespace planbench
