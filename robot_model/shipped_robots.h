#pragma once

#include <filesystem>

namespace planbench {

/// Whether there is a robot.yaml in it.
bool IsRobotFolder(const std::filesystem::path& path);

/// The folder that a name or path of a robot stands for: the folder itself if it is a robot's, else
/// robots/NAME of the checkout that this program was built in, or of the installation that it is
/// in, else the folder, whatever it holds. Throws InputError, naming the robots that ship.
std::filesystem::path FindRobotFolder(const std::filesystem::path& folder_or_name);

}  // namespace planbench
