#pragma once

#include <filesystem>
#include <string>

#include "common/yaml.h"
#include "geometry/mesh_loader.h"
#include "scene/problem.h"

namespace planbench {

/// Reads moveit_msgs/PlanningScene and moveit_msgs/MotionPlanRequest as YAML, in the dialects of
/// MotionBenchMaker and of MoveIt: keys in any order, fields that do not bear on planning ignored,
/// optional ones absent, positions and orientations as sequences ([x, y, z], [x, y, z, w]) or as
/// maps ({x: .., y: ..}). Meshes named by resource are loaded through `resources`, their scale
/// applied. All poses come out canonical (scene/pose.h) and in W, the frame that the headers of
/// `fixed_frame_transforms` name (without these: that of the robot's joint state, else the one most
/// objects are in); an empty frame means W too, and other frames must be fixed frames. Objects
/// attached in the start state of the request join those of the scene. `set` and `index` come from
/// the file names (see ListProblemSet), "" and 0 for other names. Throws InputError naming file,
/// line and field, for malformed input and for what planbench would have to ignore although it
/// bears on planning: octomaps, link padding and scale, multi-DOF joints, object operations
/// other than ADD, goals other than one set of joint constraints, path constraints.
Problem ReadProblem(const std::filesystem::path& scene_file,
                    const std::filesystem::path& request_file, const ResourceResolver& resources);

/// The halves of ReadProblem.
Scene ReadScene(const YamlNode& planning_scene, const ResourceResolver& resources);
void ReadRequest(const YamlNode& motion_plan_request, Problem* problem,
                 const ResourceResolver& resources = {});

/// Writes the pair; reading it again gives an equal problem (equal content id, start, goal,
/// limits), and equal problems give equal bytes. Orientations as xyzw, numbers in the shortest form
/// that reads back exactly.
void WriteProblem(const Problem& problem, const std::filesystem::path& scene_file,
                  const std::filesystem::path& request_file);
std::string SceneToYaml(const Problem& problem);
std::string RequestToYaml(const Problem& problem);

}  // namespace planbench
