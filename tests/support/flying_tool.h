#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "robot_model/robot_folder.h"
#include "tests/support/obj_text.h"
#include "tests/support/temporary_folder.h"

namespace planbench {

/// Links in a row along x, the first one `from`, the last one `to`, `length_m` apart.
inline std::string Boom(const std::string& from, const std::string& to, double length_m) {
  constexpr double kStep = 500;  // lengths beyond a kilometre are refused
  std::string urdf;
  std::string last = from;
  for (double left_m = length_m; left_m > 0; left_m -= kStep) {
    const std::string next = left_m <= kStep ? to : to + std::to_string(left_m);
    if (next != to) urdf += "<link name=\"" + next + "\"/>";
    urdf += "<joint name=\"to_" + next + "\" type=\"fixed\"> <parent link=\"" + last +
            "\"/> <child link=\"" + next + "\"/> <origin xyz=\"" +
            std::to_string(std::min(left_m, kStep)) + " 0 0\"/> </joint>";
    last = next;
  }
  return urdf;
}

/// Of the geometry of a flyer's links in their frames.
inline Eigen::Isometry3d FlyerGeometryPose() {
  Eigen::Isometry3d X_LG(Eigen::Translation3d(0.01, 0, 0));
  X_LG.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
              Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  return X_LG;
}

/// Its tool turns about three axes and then slides along three: q is x, y, z in m, and three
/// angles. Geometry is a URDF's; the base is `far_m` from the origin, along x.
inline Robot MakeFlyer(const std::string& tool_geometry, const std::string& base_geometry = {},
                       double far_m = 0) {
  const auto body = [](const std::string& name, const std::string& geometry) {
    if (geometry.empty()) return "<link name=\"" + name + "\"/>";
    return "<link name=\"" + name +
           "\"> <collision> <origin xyz=\"0.01 0 0\" rpy=\"0.1 0.2 0.3\"/>" + "<geometry>" +
           geometry + "</geometry> </collision> </link>";
  };
  std::string urdf = "<robot name=\"flyer\">" + body("base", base_geometry);
  if (far_m > 0) urdf += "<link name=\"origin\"/>" + Boom("origin", "base", far_m);
  const std::vector<std::string> links = {"a", "b", "c", "d", "e", "tool"};
  const std::vector<std::string> joints = {"x", "y", "z", "roll", "pitch", "yaw"};
  const char* axes[] = {"1 0 0", "0 1 0", "0 0 1"};
  for (std::size_t i = 0; i < links.size(); ++i) {
    urdf += body(links[i], links[i] == "tool" ? tool_geometry : "");
    urdf += "<joint name=\"" + joints[i] + "\" type=\"" + (i < 3 ? "prismatic" : "revolute") +
            "\"> <parent link=\"" + (i == 0 ? "base" : links[i - 1]) + "\"/> <child link=\"" +
            links[i] + "\"/> <axis xyz=\"" + axes[i % 3] +
            "\"/> <limit lower=\"-2\" upper=\"2\" velocity=\"1\" effort=\"1\"/> </joint>";
  }
  Robot robot;
  robot.name = "flyer";
  robot.model = RobotModel::FromUrdf(urdf + "</robot>", "flyer.urdf");
  robot.groups = {robot.model.MakeGroup("flyer", joints, "tool")};
  return robot;
}

/// The same of a mesh, which is put into the folder, where `base_geometry` may name others.
inline Robot MakeFlyer(const TemporaryFolder& folder, const TriangleMesh& tool,
                       const std::string& base_geometry = {}, bool with_middles = false,
                       double far_m = 0) {
  folder.Write("tool.obj", ObjText(tool));
  Robot robot = MakeFlyer(R"(<mesh filename="tool.obj"/>)", base_geometry, far_m);
  robot.resources.base_folder = folder.path();
  if (with_middles) {
    const int link = robot.model.FindLink("tool");
    robot.enclosing_spheres = {{link, {0.2, 0, 0}, 0.15}, {link, {-0.2, 0.1, 0.1}, 0.2}};
  }
  return robot;
}

}  // namespace planbench
