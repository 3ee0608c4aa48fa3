#pragma once

#include "common/yaml.h"
#include "geometry/mesh_loader.h"
#include "scene/scene.h"

namespace planbench {

/// Reads a moveit_msgs/CollisionObject: id, `pose`, and one or more shapes, which are `primitives`
/// with `primitive_poses`, `meshes` (or `mesh`) with `mesh_poses` and `planes` with `plane_poses`.
/// The object's pose comes out in the frame that its header names (see ReadFrame). Poses of shapes
/// may be left out if the object has a `pose`. A `pose` whose seven numbers are all zero counts as
/// absent: that is how messages leave it unset.
///
/// Primitives: type box [x, y, z], sphere [radius], cylinder [height, radius], cone [height,
/// radius], or shape_msgs/SolidPrimitive's numbers 1 to 4. Meshes: {resource: URI, dimensions: [sx,
/// sy, sz]} (a scale per axis, also called `scale`) or {vertices: [[x, y, z], ..], triangles: [[a,
/// b, c], ..]} with triangles also as {vertex_indices: [a, b, c]}. Planes: {coef: [a, b, c, d]} is
/// the half-space a x + b y + c z + d <= 0, solid on the side that the normal (a, b, c) points away
/// from: [0, 0, 1, 0] is a floor.
///
/// Throws InputError for what cannot be read or is not supported: operations other than ADD, planes
/// of attached objects.
SceneObject ReadCollisionObject(const YamlNode& node, const ResourceResolver& resources);

/// Adds the attached_collision_objects of `message` (a moveit_msgs/RobotState, or a planning scene
/// that carries them itself) to `scene`. An object's frame must be the link it is attached to. An
/// object that the scene has attached already is accepted if it is the same in all that bears on
/// collisions, as when both the scene and the request state it. Throws InputError, also for an id
/// that the scene has otherwise.
void AddAttachedObjects(const YamlNode& message, const ResourceResolver& resources, Scene* scene);

}  // namespace planbench
