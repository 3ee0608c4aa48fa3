#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "common/read_text.h"
#include "tests/support/temporary_folder.h"

namespace planbench {

/// A robot folder, `arm` below another: the planar arm, its spheres kept, but with a mesh, named as
/// given, in the place of its hand's body.
inline std::filesystem::path WriteMeshArm(const TemporaryFolder& folder, const std::string& mesh) {
  const std::filesystem::path planar = std::string(PLANBENCH_SOURCE_DIR) + "/tests/data/planar3";
  for (const char* file : {"robot.yaml", "spheres.yaml"}) {
    folder.Write(fmt::format("arm/{}", file), ReadText(planar / file));
  }
  std::string urdf = ReadText(planar / "planar3.urdf");
  const std::size_t hand = urdf.find("<sphere", urdf.find("<link name=\"hand\">"));
  urdf.replace(hand, urdf.find("/>", hand) + 2 - hand,
               fmt::format("<mesh filename=\"{}\"/>", mesh));
  folder.Write("arm/planar3.urdf", urdf);
  return folder / "arm";
}

}  // namespace planbench
