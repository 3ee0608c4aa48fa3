#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "common/error.h"
#include "messaging/messages.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// No folder of a session's robot is named, or it or its spheres are not where they are named.
class UnknownRobot : public InputError {
 public:
  using InputError::InputError;
};

/// The robot of a session: that of `robot_folder`, or, if that is empty, of the folder or the robot
/// that ships which the driver's flags name, or else, as of processes that were started by hand, of
/// the folder that the scene server of its robot tells of. The `spheres` of the flags, or else of
/// that server, hold for all of them, and so do the packages of the flags, unless `packages` names
/// them; where the file of spheres is not here, `robot_folder` may hold them as its own. Whether it
/// is the session's, its content id tells.
/// Throws UnknownRobot, and InputError if it cannot be read or another robot stands for one whose
/// spheres are not here.
Robot LoadSessionRobot(const SessionMessage& session, const std::filesystem::path& robot_folder,
                       std::map<std::string, std::filesystem::path> packages = {});

}  // namespace planbench
