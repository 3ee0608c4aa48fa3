#pragma once

#include <string>

#include "common/yaml.h"
#include "geometry/mesh_loader.h"
#include "robot_model/robot_folder.h"
#include "scene/frame_tree.h"
#include "scene/scene.h"

namespace planbench {

inline constexpr double kLargestShape = 1e9;  ///< What a length of a shape may be, m.

/// Reads the id of an object: one line, and not the name of a link with a body or of the octomap,
/// since names tell bodies apart in the allowed-collision matrix. Throws InputError.
std::string ReadObjectId(const YamlNode& node, const Robot& robot);

/// Reads a shape_msgs/SolidPrimitive: type box [x, y, z], sphere [radius], cylinder [height,
/// radius], cone [height, radius], or the message's numbers 1 to 4.
Shape ReadPrimitive(const YamlNode& node);

/// Reads a moveit_msgs/CollisionObject: id, `pose`, and one or more shapes, which are `primitives`
/// with `primitive_poses`, `meshes` (or `mesh`) with `mesh_poses` and `planes` with `plane_poses`.
/// The object's pose comes out in the frame that its header names (see AddWorldObjects). Poses of
/// shapes may be left out if the object has a `pose`. A `pose` whose seven numbers are all zero
/// counts as absent: that is how messages leave it unset.
///
/// Meshes: {resource: URI, dimensions: [sx, sy, sz]} (a scale per axis, also called `scale`) or
/// {vertices: [[x, y, z], ..], triangles: [[a, b, c], ..]} with triangles also as {vertex_indices:
/// [a, b, c]}. Planes: {coef: [a, b, c, d]} is the half-space a x + b y + c z + d <= 0, solid on
/// the side that the normal (a, b, c) points away from: [0, 0, 1, 0] is a floor.
///
/// Throws InputError for what cannot be read or is not supported: operations other than ADD, planes
/// of attached objects.
SceneObject ReadCollisionObject(const YamlNode& node, const ResourceResolver& resources);

/// Adds the objects of world.collision_objects to `scene`, in the base frame, and their frames (an
/// object's is that of its pose, or of its one shape if it has no pose) and subframes to `frames`.
/// An object may be given in the frame of one above it. Throws InputError, also for an id that
/// occurs twice.
void AddWorldObjects(const YamlNode& world, const ResourceResolver& resources, const Robot& robot,
                     FrameTree* frames, Scene* scene);

/// Adds the attached_collision_objects of a moveit_msgs/RobotState to `scene`, with their poses in
/// their links. As in MoveIt, an object with shapes takes the place of one that is attached by that
/// id already, and one without is the world's of that id, where it is; in either case that leaves
/// the world. Beyond MoveIt, one without shapes may also name an attached object, which is then
/// attached anew where it is: to another link, with other touch links. Without a frame objects are
/// in that of their link. `frames` have the robot in that state, which is what tells where the link
/// is. Throws InputError, also for links that the robot does not have.
void AddAttachedObjects(const YamlNode& robot_state, const ResourceResolver& resources,
                        const Robot& robot, FrameTree* frames, Scene* scene);

/// Removes the attached objects that `robot_state` does not name, with a warning each, at
/// `is_diff`, and their frames.
void DetachUnnamed(const YamlNode& robot_state, const YamlNode& is_diff, FrameTree* frames,
                   Scene* scene);

/// Adds world.octomap, if it has data, as an object kOctomapId of boxes.
void AddOctomap(const YamlNode& world, const FrameTree& frames, Scene* scene);

}  // namespace planbench
