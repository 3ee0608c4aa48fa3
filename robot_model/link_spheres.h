#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// Reads a sphere model for a robot, of one of three kinds, told apart by the file's name; `text`
/// is what it holds. Sorted by link. Throws InputError with file and line, also for links that the
/// robot does not have; those of an SRDF do not count, which `warnings`, if given, says.
///
/// *.yaml:
///   links:
///     gripper_link:
///       - {center: [x, y, z], radius: r}         # m, in the link's frame
/// *.urdf: a description whose collision geometry is spheres. Links without collision geometry have
///   none; other geometry is refused.
/// *.srdf: its <link_sphere_approximation>.
std::vector<LinkSphere> ReadLinkSpheres(const std::filesystem::path& file, const std::string& text,
                                        const RobotModel& model,
                                        std::vector<std::string>* warnings = nullptr);

}  // namespace planbench
