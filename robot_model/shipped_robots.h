#pragma once

#include <filesystem>

namespace planbench {

/// The folder that a name or path of a robot stands for: the folder itself if there is one, else
/// robots/NAME of the checkout that this program was built in, or of the installation that it is
/// in. Throws InputError, naming the robots that ship.
std::filesystem::path FindRobotFolder(const std::filesystem::path& folder_or_name);

}  // namespace planbench
