#pragma once

#include <string>
#include <vector>

#include "messaging/messages.h"
#include "report/shown_robot.h"
#include "report/table.h"
#include "scene/problem.h"

namespace planbench {

/// What the 3D view shows (report/web/viewer.js) of a problem: solids, the robot's spheres or,
/// where the collision model has none, its collision geometry, start and goal. Poses are [x, y, z,
/// qx, qy, qz, qw] in the robot's base frame, m:
///   {title, facts: [line, ...],
///    solids: [{name, link (of attached ones), shape: {type, ...}, pose}],
///    links: [{name, pose (at the start), moves, spheres: [[x, y, z, radius], ...],
///             shapes: [{shape, pose (in the link)}, ...]}],
///    goals: [[pose of each link that moves, all in one list], ...],
///    motions: [{name, frames: [[pose of each link that moves, all in one list], ...],
///               tips: [[[x, y, z], ...], ...], collision: frame, contact: text}]}
/// Of a goal's alternatives that one is shown in which the path ends; without a path as many as
/// can be told apart, and a fact says of how many.
/// Throws InputError for a problem that does not fit the robot.
Json ProblemView(const ShownRobot& shown, const Problem& problem);

/// The same of a run, with its raw and simplified paths, each in about `num_frames` frames, every
/// waypoint among them; the referee's finding is the collision.
Json RunView(const ShownRobot& shown, const Scene& scene, const RunRecordMessage& run,
             int num_frames);

/// The same of a request that is being planned: `run` is what is known of it. It has neither paths
/// nor a status; a set or a contestant that is not known is empty.
Json RequestView(const ShownRobot& shown, const Scene& scene, const RunRecordMessage& run);

}  // namespace planbench
