#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "robot_tools/say_line.h"

namespace planbench {

/// The flags of make_spheres.
struct MakeSpheresFlags {
  std::filesystem::path urdf;
  std::vector<std::string> package_paths;
  int spheres = 0;                 ///< In all; 0: as many as protrusion_m needs.
  double protrusion_m = 0;         ///< Greatest; 0: what `spheres` reach.
  std::vector<std::string> links;  ///< NAME=M: links with a greatest protrusion of their own.
  int most_a_link = 1000;
  std::filesystem::path outer;  ///< Files to write; empty: not written.
  std::filesystem::path inner;
  std::filesystem::path srdf;
  std::filesystem::path urdf_out;

  void AddTo(CLI::App* app);
};

/// Fits spheres to a robot's collision geometry and writes them. Tells the user, a line each: what
/// is odd about meshes, and a table of how close the spheres are, link by link. Throws InputError,
/// and writes nothing, for what it cannot do.
void MakeSpheres(const MakeSpheresFlags& flags, const SayLine& say);

}  // namespace planbench
