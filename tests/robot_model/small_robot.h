#pragma once

#include <filesystem>
#include <string>

#include "tests/support/temporary_folder.h"

namespace planbench {

inline std::filesystem::path FetchFolder() {
  return std::filesystem::path(PLANBENCH_SOURCE_DIR) / "robots/fetch";
}

inline constexpr char kSmallUrdf[] = R"(<robot name="small">
  <link name="base"/><link name="hand"/>
  <joint name="weld" type="fixed"><parent link="arm"/><child link="hand"/></joint>
  <link name="arm"><collision><geometry>
    <mesh filename="package://small_description/meshes/arm.stl"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/></joint>
</robot>)";
inline constexpr char kSmallRobot[] =
    "name: small\nurdf: small.urdf\ngroups:\n  - {name: all, joints: [turn], tip_link: arm}\n"
    "allowed_pairs: [[base, arm]]\n";

inline void WriteSmallRobot(const TemporaryFolder& folder, const std::string& name) {
  folder.Write(name + "/small.urdf", kSmallUrdf);
  folder.Write(name + "/robot.yaml", kSmallRobot);
}

}  // namespace planbench
