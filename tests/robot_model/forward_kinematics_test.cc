#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

#include "common/numbers.h"
#include "robot_model/group_kinematics.h"
#include "robot_model/robot_folder.h"
#include "tests/robot_model/random_configuration.h"
#include "tests/support/planning_problems.h"
#include "tests/support/shared_data.h"

namespace planbench {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Every kind of joint once, origins turned about different axes.
constexpr char kArm[] = R"(<robot name="arm">
  <link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
  <joint name="turn" type="revolute"><parent link="a"/><child link="b"/>
    <origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="b"/><child link="c"/>
    <origin xyz="0 0 1"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.5" velocity="1" effort="1"/></joint>
  <joint name="roll" type="continuous"><parent link="c"/><child link="d"/>
    <origin xyz="0.5 0 0" rpy="1.5707963267948966 0 0"/><axis xyz="0 -1 0"/></joint>
  <joint name="weld" type="fixed"><parent link="d"/><child link="e"/>
    <origin xyz="0 0 2"/></joint>
</robot>)";

RobotModel LoadUrdf(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return RobotModel::FromUrdf(text.str(), file.string());
}

TEST(ForwardKinematics, AtZeroLinksSitAtTheirJointsOrigins) {
  const RobotModel model = RobotModel::FromUrdf(kArm, "arm.urdf");
  const auto X_BL = ComputeLinkPoses(model, std::vector<double>{0, 0, 0});
  EXPECT_TRUE(X_BL[0].isApprox(Isometry3d::Identity()));
  EXPECT_TRUE(X_BL[1].translation().isApprox(Vector3d(1, 0, 0)));
  EXPECT_TRUE(X_BL[2].translation().isApprox(Vector3d(1, 0, 1)));
  EXPECT_TRUE(X_BL[3].translation().isApprox(Vector3d(1, 0.5, 1)));  // x of b points along y.
}

TEST(ForwardKinematics, AgreesWithHandComputation) {
  const RobotModel model = RobotModel::FromUrdf(kArm, "arm.urdf");
  const auto X_BL = ComputeLinkPoses(model, std::vector<double>{kPi / 2, 0.3, kPi / 2});
  // b: turned by a quarter by its origin and by another by its joint: x points along -x, y along
  // -y.
  Matrix3d R_ab = Vector3d(-1, -1, 1).asDiagonal();
  EXPECT_TRUE(X_BL[1].linear().isApprox(R_ab));
  EXPECT_TRUE(X_BL[1].translation().isApprox(Vector3d(1, 0, 0)));
  // c: 1 up and 0.3 along b's x.
  EXPECT_TRUE(X_BL[2].linear().isApprox(R_ab));
  EXPECT_TRUE(X_BL[2].translation().isApprox(Vector3d(0.7, 0, 1)));
  // d: 0.5 along c's x; turned about x by a quarter, then about its own -y by a quarter.
  Matrix3d R_ad;
  R_ad.col(0) = Vector3d(0, 1, 0);
  R_ad.col(1) = Vector3d(0, 0, 1);
  R_ad.col(2) = Vector3d(1, 0, 0);
  EXPECT_TRUE(X_BL[3].linear().isApprox(R_ad)) << X_BL[3].linear();
  EXPECT_TRUE(X_BL[3].translation().isApprox(Vector3d(0.2, 0, 1)));
  // e: 2 along d's z.
  EXPECT_TRUE(X_BL[4].linear().isApprox(R_ad));
  EXPECT_TRUE(X_BL[4].translation().isApprox(Vector3d(2.2, 0, 1)));
}

TEST(ForwardKinematics, OfTheFetchAgreesWithTheManufacturersDescription) {
  PLANBENCH_NEED_SHARED_DATA("fetch_description/fetch.urdf");
  const RobotModel ours = LoadFetch().model;
  const RobotModel theirs = LoadUrdf(SharedData("fetch_description/fetch.urdf"));
  ASSERT_EQ(ours.num_links(), theirs.num_links());
  ASSERT_EQ(ours.num_positions(), theirs.num_positions());
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const std::vector<double> positions = RandomPositions(ours, &random);
    std::vector<double> their_positions(positions.size());
    for (const Joint& joint : ours.joints()) {
      if (joint.position_index < 0) continue;
      const int index = theirs.FindJoint(joint.name);
      ASSERT_GE(index, 0) << joint.name;
      const int position_index = theirs.joints()[static_cast<std::size_t>(index)].position_index;
      ASSERT_GE(position_index, 0) << joint.name;
      their_positions[static_cast<std::size_t>(position_index)] =
          positions[static_cast<std::size_t>(joint.position_index)];
    }
    const auto our_poses = ComputeLinkPoses(ours, positions);
    const auto their_poses = ComputeLinkPoses(theirs, their_positions);
    for (int i = 0; i < ours.num_links(); ++i) {
      const std::string& name = ours.links()[static_cast<std::size_t>(i)].name;
      const int their_link = theirs.FindLink(name);
      ASSERT_GE(their_link, 0) << name;
      const double difference = (our_poses[static_cast<std::size_t>(i)].matrix() -
                                 their_poses[static_cast<std::size_t>(their_link)].matrix())
                                    .cwiseAbs()
                                    .maxCoeff();
      ASSERT_LE(difference, 1e-6) << name;
    }
  }
}

TEST(ForwardKinematics, FetchHasTheManufacturersJointsAndCollisionGeometry) {
  PLANBENCH_NEED_SHARED_DATA("fetch_description/fetch.urdf");
  const RobotModel ours = LoadFetch().model;
  const RobotModel theirs = LoadUrdf(SharedData("fetch_description/fetch.urdf"));
  ASSERT_EQ(ours.joints().size(), theirs.joints().size());
  for (const Joint& joint : ours.joints()) {
    SCOPED_TRACE(joint.name);
    const int index = theirs.FindJoint(joint.name);
    ASSERT_GE(index, 0);
    const Joint& other = theirs.joints()[static_cast<std::size_t>(index)];
    EXPECT_EQ(joint.type, other.type);
    EXPECT_EQ(ours.links()[static_cast<std::size_t>(joint.parent_link)].name,
              theirs.links()[static_cast<std::size_t>(other.parent_link)].name);
    EXPECT_EQ(joint.lower, other.lower);
    EXPECT_EQ(joint.upper, other.upper);
    EXPECT_EQ(joint.max_velocity, other.max_velocity);
    if (joint.type == JointType::kFixed) continue;
    EXPECT_EQ(joint.axis_J, other.axis_J);
  }
  for (const Link& link : ours.links()) {
    SCOPED_TRACE(link.name);
    const Link& other = theirs.links().at(static_cast<std::size_t>(theirs.FindLink(link.name)));
    ASSERT_EQ(link.collision.size(), other.collision.size());
    for (std::size_t i = 0; i < link.collision.size(); ++i) {
      EXPECT_EQ(std::get<Mesh>(link.collision[i].shape).resource,
                std::get<Mesh>(other.collision[i].shape).resource);
      EXPECT_TRUE(link.collision[i].X_FS.isApprox(other.collision[i].X_FS, 1e-9));
    }
  }
}

TEST(GroupKinematics, EqualsTheFullComputation) {
  const Robot fetch = LoadFetch();
  const PlanningGroup& group = fetch.Group("arm_with_torso");
  std::mt19937 random(2);
  for (int base = 0; base < 5; ++base) {
    // Held joints (wheels, head, fingers) somewhere, those of the group at placeholders.
    const std::vector<double> held = RandomPositions(fetch.model, &random);
    GroupKinematics kinematics(fetch.model, group, held);
    for (int trial = 0; trial < 100; ++trial) {
      const std::vector<double> q = RandomConfiguration(group.space, &random);
      kinematics.Update(q);
      const auto expected = ComputeLinkPoses(fetch.model, WithGroupAt(fetch.model, group, held, q));
      for (int link = 0; link < fetch.model.num_links(); ++link) {
        ASSERT_TRUE(kinematics.X_BL(link).isApprox(expected[static_cast<std::size_t>(link)], 1e-12))
            << fetch.model.links()[static_cast<std::size_t>(link)].name;
      }
    }
  }
}

TEST(GroupKinematics, KnowsWhichLinksMove) {
  const Robot fetch = LoadFetch();
  const RobotModel& model = fetch.model;
  const PlanningGroup arm = model.MakeGroup(
      "arm", {"shoulder_pan_joint", "elbow_flex_joint", "wrist_roll_joint"}, "gripper_link");
  const GroupKinematics kinematics(model, arm, model.DefaultPositions());
  const auto moves = [&](const char* link) { return kinematics.Moves(model.FindLink(link)); };
  EXPECT_FALSE(moves("base_link"));
  EXPECT_FALSE(moves("torso_lift_link"));
  EXPECT_FALSE(moves("head_pan_link"));
  EXPECT_TRUE(moves("shoulder_pan_link"));
  EXPECT_TRUE(moves("shoulder_lift_link"));
  EXPECT_TRUE(moves("l_gripper_finger_link"));
}

TEST(GroupKinematics, LinksMoveRelativelyIfTheirRelativePoseVaries) {
  const Robot fetch = LoadFetch();
  const RobotModel& model = fetch.model;
  const PlanningGroup arm = model.MakeGroup(
      "arm", {"shoulder_pan_joint", "elbow_flex_joint", "wrist_roll_joint"}, "gripper_link");
  const std::vector<double> held = model.DefaultPositions();
  GroupKinematics kinematics(model, arm, held);
  std::mt19937 random(3);
  const int n = model.num_links();
  std::vector<bool> varied(static_cast<std::size_t>(n * n), false);
  kinematics.Update(RandomConfiguration(arm.space, &random));
  const GroupKinematics reference = kinematics;
  for (int trial = 0; trial < 5; ++trial) {
    kinematics.Update(RandomConfiguration(arm.space, &random));
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        const Isometry3d before = reference.X_BL(a).inverse() * reference.X_BL(b);
        const Isometry3d after = kinematics.X_BL(a).inverse() * kinematics.X_BL(b);
        if (!before.isApprox(after, 1e-9)) varied[static_cast<std::size_t>(a * n + b)] = true;
      }
    }
  }
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      EXPECT_EQ(kinematics.MoveRelatively(a, b), varied[static_cast<std::size_t>(a * n + b)])
          << model.links()[static_cast<std::size_t>(a)].name << " "
          << model.links()[static_cast<std::size_t>(b)].name;
    }
  }
}

}  // namespace
}  // namespace planbench
