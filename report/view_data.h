#pragma once

#include <string>
#include <vector>

#include "collision/collision_model.h"
#include "messaging/messages.h"
#include "report/shown_robot.h"
#include "report/shown_scene.h"
#include "report/table.h"
#include "scene/problem.h"

namespace planbench {

/// What the 3D view shows (report/web/viewer.js) of a problem: solids, the robot by the geometry
/// that `model` checks, start and goal. Where that cannot be had, its spheres stand for meshes, or
/// meshes, else other spheres, for spheres, and a fact says so. Poses are [x, y, z, qx, qy, qz, qw]
/// in the robot's base frame, m; shapes and meshes are ShapeJson's:
///   {meshes: {id: {...}, ...} that shapes name,
///    title, facts: [line, ...],
///    solids: [{name, link (of attached ones), shape, pose}],
///    links: [{name, pose (at the start), moves, spheres: [[x, y, z, radius], ...],
///             shapes: [{shape, pose (in the link)}, ...]}],
///    goals: [[pose of each link that moves, all in one list], ...],
///    motions: [{name, frames: [[pose of each link that moves, all in one list], ...],
///               tips: [[[x, y, z], ...], ...], collision: frame, contact: text}]}
/// Of a goal's alternatives that one is shown in which the path ends; without a path as many as
/// can be told apart, and a fact says of how many.
/// Throws InputError for a problem that does not fit the robot.
Json ProblemView(const ShownRobot& shown, const Problem& problem,
                 CollisionModel model = CollisionModel::kSpheres);

/// The same of a run, by the model of its request, with its raw and simplified paths, each in about
/// `num_frames` frames, every waypoint among them; the referee's finding is the collision. Paths of
/// other joints than the group's are left out, and a fact says so.
Json RunView(const ShownRobot& shown, const ShownScene& scene, const RunRecordMessage& run,
             int num_frames);

/// The same of a request that is being planned: `run` is what is known of it. It has neither paths
/// nor a status; a set or a contestant that is not known is empty.
Json RequestView(const ShownRobot& shown, const ShownScene& scene, const RunRecordMessage& run);

}  // namespace planbench
