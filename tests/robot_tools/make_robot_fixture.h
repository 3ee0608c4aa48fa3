#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "robot_tools/make_robot.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {

/// Three joints, a box, a cylinder, a sphere and a mesh-free hand whose second finger follows.
inline constexpr char kCraneUrdf[] = R"(<robot name="crane">
  <link name="base"><collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
  <link name="mast"><collision><origin xyz="0 0 0.5"/><geometry>
    <cylinder radius="0.05" length="1"/></geometry></collision></link>
  <link name="boom"><collision><origin xyz="0.6 0 0"/><geometry>
    <cylinder radius="0.05" length="0.2"/></geometry></collision></link>
  <link name="hook"><collision><geometry><sphere radius="0.06"/></geometry></collision></link>
  <link name="eye"/>
  <joint name="slew" type="continuous"><parent link="base"/><child link="mast"/>
    <origin xyz="0 0 0.2"/><axis xyz="0 0 1"/></joint>
  <joint name="luff" type="revolute"><parent link="mast"/><child link="boom"/>
    <origin xyz="0.1 0 1"/><axis xyz="0 1 0"/><limit lower="-1" upper="1.2" velocity="1" effort="1"/>
  </joint>
  <joint name="reel" type="prismatic"><parent link="boom"/><child link="hook"/>
    <origin xyz="0.9 0 -0.2"/><axis xyz="0 0 -1"/>
    <limit lower="0" upper="0.6" velocity="1" effort="1"/></joint>
  <joint name="ring" type="fixed"><parent link="hook"/><child link="eye"/></joint>
</robot>)";

inline constexpr char kCraneSrdf[] = R"(<robot name="crane">
  <group name="jib"><chain base_link="base" tip_link="eye"/></group>
  <group_state name="parked" group="jib"><joint name="luff" value="-0.5"/></group_state>
  <group_state name="bent" group="jib"><joint name="luff" value="3"/></group_state>
  <virtual_joint name="yard" type="fixed" parent_frame="world" child_link="base"/>
  <disable_collisions link1="base" link2="mast" reason="Adjacent"/>
  <disable_collisions link1="mast" link2="boom" reason="Adjacent"/>
  <disable_collisions link1="boom" link2="hook" reason="Adjacent"/>
  <disable_collisions link1="base" link2="boom" reason="Never"/>
  <disable_collisions link1="base" link2="wheel" reason="Never"/>
</robot>)";

class MakeRobotTest : public testing::Test {
 protected:
  MakeRobotTest() {
    folder_.Write("in/crane.urdf", kCraneUrdf);
    folder_.Write("in/crane.srdf", kCraneSrdf);
    flags_.urdf = folder_.path() / "in/crane.urdf";
    flags_.out = folder_.path() / "out";
    flags_.samples = 500;
    flags_.protrusion_m = 0.1;
  }
  std::string Make() {
    std::string report;
    MakeRobot(flags_, [&](const std::string& line) { report += line + "\n"; });
    return report;
  }
  void MakeSilently() {
    MakeRobot(flags_, [](const std::string&) {});
  }
  void Srdf(const std::string& text = kCraneSrdf) {
    folder_.Write("in/crane.srdf", text);
    flags_.srdf = folder_.path() / "in/crane.srdf";
  }
  void Spheres(const std::string& text) {
    folder_.Write("in/spheres.yaml", text);
    flags_.spheres = folder_.path() / "in/spheres.yaml";
  }
  void ExpectRefused(const std::vector<std::string>& parts) {
    ExpectInputError([&] { MakeSilently(); }, parts);
    EXPECT_FALSE(std::filesystem::exists(flags_.out)) << "something was written";
  }

  TemporaryFolder folder_;
  MakeRobotFlags flags_;
};

}  // namespace planbench
