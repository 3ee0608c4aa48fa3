#pragma once

#include <string>
#include <string_view>

#include "common/yaml.h"
#include "geometry/mesh_loader.h"
#include "robot_model/robot_folder.h"
#include "scene/frame_tree.h"
#include "scene/scene.h"

namespace planbench {

inline constexpr double kLargestShape = 1e9;  ///< What a length of a shape may be, m.

/// Whether a text of YAML may have an object with a mesh, which may be in a file that it names:
/// whether `mesh` stands in it other than as messages without one write it (`meshes: []`,
/// `mesh_poses: []`), or may do so escaped. Never false where there is one.
bool MayHaveMesh(std::string_view yaml_text);

/// Reads the id of an object: one line, and not the name of a link with a body or of the octomap,
/// since names tell bodies apart in the allowed-collision matrix. Throws InputError.
std::string ReadObjectId(const YamlNode& node, const Robot& robot);

/// Reads a shape_msgs/SolidPrimitive: type box [x, y, z], sphere [radius], cylinder [height,
/// radius], cone [height, radius], or the message's numbers 1 to 4.
Shape ReadPrimitive(const YamlNode& node);

/// Reads a moveit_msgs/CollisionObject: id, `pose`, and one or more shapes, which are `primitives`
/// with `primitive_poses`, `meshes` (or `mesh`) with `mesh_poses` and `planes` with `plane_poses`.
/// The object's pose comes out in the frame that its header names (see AddSceneObjects). All poses
/// of one kind of shapes may be left out, with a warning if there is no `pose` either, and are the
/// identity then. A `pose` whose seven numbers are all zero
/// counts as absent: that is how messages leave it unset. (In MoveIt 2 it is the identity that
/// does.)
///
/// Meshes: {resource: URI, dimensions: [sx, sy, sz]} (a scale per axis, also called `scale`) or
/// {vertices: [[x, y, z], ..], triangles: [[a, b, c], ..]} with triangles also as {vertex_indices:
/// [a, b, c]}. Planes: {coef: [a, b, c, d]} is the half-space a x + b y + c z + d <= 0, solid on
/// the side that the normal (a, b, c) points away from: [0, 0, 1, 0] is a floor.
///
/// Throws InputError for what cannot be read or is not supported: operations other than ADD, planes
/// of attached objects.
SceneObject ReadCollisionObject(const YamlNode& node, const ResourceResolver& resources);

/// Adds the objects of a moveit_msgs/PlanningScene to `scene`: what its robot_state attaches (see
/// AddAttachedObjects), the world's collision_objects, in the base frame, and world.octomap, if it
/// has data, as an object kOctomapId of boxes. Their frames (an object's is that of its pose, or of
/// its one shape if it has no pose) and subframes go to `frames`, which have the robot in the
/// scene's state. As in MoveIt what is attached comes first, so that the world's objects may be
/// given in frames of it; beyond MoveIt, what needs the world, attached by id or in the frame of an
/// object of it, comes last. An object may be given in the frame of one before it. Throws
/// InputError, also for an id of the world that occurs twice.
void AddSceneObjects(const YamlNode& planning_scene, const ResourceResolver& resources,
                     const Robot& robot, FrameTree* frames, Scene* scene);

/// Adds the attached_collision_objects of a moveit_msgs/RobotState to `scene`, with their poses in
/// their links. As in MoveIt, an object with shapes takes the place of one that is attached by that
/// id already, and one without is the world's of that id, where it is; in either case that leaves
/// the world, with a warning if the two need not be the same. Beyond MoveIt, one without shapes may
/// also name an attached object, which is then attached anew where it is: to another link, with
/// other touch links. Without a frame objects are in the planning frame, with a warning. `frames`
/// have the robot in that state, which is what tells where the link is. Throws InputError, also for
/// links that the robot does not have.
void AddAttachedObjects(const YamlNode& robot_state, const ResourceResolver& resources,
                        const Robot& robot, FrameTree* frames, Scene* scene);

/// Removes the attached objects that `robot_state` does not name, with a warning each, at
/// `is_diff`, and their frames.
void DetachUnnamed(const YamlNode& robot_state, const YamlNode& is_diff, FrameTree* frames,
                   Scene* scene);

}  // namespace planbench
