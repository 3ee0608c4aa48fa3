#pragma once

#include <string>
#include <vector>

#include "messaging/messages.h"
#include "report/table.h"
#include "robot_model/robot_folder.h"
#include "scene/problem.h"

namespace planbench {

/// What the 3D view shows (report/web/viewer.js) of a problem: solids, the robot's spheres, start
/// and goal. Poses are [x, y, z, qx, qy, qz, qw] in the robot's base frame, m:
///   {title, facts: [line, ...],
///    solids: [{name, link (of attached ones), shape: {type, ...}, pose}],
///    links: [{name, pose (at the start), moves, spheres: [[x, y, z, radius], ...]}],
///    goals: [[pose of each link that moves, all in one list], ...],
///    motions: [{name, frames: [[pose of each link that moves, all in one list], ...],
///               tips: [[[x, y, z], ...], ...], collision: frame, contact: text}]}
/// Of a goal's alternatives that one is shown in which the path ends; without a path as many as
/// can be told apart, and a fact says of how many.
/// Throws InputError for a problem that does not fit the robot.
Json ProblemView(const Robot& robot, const Problem& problem);

/// The same of a run, with its raw and simplified paths, each in about `num_frames` frames, every
/// waypoint among them; the referee's finding is the collision.
Json RunView(const Robot& robot, const Scene& scene, const RunRecordMessage& run, int num_frames);

/// The same of a request that is being planned: `run` is what is known of it. It has neither paths
/// nor a status; a set or a contestant that is not known is empty.
Json RequestView(const Robot& robot, const Scene& scene, const RunRecordMessage& run);

}  // namespace planbench
