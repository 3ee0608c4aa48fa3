#pragma once

#include <span>
#include <vector>

#include "planner_ara/arms.h"
#include "planner_ara/motion_primitives.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// What ARA* takes for a robot that has no settings of its own: lattice and moves that follow from
/// the joints' limits and reaches. See docs/ara.md for how they were found.

/// Reach of each joint of a group, m/rad (1 for a prismatic joint): see MotionBound, over the
/// robot's collision spheres, or the origins of its links where it has none.
std::vector<double> JointReaches(const Robot& robot, const PlanningGroup& group);

/// By joint: true for the joints that carry an arm about, those with at least half of the longest
/// reach of its own (what arms share has a longer one) and prismatic ones; false for a wrist.
std::vector<char> MajorJoints(const JointSpace& space, std::span<const double> reaches,
                              const Arms& arms);

/// Size of a cell, rad or m: 1 degree; 5 mm, or 1/40 of a shorter travel.
double DefaultCell(const JointSpace::Joint& joint);

/// Long moves: each joint alone, by 20 degrees (40 for joints that are not major) or 0.1 m, a rail
/// (a prismatic joint of more than 1 m of travel) by a fifth of its travel, but at most 0.3 m; none
/// by more than a third of its range. Every two joints of one arm (JointsOnOneArm) that are rails,
/// or major and revolute, together, in the same and in opposite directions. Short moves: each joint
/// by half of that. Of a continuous joint the moves divide the circle where a divisor is near, so
/// that different orders of moves meet.
MotionPrimitives DefaultPrimitives(const JointSpace& space, std::span<const double> discretization,
                                   std::span<const char> major,
                                   const std::vector<std::vector<char>>& on_one_arm);

}  // namespace planbench
