#pragma once

#include "robot_model/robot_folder.h"
#include "scene/problem.h"

namespace planbench {

/// Every joint the problem names: those of the scene's robot_state, overlaid by the request's
/// start_state.
JointState StartOf(const Problem& problem);

/// Throws InputError, naming file and field, unless the problem is one for this robot:
/// robot_model_name is that of the robot or of its URDF (or empty), joints, group, and links of
/// attached objects are the robot's, every joint of the group has a start and one goal.
void RequireProblemFits(const Problem& problem, const ProblemFiles& files, const Robot& robot);

}  // namespace planbench
