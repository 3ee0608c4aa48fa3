#include "robot_model/robot_model.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "robot_model/robot_folder.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

// A tree whose text lists joints and links in no helpful order, with a comment and a transmission
// that mention joints too.
constexpr char kTree[] = R"(<robot name="tree">
  <!-- <joint name="zulu" type="fixed"/> -->
  <link name="leaf_b"/>
  <transmission name="t"><joint name="alpha"><hardwareInterface/></joint></transmission>
  <joint name="zulu" type="prismatic">
    <parent link="trunk"/><child link="branch"/>
    <axis xyz="0 0 2"/><limit lower="0.1" upper="0.5" velocity="0.2" effort="1"/>
  </joint>
  <joint name="mike" type="fixed"><parent link="branch"/><child link="leaf_b"/></joint>
  <link name="trunk">
    <collision><geometry><box size="1 2 3"/></geometry></collision>
    <collision><origin xyz="0 0 1"/><geometry><cylinder radius="0.1" length="0.4"/></geometry>
    </collision>
  </link>
  <joint name="alpha" type="continuous">
    <parent link="trunk"/><child link="twig"/><axis xyz="0 1 0"/>
  </joint>
  <link name="twig"><collision><geometry><sphere radius="0.2"/></geometry></collision></link>
  <link name="branch"><collision><geometry>
    <mesh filename="package://tree/meshes/branch.stl" scale="0.001 0.002 0.003"/>
  </geometry></collision></link>
  <joint name="bravo" type="revolute">
    <parent link="branch"/><child link="leaf_a"/><axis xyz="1 0 0"/>
    <limit lower="-2" upper="-1" velocity="3" effort="1"/>
  </joint>
  <link name="leaf_a"/>
</robot>
)";

TEST(RobotModelLimits, ThatStandForNoneAreNarrowedAndThatLeaveNothingAreNamed) {
  const auto model_with = [](const std::string& limit, std::vector<std::string>* warnings) {
    return RobotModel::FromUrdf(
        "<robot name='r'><link name='a'/><link name='b'/>\n<joint name='j' type='revolute'>"
        "<parent link='a'/><child link='b'/><axis xyz='0 0 1'/><limit velocity='1' effort='1' " +
            limit + "/></joint></robot>",
        "r.urdf", warnings);
  };
  std::vector<std::string> warnings;
  const RobotModel wide = model_with("lower='-1e16' upper='2'", &warnings);
  EXPECT_EQ(wide.joints()[0].lower, -1e4);
  EXPECT_EQ(wide.joints()[0].upper, 2);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("too wide"), std::string::npos) << warnings[0];
  warnings.clear();
  model_with("", &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("no range"), std::string::npos) << warnings[0];
  warnings.clear();
  model_with("lower='-13' upper='13'", &warnings);  // Two turns.
  EXPECT_TRUE(warnings.empty());
}

TEST(RobotModelLimits, ThatAreProbablyInDegreesAreNamedOnce) {
  const auto limit = [](const char* lower, const char* upper) {
    return fmt::format("<limit velocity='1' effort='1' lower='{}' upper='{}'/></joint>", lower,
                       upper);
  };
  std::vector<std::string> warnings;
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><link name='d'/>"
      "<joint name='i' type='prismatic'><parent link='a'/><child link='b'/>" +
          limit("0", "20") +
          "\n<joint name='j' type='revolute'><parent link='b'/><child link='c'/>" +
          limit("-180", "180") +
          "<joint name='k' type='revolute'><parent link='c'/><child link='d'/>" +
          limit("-90", "0") + "</robot>",
      "r.urdf", &warnings);
  EXPECT_EQ(model.joints()[1].lower, -180);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            "r.urdf:2: joint 'j': its limits [-180, 180] reach 28.6 turns from zero; are they "
            "degrees? URDFs are in radians; likewise k");
}

TEST(RobotModelLimits, ThatAreProbablyInMillimetresAreNamedOnceAndOriginsToo) {
  const auto joint = [](const char* name, const char* origin, const char* type, double upper) {
    return fmt::format(
        "<link name='{0}'/>\n<joint name='{0}' type='{2}'><parent link='a'/><child link='{0}'/>"
        "<origin xyz='{1}'/><limit velocity='1' effort='1' lower='0' upper='{3}'/></joint>",
        name, origin, type, upper);
  };
  std::vector<std::string> warnings;
  RobotModel::FromUrdf("<robot name='r'><link name='a'/>" + joint("i", "20 0 0", "prismatic", 20) +
                           joint("j", "0 -300 20", "revolute", 1) +
                           joint("k", "0 0 0", "prismatic", 850) +
                           joint("l", "0 0 0", "prismatic", 1e9) + "</robot>",
                       "r.urdf", &warnings);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0],
            "r.urdf:3: joint 'j': its origin is at [0, -300, 20] m; are they millimetres? URDFs "
            "are in metres; likewise k");
  EXPECT_NE(warnings[1].find("joint 'l': its limits"), std::string::npos) << warnings[1];
}

class RobotModelTest : public testing::Test {
 protected:
  const RobotModel model_ = RobotModel::FromUrdf(kTree, "tree.urdf");
};

TEST_F(RobotModelTest, OrdersLinksDepthFirstInTheOrderOfTheText) {
  EXPECT_EQ(model_.name(), "tree");
  std::vector<std::string> links;
  for (const Link& link : model_.links()) links.push_back(link.name);
  EXPECT_EQ(links, (std::vector<std::string>{"trunk", "branch", "leaf_b", "leaf_a", "twig"}));
  std::vector<std::string> joints;
  for (const Joint& joint : model_.joints()) joints.push_back(joint.name);
  EXPECT_EQ(joints, (std::vector<std::string>{"zulu", "mike", "bravo", "alpha"}));
  EXPECT_EQ(model_.links()[0].child_joints, (std::vector<int>{0, 3}));
}

TEST_F(RobotModelTest, IsConsistent) {
  EXPECT_EQ(model_.links()[0].parent_joint, -1);
  int positions = 0;
  for (int j = 0; j < static_cast<int>(model_.joints().size()); ++j) {
    const Joint& joint = model_.joints()[static_cast<std::size_t>(j)];
    EXPECT_LT(joint.parent_link, joint.child_link);
    EXPECT_EQ(model_.links()[static_cast<std::size_t>(joint.child_link)].parent_joint, j);
    EXPECT_EQ(model_.FindJoint(joint.name), j);
    if (joint.type == JointType::kFixed) {
      EXPECT_EQ(joint.position_index, -1);
    } else {
      EXPECT_EQ(joint.position_index, positions++);
    }
  }
  EXPECT_EQ(model_.num_positions(), positions);
  for (int i = 0; i < model_.num_links(); ++i) {
    EXPECT_EQ(model_.FindLink(model_.links()[static_cast<std::size_t>(i)].name), i);
  }
  EXPECT_EQ(model_.FindLink("root"), -1);
  EXPECT_EQ(model_.FindJoint("trunk"), -1);
}

TEST_F(RobotModelTest, ReadsJoints) {
  const Joint& zulu = model_.joints()[0];
  EXPECT_EQ(zulu.type, JointType::kPrismatic);
  EXPECT_EQ(zulu.axis_J, Vector3d::UnitZ());  // Normalised.
  EXPECT_EQ(zulu.lower, 0.1);
  EXPECT_EQ(zulu.upper, 0.5);
  EXPECT_EQ(zulu.max_velocity, 0.2);
  EXPECT_EQ(model_.joints()[1].type, JointType::kFixed);
  EXPECT_EQ(model_.joints()[2].type, JointType::kRevolute);
  const Joint& alpha = model_.joints()[3];
  EXPECT_EQ(alpha.type, JointType::kContinuous);
  EXPECT_EQ(alpha.lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(alpha.upper, std::numeric_limits<double>::infinity());
}

TEST_F(RobotModelTest, ReadsCollisionGeometry) {
  const Link& trunk = model_.links()[0];
  ASSERT_EQ(trunk.collision.size(), 2u);
  EXPECT_EQ(std::get<Box>(trunk.collision[0].shape).size, Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<Cylinder>(trunk.collision[1].shape).radius, 0.1);
  EXPECT_EQ(std::get<Cylinder>(trunk.collision[1].shape).length, 0.4);
  EXPECT_EQ(trunk.collision[1].X_FS.translation(), Vector3d::UnitZ());
  const Link& branch = model_.links()[1];
  ASSERT_EQ(branch.collision.size(), 1u);
  const Mesh& mesh = std::get<Mesh>(branch.collision[0].shape);
  EXPECT_EQ(mesh.resource, "package://tree/meshes/branch.stl");
  EXPECT_EQ(mesh.scale, Vector3d(0.001, 0.002, 0.003));
  EXPECT_TRUE(mesh.triangles->vertices.empty());
  const Link& twig = model_.links()[4];
  EXPECT_EQ(std::get<Sphere>(twig.collision.at(0).shape).radius, 0.2);
}

TEST_F(RobotModelTest, LinksAreJoinedByAJointThatIsNotFixed) {
  const auto joined = [this](const char* a, const char* b) {
    EXPECT_EQ(model_.Joined(model_.FindLink(a), model_.FindLink(b)),
              model_.Joined(model_.FindLink(b), model_.FindLink(a)));
    return model_.Joined(model_.FindLink(a), model_.FindLink(b));
  };
  EXPECT_TRUE(joined("trunk", "branch"));
  EXPECT_FALSE(joined("branch", "leaf_b")) << "rigid to each other";
  EXPECT_FALSE(joined("trunk", "leaf_b"));
  EXPECT_FALSE(joined("leaf_a", "leaf_b"));
  EXPECT_FALSE(joined("trunk", "trunk"));
}

TEST(RobotModel, LinksAreRigidOverFixedJointsAlone) {
  const RobotModel model = RobotModel::FromUrdf(R"(<robot name="rigid">
    <link name="base"/><link name="post"/><link name="lamp"/><link name="sign"/><link name="arm"/>
    <link name="hand"/>
    <joint name="a" type="fixed"><parent link="base"/><child link="post"/></joint>
    <joint name="b" type="fixed"><parent link="post"/><child link="lamp"/></joint>
    <joint name="c" type="fixed"><parent link="base"/><child link="sign"/></joint>
    <joint name="d" type="continuous"><parent link="lamp"/><child link="arm"/></joint>
    <joint name="e" type="fixed"><parent link="arm"/><child link="hand"/></joint>
  </robot>)",
                                                "rigid.urdf");
  const auto rigid = [&](const char* a, const char* b) {
    return model.Rigid(model.FindLink(a), model.FindLink(b));
  };
  EXPECT_TRUE(rigid("base", "lamp"));
  EXPECT_TRUE(rigid("lamp", "sign"));
  EXPECT_TRUE(rigid("arm", "hand"));
  EXPECT_TRUE(rigid("arm", "arm"));
  EXPECT_FALSE(rigid("lamp", "arm")) << "a joint between them";
  EXPECT_FALSE(rigid("base", "arm"));
  EXPECT_FALSE(rigid("hand", "lamp"));
}

TEST_F(RobotModelTest, DefaultPositionsAreTheNearestToZeroWithinLimits) {
  EXPECT_EQ(model_.DefaultPositions(), (std::vector<double>{0.1, -1, 0}));
}

TEST_F(RobotModelTest, MakesGroupsInTheOrderGiven) {
  const PlanningGroup group = model_.MakeGroup("arm", {"alpha", "zulu"}, "leaf_a");
  EXPECT_EQ(group.name, "arm");
  EXPECT_EQ(group.joints, (std::vector<int>{3, 0}));
  EXPECT_EQ(group.tip_link, model_.FindLink("leaf_a"));
  ASSERT_EQ(group.space.size(), 2);
  EXPECT_TRUE(group.space.joint(0).continuous);
  EXPECT_FALSE(group.space.joint(0).prismatic);
  EXPECT_EQ(group.space.joint(0).lower, -std::numbers::pi);
  EXPECT_EQ(group.space.joint(0).upper, std::numbers::pi);
  EXPECT_EQ(group.space.joint(1).name, "zulu");
  EXPECT_TRUE(group.space.joint(1).prismatic);
  EXPECT_EQ(group.space.joint(1).lower, 0.1);
  EXPECT_EQ(group.space.joint(1).upper, 0.5);
  EXPECT_EQ(group.space.joint(1).max_velocity, 0.2);
}

TEST_F(RobotModelTest, OfTipsThatAreRigidToEachOtherTheFirstCounts) {
  const PlanningGroup group =
      model_.MakeGroup("arm", {"alpha", "zulu", "bravo"}, "twig", {"leaf_b", "branch", "leaf_a"});
  EXPECT_EQ(group.tips(), (std::vector<int>{model_.FindLink("twig"), model_.FindLink("leaf_b"),
                                            model_.FindLink("leaf_a")}));
  ExpectInputError(
      [this] {
        model_.MakeGroup("arm", {"alpha"}, "leaf_b", {"branch", "branch"});
      },
      {"arm", "tip 'branch' is repeated"});
}

TEST_F(RobotModelTest, RefusesGroupsItCannotMake) {
  const auto make = [this](const std::vector<std::string>& joints, const char* tip) {
    return [this, joints, tip] { model_.MakeGroup("arm", joints, tip); };
  };
  ExpectInputError(make({"alpha", "yankee"}, "twig"), {"arm", "tree", "'yankee' is unknown"});
  ExpectInputError(make({"mike"}, "twig"), {"arm", "'mike' is fixed"});
  ExpectInputError(make({"alpha", "alpha"}, "twig"), {"arm", "'alpha' is repeated"});
  ExpectInputError(make({"alpha"}, "stem"), {"arm", "tip link 'stem'"});
  ExpectInputError(make({}, "twig"), {"arm", "no joints"});
}

}  // namespace
}  // namespace planbench
