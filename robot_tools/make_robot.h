#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "robot_tools/say_line.h"

namespace planbench {

/// The flags of make_robot.
struct MakeRobotFlags {
  std::filesystem::path urdf;
  std::filesystem::path srdf;     ///< Empty: groups and pairs are proposed.
  std::filesystem::path spheres;  ///< Empty: those of the SRDF, else of the URDF's geometry.
  std::filesystem::path out;
  std::string name;  ///< Empty: the URDF's.
  std::vector<std::string> package_paths;
  int samples = 10'000;
  std::uint64_t seed = 1;
  double protrusion_m = 0.03;
  bool without_spheres = false;
  bool replace = false;

  void AddTo(CLI::App* app);
};

/// Writes a robot folder, complete and loadable, from a robot's own files. Tells what was decided
/// and why, a line each. Throws InputError, and writes nothing, for what it cannot do.
void MakeRobot(const MakeRobotFlags& flags, const SayLine& say);

}  // namespace planbench
