#include "robot_model/urdf_versions.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(UrdfVersions, TextOfVersion10IsLeftAsItIs) {
  const std::string text =
      "<?xml version='1.0'?>\n<!-- <capsule/> -->\n<robot name='r' version='1.0'><link name='a'>"
      "<collision><origin rpy='0 0 1'/><geometry><cylinder radius='1' length='1'/></geometry>"
      "</collision></link><gazebo><capsule/><origin quat_xyzw='0'/></gazebo></robot>\n";
  const Urdf10 urdf = ToUrdf10(text, "r.urdf");
  EXPECT_EQ(urdf.text, text);
  EXPECT_TRUE(urdf.capsules.empty());
}

TEST(UrdfVersions, QuaternionsOfOriginsCount) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<Quaterniond> turns = {
      Quaterniond(1, 0, 0, 0), Quaterniond(0, 1, 0, 0),
      Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitY()))};  // Gimbal lock.
  for (int i = 0; i < 50; ++i) {
    turns.emplace_back(normal(random), normal(random), normal(random), normal(random));
  }
  for (const Quaterniond& q : turns) {
    const std::string origin =
        fmt::format("<origin xyz='1 2 3' quat_xyzw='{} {} {} {}'/>", q.x(), q.y(), q.z(), q.w());
    const RobotModel model = RobotModel::FromUrdf(
        "<robot name='r' version='1.1'><link name='a'/><link name='b'><collision>" + origin +
            "<geometry><box size='1 1 1'/></geometry></collision></link>"
            "<joint name='j' type='fixed'><parent link='a'/><child link='b'/>" +
            origin + "</joint></robot>",
        "r.urdf");
    Isometry3d expected = Isometry3d::Identity();
    expected.linear() = q.normalized().toRotationMatrix();
    expected.translation() = Vector3d(1, 2, 3);
    EXPECT_TRUE(model.joints()[0].X_PJ.isApprox(expected, 1e-9)) << origin;
    EXPECT_TRUE(model.links()[1].collision[0].X_FS.isApprox(expected, 1e-9)) << origin;
  }
}

TEST(UrdfVersions, NoOriginKeepsItsQuaternionInATextOf10) {
  const std::string origin = "<origin quat_xyzw='0 0 0 1'/>";
  const Urdf10 urdf =
      ToUrdf10("<robot name='r' version='1.1'><link name='a'><inertial>" + origin +
                   "</inertial><visual>" + origin + "</visual><collision>" + origin +
                   "</collision></link><joint name='j'>" + origin + "</joint></robot>",
               "r.urdf");
  EXPECT_EQ(urdf.text.find("quat_xyzw"), std::string::npos) << urdf.text;
}

TEST(UrdfVersions, ACapsuleIsACylinderWithCaps) {
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='r' version='1.2'><link name='a'>"
      "<visual><geometry><capsule radius='1' length='1'/></geometry></visual>"
      "<collision><geometry><cylinder radius='0.2' length='0.3'/></geometry></collision>"
      "<collision><origin xyz='1 0 0' rpy='1.5707963267948966 0 0'/>"
      "<geometry><capsule radius='0.1' length='0.4'></capsule></geometry></collision>"
      "</link></robot>",
      "r.urdf");
  const std::vector<PlacedShape>& shapes = model.links()[0].collision;
  ASSERT_EQ(shapes.size(), 4u);
  EXPECT_EQ(std::get<Cylinder>(shapes[0].shape), (Cylinder{0.2, 0.3}));
  EXPECT_EQ(std::get<Cylinder>(shapes[1].shape), (Cylinder{0.1, 0.4}));
  for (const std::size_t cap : {2u, 3u}) {
    EXPECT_EQ(std::get<Sphere>(shapes[cap].shape).radius, 0.1);
    const double y = cap == 2 ? 0.2 : -0.2;  // z of the capsule is -y here.
    EXPECT_TRUE(shapes[cap].X_FS.translation().isApprox(Vector3d(1, y, 0), 1e-9));
  }
}

}  // namespace
}  // namespace planbench
