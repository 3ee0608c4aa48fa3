#include "robot_model/robot_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <variant>

#include "common/yaml.h"
#include "robot_model/mesh_robot_id.h"
#include "robot_model/shipped_robots.h"
#include "tests/robot_model/small_robot.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

TEST(LoadRobot, LoadsTheFetch) {
  const Robot fetch = LoadRobot(FetchFolder());
  EXPECT_EQ(fetch.name, "fetch");
  EXPECT_EQ(fetch.model.name(), "fetch");
  EXPECT_EQ(fetch.edge_resolution_m, 0.02);
  EXPECT_EQ(fetch.content_id.size(), 32u);
  EXPECT_EQ(fetch.model.num_links(), 26);
  EXPECT_EQ(fetch.model.num_positions(), 15);
  EXPECT_TRUE(fetch.planner_settings.empty()) << "the planners' defaults suit it";
  EXPECT_EQ(fetch.resources.base_folder, FetchFolder());

  ASSERT_EQ(fetch.groups.size(), 1u);
  const PlanningGroup& group = fetch.groups[0];
  EXPECT_EQ(group.name, "arm_with_torso");
  std::vector<std::string> names;
  std::vector<std::string> continuous;
  for (const JointSpace::Joint& joint : group.space.joints()) {
    names.push_back(joint.name);
    if (joint.continuous) continuous.push_back(joint.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"torso_lift_joint", "shoulder_pan_joint",
                                             "shoulder_lift_joint", "upperarm_roll_joint",
                                             "elbow_flex_joint", "forearm_roll_joint",
                                             "wrist_flex_joint", "wrist_roll_joint"}));
  EXPECT_EQ(continuous, (std::vector<std::string>{"upperarm_roll_joint", "forearm_roll_joint",
                                                  "wrist_roll_joint"}));
  EXPECT_TRUE(group.space.joint(0).prismatic);
  EXPECT_EQ(group.tip_link, fetch.model.FindLink("gripper_link"));
}

TEST(LoadRobot, FetchHasTheStudysGrid) {
  const Robot fetch = LoadRobot(FetchFolder());
  ASSERT_TRUE(fetch.voxels.has_value());
  EXPECT_EQ(NumVoxels(*fetch.voxels), (std::array<int, 3>{100, 100, 100}));
  EXPECT_EQ(fetch.voxels->lower, Eigen::Vector3d(-1.01, -1.01, -0.01));
  EXPECT_TRUE(fetch.voxels->walls);
  EXPECT_TRUE(fetch.voxels->hollow);
}

TEST(NumVoxels, CoversTheBox) {
  VoxelSettings settings;
  settings.resolution_m = 0.1;
  settings.lower = {-0.3, 0, 0};
  settings.upper = {0.3, 0.61, 0.01};
  EXPECT_EQ(NumVoxels(settings), (std::array<int, 3>{6, 7, 1}));
  settings.upper.x() = std::numeric_limits<double>::infinity();
  ExpectInputError([&] { NumVoxels(settings); }, {"along x", "inf"});
  settings.resolution_m = std::numeric_limits<double>::quiet_NaN();
  ExpectInputError([&] { NumVoxels(settings); }, {"resolution_m", "nan"});
}

TEST(LoadRobot, FetchHasTheStudysSpheres) {
  const Robot fetch = LoadRobot(FetchFolder());
  EXPECT_EQ(fetch.spheres.size(), 213u);
  for (std::size_t i = 1; i < fetch.spheres.size(); ++i) {
    EXPECT_LE(fetch.spheres[i - 1].link, fetch.spheres[i].link);
  }
  std::map<std::string, int> count;
  for (const LinkSphere& sphere : fetch.spheres) {
    ++count[fetch.model.links()[static_cast<std::size_t>(sphere.link)].name];
  }
  EXPECT_EQ(count.size(), 13u);
  EXPECT_EQ(count["torso_lift_link"], 113);
  EXPECT_EQ(count["l_gripper_finger_link"], 8);
}

TEST(LoadRobot, FetchSpheresEqualThePublishedOnes) {
  PLANBENCH_NEED_SHARED_DATA("paper/collision_model_fetch.yaml");
  using SphereFigures = std::tuple<std::string, double, double, double, double>;
  std::multiset<SphereFigures> published;
  const YamlNode root = YamlNode::LoadFile(SharedData("paper/collision_model_fetch.yaml").string());
  for (const YamlNode& link : root.At("robot_collision_model").At("spheres_models").Elements()) {
    for (const YamlNode& s : link.At("spheres").Elements()) {
      published.emplace(link.At("link_name").String(), s.At("x").Double(), s.At("y").Double(),
                        s.At("z").Double(), s.At("radius").Double());
    }
  }
  const Robot fetch = LoadRobot(FetchFolder());
  std::multiset<SphereFigures> ours;
  for (const LinkSphere& s : fetch.spheres) {
    ours.emplace(fetch.model.links()[static_cast<std::size_t>(s.link)].name, s.p_LS.x(), s.p_LS.y(),
                 s.p_LS.z(), s.radius);
  }
  EXPECT_EQ(ours, published);
}

TEST(LoadRobot, TheFetchsEnclosingSpheresHoldItsMeshes) {
  PLANBENCH_NEED_SHARED_DATA("fetch_description/meshes");
  const Robot fetch =
      LoadRobot(FetchFolder(), {{"fetch_description", SharedData("fetch_description")}});
  EXPECT_EQ(fetch.enclosing_spheres.size(), 883u);
  for (int link = 0; link < fetch.model.num_links(); ++link) {
    const Link& description = fetch.model.links()[static_cast<std::size_t>(link)];
    int outside = 0;
    for (const PlacedShape& placed : description.collision) {
      const auto& mesh = std::get<Mesh>(placed.shape);
      const TriangleMesh triangles = LoadMesh(fetch.resources.Resolve(mesh.resource), mesh.scale);
      for (const auto& [a, b, c] : triangles.triangles) {
        const auto& v = triangles.vertices;
        for (const Eigen::Vector3d& p : {v[a], v[b], v[c], Eigen::Vector3d((v[a] + v[b]) / 2),
                                         Eigen::Vector3d((v[a] + v[b] + v[c]) / 3)}) {
          outside += std::none_of(fetch.enclosing_spheres.begin(), fetch.enclosing_spheres.end(),
                                  [&, p_LP = Eigen::Vector3d(placed.X_FS * p)](const auto& s) {
                                    return s.link == link && (p_LP - s.p_LS).norm() <= s.radius;
                                  });
        }
      }
    }
    EXPECT_EQ(outside, 0) << description.name;
  }
}

TEST(LoadRobot, TakesGroupsPairsAndSpheresFromAnSrdf) {
  constexpr char kSrdf[] = R"(<robot name="small">
    <group name="turning"><joint name="turn"/></group>
    <group_state name="back" group="turning"><joint name="turn" value="3"/></group_state>
    <disable_collisions link1="base" link2="arm"/><disable_collisions link1="base" link2="leg"/>
    <link_sphere_approximation link="arm"><sphere center="1 0 0" radius="0.5"/>
    </link_sphere_approximation>
    <link_sphere_approximation link="foot"><sphere center="1 0 0" radius="0.5"/>
    </link_sphere_approximation></robot>)";
  TemporaryFolder folder;
  folder.Write("small.urdf", kSmallUrdf);
  folder.Write("small.srdf", kSrdf);
  folder.Write("robot.yaml", "name: small\nurdf: small.urdf\nsrdf: small.srdf\n");
  const Robot robot = LoadRobot(folder.path());
  ASSERT_EQ(robot.groups.size(), 1u);
  EXPECT_EQ(robot.groups[0].name, "turning");
  EXPECT_EQ(robot.groups[0].states.at("back"), std::vector<double>{3});
  EXPECT_EQ(robot.allowed_pairs.size(), 1u);
  ASSERT_EQ(robot.spheres.size(), 1u);
  EXPECT_EQ(robot.spheres[0].radius, 0.5);
  EXPECT_THAT(robot.warnings,
              testing::ElementsAre(testing::HasSubstr("leg"), testing::HasSubstr("foot")));

  folder.Write("small.srdf", std::string(kSrdf) + "\n");
  EXPECT_NE(LoadRobot(folder.path()).content_id, robot.content_id);
  folder.Write("spheres.yaml", "links: {arm: [{center: [0, 0, 0], radius: 2}]}");
  EXPECT_THAT(LoadRobot(folder.path(), {}, folder / "spheres.yaml").warnings,
              testing::ElementsAre(testing::HasSubstr("leg")));

  // What robot.yaml says itself stands before it.
  folder.Write(
      "robot.yaml",
      "name: small\nurdf: small.urdf\nsrdf: small.srdf\nspheres: spheres.yaml\n"
      "groups:\n  - {name: own, joints: [turn], tip_link: [arm, hand], states: {up: [1]}}\n");
  const Robot own = LoadRobot(folder.path());
  EXPECT_EQ(own.groups[0].name, "own");
  EXPECT_EQ(own.groups[0].states.at("up"), std::vector<double>{1});
  EXPECT_THAT(own.groups[0].more_tips, testing::IsEmpty());
  EXPECT_EQ(own.spheres[0].radius, 2);
  EXPECT_EQ(own.allowed_pairs.size(), 1u);
  EXPECT_THAT(own.warnings,
              testing::ElementsAre(testing::HasSubstr("leg"),
                                   testing::HasSubstr("robot.yaml:6: groups[0].tip_link: 'hand' "
                                                      "does not count: it is rigid to a tip")));

  folder.Write("small.srdf", "<robot name='small'/>");
  folder.Write("robot.yaml", "name: small\nurdf: small.urdf\nsrdf: small.srdf\n");
  ExpectInputError([&] { LoadRobot(folder.path()); }, {"robot.yaml:3", "srdf", "no group"});
}

TEST(LoadRobot, SaysWhyAGroupOfTheSrdfIsNone) {
  TemporaryFolder folder;
  folder.Write("small.urdf", kSmallUrdf);
  folder.Write("robot.yaml", "name: small\nurdf: small.urdf\nsrdf: small.srdf\n");
  const std::string none = "<robot name='small'>\n<group name='none'/>";
  const std::string turning = "<group name='turning'><joint name='turn'/></group>";
  folder.Write("small.srdf", none + turning + "</robot>");
  const Robot robot = LoadRobot(folder.path());
  EXPECT_EQ(robot.Group("").name, "turning");
  EXPECT_THAT(robot.warnings,
              testing::ElementsAre(testing::HasSubstr("small.srdf:2: group 'none' is left out")));
  ExpectInputError([&] { robot.Group("none"); },
                   {"no group 'none'", "small.srdf:2", "it has no joint", "known are: turning"});
  // Another one is none.
  folder.Write("small.srdf", none + "</robot>");
  ExpectInputError([&] { LoadRobot(folder.path()); },
                   {"robot.yaml:3", "no group with joints", "small.srdf:2", "'none'"});
  // Groups of robot.yaml take the place of all of them.
  folder.Write("robot.yaml",
               "name: small\nurdf: small.urdf\nsrdf: small.srdf\ngroups:\n"
               "  - {name: own, joints: [turn], tip_link: arm}\n");
  EXPECT_THAT(LoadRobot(folder.path()).warnings, testing::IsEmpty());
}

TEST(LoadRobot, VirtualJointsAreTheSrdfsOrItsOwn) {
  TemporaryFolder folder;
  folder.Write("small.urdf", kSmallUrdf);
  folder.Write("small.srdf",
               "<robot name='small'><group name='turning'><joint name='turn'/></group>"
               "<virtual_joint name='v' type='planar' parent_frame='odom' child_link='base'/>"
               "</robot>");
  const std::string yaml = "name: small\nurdf: small.urdf\nsrdf: small.srdf\n";
  folder.Write("robot.yaml", yaml);
  const auto only = [&] {
    const Robot robot = LoadRobot(folder.path());
    EXPECT_EQ(robot.virtual_joints.size(), 1u);
    return robot.virtual_joints.at(0);
  };
  EXPECT_EQ(only().type, JointType::kPlanar);
  EXPECT_EQ(only().parent_frame, "odom");
  const std::string own =
      "virtual_joints:\n  - {name: w, type: fixed, parent_frame: world, child_link: base}\n";
  folder.Write("robot.yaml", yaml + own);
  EXPECT_EQ(only().type, JointType::kFixed);
  EXPECT_EQ(only().name, "w");
  EXPECT_EQ(only().child_link, 0);
  const auto refuse = [&](const std::string& what, const std::string& by,
                          const std::vector<std::string>& parts) {
    std::string text = own;
    folder.Write("robot.yaml", yaml + text.replace(text.find(what), what.size(), by));
    ExpectInputError(only, parts);
  };
  refuse("fixed", "revolute",
         {"robot.yaml:5: virtual_joints[0].type", "fixed, planar or floating"});
  refuse("base", "leg", {"robot.yaml:5: virtual_joints[0].child_link", "no link 'leg'"});
  refuse("name: w", "nam: w", {"robot.yaml:5: virtual_joints[0]", "unknown key 'nam'"});
  refuse("name: w", "name: turn", {"robot.yaml:5: virtual_joints[0].name", "joint of the URDF"});
  refuse("base}", "base}\n" + own.substr(own.find("  -")),
         {"robot.yaml:6: virtual_joints[1].name", "'w' occurs twice"});
}

TEST(LoadRobot, SpheresMayBeTheGeometryOfAUrdf) {
  TemporaryFolder folder;
  WriteSmallRobot(folder, ".");
  folder.Write("robot.yaml", std::string(kSmallRobot) + "spheres: spheres.urdf\n");
  const auto write = [&](const std::string& link, const std::string& geometry) {
    folder.Write("spheres.urdf", "<robot name='s'>\n<link name='" + link +
                                     "'><collision><origin xyz='0 0 3'/><geometry>" + geometry +
                                     "</geometry></collision></link></robot>");
  };
  write("arm", "<sphere radius='0.5'/>");
  const Robot robot = LoadRobot(folder.path());
  ASSERT_EQ(robot.spheres.size(), 1u);
  EXPECT_EQ(robot.spheres[0].link, robot.model.FindLink("arm"));
  EXPECT_EQ(robot.spheres[0].p_LS, Eigen::Vector3d(0, 0, 3));
  write("leg", "<sphere radius='0.5'/>");
  ExpectInputError([&] { LoadRobot(folder.path()); }, {"spheres.urdf:2", "leg", "small"});
  write("arm", "<box size='1 1 1'/>");
  ExpectInputError([&] { LoadRobot(folder.path()); }, {"spheres.urdf:2", "arm", "box"});
}

TEST(LoadRobot, ContentIdFollowsTheContentNotThePlace) {
  TemporaryFolder folder;
  WriteSmallRobot(folder, "here");
  WriteSmallRobot(folder, "there/again");
  const std::string id = LoadRobot(folder.path() / "here").content_id;
  EXPECT_EQ(LoadRobot(folder.path() / "there/again").content_id, id);

  folder.Write("here/robot.yaml", std::string(kSmallRobot) + "edge_resolution_m: 0.01\n");
  EXPECT_NE(LoadRobot(folder.path() / "here").content_id, id);
  folder.Write("here/robot.yaml", kSmallRobot);
  EXPECT_EQ(LoadRobot(folder.path() / "here").content_id, id);
  folder.Write("here/small.urdf", std::string(kSmallUrdf) + "\n");
  EXPECT_NE(LoadRobot(folder.path() / "here").content_id, id);

  const std::string with_spheres = std::string(kSmallRobot) + "spheres: spheres.yaml\n";
  folder.Write("there/again/robot.yaml", with_spheres);
  folder.Write("there/again/spheres.yaml", "links: {arm: [{center: [0, 0, 0], radius: 1}]}");
  const std::string spheres_id = LoadRobot(folder.path() / "there/again").content_id;
  folder.Write("there/again/spheres.yaml", "links: {arm: [{center: [0, 0, 0], radius: 2}]}");
  EXPECT_NE(LoadRobot(folder.path() / "there/again").content_id, spheres_id);
}

TEST(LoadRobot, RelativeMeshesBeginWhereTheUrdfIs) {
  const TemporaryFolder folder;
  folder.Write("small/urdf/small.urdf", kSmallUrdf);
  std::string yaml = kSmallRobot;
  folder.Write("small/robot.yaml", yaml.replace(yaml.find("small.urdf"), 0, "urdf/"));
  folder.Write("small/meshes/arm.stl", "");
  const Robot robot = LoadRobot(folder / "small");
  EXPECT_TRUE(fs::equivalent(robot.resources.Resolve("../meshes/arm.stl"),
                             folder / "small/meshes/arm.stl"));
  EXPECT_EQ(robot.resources.Resolve("package://small/meshes/arm.stl"),
            folder / "small/meshes/arm.stl");
}

TEST(MeshRobotId, FollowsDescriptionAndMeshes) {
  TemporaryFolder folder;
  WriteSmallRobot(folder, "small");
  const auto id = [&] { return MeshRobotId(LoadRobot(folder.path() / "small")); };
  const std::string without_mesh = id();
  folder.Write("small/small_description/meshes/arm.stl", "solid one");
  const std::string with_mesh = id();
  EXPECT_NE(with_mesh, without_mesh);
  folder.Write("small/small_description/meshes/arm.stl", "solid two");
  EXPECT_NE(id(), with_mesh);
  folder.Write("small/small_description/meshes/arm.stl", "solid one");
  EXPECT_EQ(id(), with_mesh);
  folder.Write("small/robot.yaml", std::string(kSmallRobot) + "edge_resolution_m: 0.01\n");
  EXPECT_NE(id(), with_mesh);
}

TEST(LoadRobot, OptionalFieldsHaveDefaults) {
  TemporaryFolder folder;
  folder.Write("small.urdf", kSmallUrdf);
  folder.Write("robot.yaml",
               "name: small\nurdf: small.urdf\n"
               "groups: [{name: all, joints: [turn], tip_link: arm}]\n");
  const Robot robot = LoadRobot(folder.path());
  EXPECT_EQ(robot.edge_resolution_m, 0.02);
  EXPECT_TRUE(robot.spheres.empty());
  EXPECT_TRUE(robot.allowed_pairs.empty());
  EXPECT_TRUE(robot.planner_settings.empty());
  EXPECT_FALSE(robot.voxels.has_value());
}

TEST(LoadRobot, ResolvesMeshesByPackageOrFolder) {
  TemporaryFolder folder;
  WriteSmallRobot(folder, "small");
  folder.Write("small_description/meshes/arm.stl", "");
  folder.Write("description/meshes/arm.stl", "");
  const std::string uri = "package://small_description/meshes/arm.stl";
  EXPECT_EQ(LoadRobot(folder.path() / "small").resources.Resolve(uri),
            folder.path() / "small_description/meshes/arm.stl");
  EXPECT_EQ(
      LoadRobot(folder.path() / "small", {{"small_description", folder.path() / "description"}})
          .resources.Resolve(uri),
      folder.path() / "description/meshes/arm.stl");
}

TEST(LoadRobot, WarnsOfBodiesWithoutSpheres) {
  TemporaryFolder folder;
  folder.Write("small.urdf", R"(<robot name="small">
  <link name="base"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="arm"><collision><geometry><sphere radius="1"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/></joint>
  <joint name="end" type="fixed"><parent link="arm"/><child link="tip"/></joint>
</robot>)");
  folder.Write("spheres.yaml", "links: {arm: [{center: [0, 0, 0], radius: 1}]}");
  const std::string yaml =
      "name: small\nurdf: small.urdf\nspheres: spheres.yaml\n"
      "groups: [{name: all, joints: [turn], tip_link: arm}]\n";
  folder.Write("robot.yaml", yaml);
  const std::vector<std::string> warnings = LoadRobot(folder.path()).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("robot.yaml:3: spheres: no spheres for base, which"),
            std::string::npos)
      << warnings[0];
  const auto others = folder.Write("mine.yaml", "links: {arm: [{center: [0, 0, 0], radius: 2}]}");
  EXPECT_THAT(LoadRobot(folder.path(), {}, others).warnings,
              testing::ElementsAre(testing::HasSubstr("mine.yaml: no spheres for base, which")));
  EXPECT_THAT(LoadRobot(folder.path()).unchecked_links, testing::ElementsAre("base"));

  folder.Write("robot.yaml", yaml + "links_without_spheres: [base]\n");
  EXPECT_TRUE(LoadRobot(folder.path()).warnings.empty());
  EXPECT_TRUE(LoadRobot(folder.path()).unchecked_links.empty());
  folder.Write("robot.yaml", yaml + "links_without_spheres: [basis]\n");
  ExpectInputError([&] { LoadRobot(folder.path()); }, {"robot.yaml:5", "'basis'"});
}

TEST(LoadRobot, EnclosingSpheresAreASecondSet) {
  const TemporaryFolder folder;
  WriteSmallRobot(folder, "small");
  const std::string yaml = std::string(kSmallRobot) + "enclosing_spheres: enclosing.yaml\n";
  folder.Write("small/robot.yaml", yaml);
  const auto load = [&] { return LoadRobot(folder / "small"); };
  ExpectInputError(load, {"robot.yaml:6", "enclosing_spheres", "enclosing.yaml: cannot be opened"});
  folder.Write("small/enclosing.yaml",
               "links:\n  arm:\n    - {center: [0, 0, 0.5], radius: 0.25}\n");
  const Robot robot = load();
  EXPECT_TRUE(robot.spheres.empty());
  ASSERT_EQ(robot.enclosing_spheres.size(), 1u);
  EXPECT_EQ(robot.enclosing_spheres[0].radius, 0.25);
  EXPECT_TRUE(robot.warnings.empty());
  folder.Write("small/enclosing.yaml",
               "links:\n  arm:\n    - {center: [0, 0, 0.5], radius: 0.26}\n");
  EXPECT_NE(load().content_id, robot.content_id);
  folder.Write("small/enclosing.yaml",
               "links:\n  leg:\n    - {center: [0, 0, 0.5], radius: 0.25}\n");
  ExpectInputError(load, {"enclosing.yaml:3", "leg"});
  folder.Write("small/enclosing.yaml",
               "links:\n  base:\n    - {center: [0, 0, 0.5], radius: 0.25}\n");
  ExpectInputError(load, {"robot.yaml:6", "enclosing_spheres", "nothing of arm"});
}

TEST(LoadRobot, AFileOfSpheresMayTakeThePlaceOfTheFolders) {
  const TemporaryFolder folder;
  WriteSmallRobot(folder, "small");
  folder.Write("own.yaml", "links:\n  arm:\n    - {center: [0, 0, 0.5], radius: 0.25}\n");
  const auto load = [&](const fs::path& spheres) {
    return LoadRobot(folder / "small", {}, spheres);
  };
  const Robot robot = load(folder / "own.yaml");
  ASSERT_EQ(robot.spheres.size(), 1u);
  EXPECT_EQ(robot.spheres[0].radius, 0.25);
  EXPECT_NE(robot.content_id, load({}).content_id);
  folder.Write("own.yaml", "links:\n  leg:\n    - {center: [0, 0, 0.5], radius: 0.25}\n");
  ExpectInputError([&] { load(folder / "own.yaml"); }, {"own.yaml:3", "leg"});
  ExpectInputError([&] { load(folder / "none.yaml"); }, {"none.yaml"});
}

TEST(LoadRobot, LoadsThePandaAndTheUr5e) {
  const fs::path robots = fs::path(PLANBENCH_SOURCE_DIR) / "robots";
  const Robot panda = LoadRobot(robots / "panda");
  EXPECT_EQ(panda.groups[0].space.size(), 7);
  EXPECT_EQ(panda.groups[0].states.at("ready").size(), 7u);
  EXPECT_EQ(panda.spheres.size(), 58u);
  // The flange at the data sheet's figures, with all joints at zero: 0.088 m ahead, 0.926 m up.
  std::vector<double> zero(static_cast<std::size_t>(panda.model.num_positions()), 0.0);
  const auto X_BL = ComputeLinkPoses(panda.model, zero);
  const Eigen::Vector3d flange =
      X_BL[static_cast<std::size_t>(panda.model.FindLink("panda_link8"))].translation();
  EXPECT_LT((flange - Eigen::Vector3d(0.088, 0, 0.926)).norm(), 1e-9);

  const Robot ur5e = LoadRobot(robots / "ur5e");
  EXPECT_EQ(ur5e.groups[0].space.size(), 6);
  // Stretched out along -x: 0.425 + 0.3922 m; 0.1333 + 0.0996 m to the side; 0.1625 - 0.0997 m up.
  const auto X_BU = ComputeLinkPoses(ur5e.model, std::vector<double>(6, 0.0));
  const Eigen::Vector3d tool =
      X_BU[static_cast<std::size_t>(ur5e.model.FindLink("tool0"))].translation();
  EXPECT_LT((tool - Eigen::Vector3d(-0.8172, -0.2329, 0.0628)).norm(), 1e-9);
}

TEST(LoadRobot, ShippedRobotsHaveNothingToWarnOf) {
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::path(PLANBENCH_SOURCE_DIR) / "robots")) {
    const Robot robot = LoadRobot(entry.path());
    EXPECT_TRUE(robot.warnings.empty()) << robot.warnings.front();
  }
}

TEST(LoadRobot, FindsShippedRobotsByName) {
  EXPECT_EQ(LoadRobot("panda").folder, fs::path(PLANBENCH_SOURCE_DIR) / "robots/panda");
  ExpectInputError([] { LoadRobot("pando"); }, {"pando: no such folder", "fetch, panda, ur5e"});
}

TEST(FindRobotFolder, AFolderCountsIfItIsARobots) {
  const TemporaryFolder folder;
  folder.Write("panda/notes.txt", "");
  folder.Write("notes/notes.txt", "");
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  EXPECT_EQ(FindRobotFolder("panda"), fs::path(PLANBENCH_SOURCE_DIR) / "robots/panda");
  EXPECT_EQ(FindRobotFolder("notes"), "notes") << "its reader says what it lacks";
  folder.Write("panda/robot.yaml", "");
  EXPECT_EQ(FindRobotFolder("panda"), "panda");
  fs::current_path(before);
}

TEST(Robot, FindsGroupsByName) {
  const Robot fetch = LoadRobot(FetchFolder());
  EXPECT_EQ(fetch.Group("").name, "arm_with_torso");
  EXPECT_EQ(fetch.Group("arm_with_torso").name, "arm_with_torso");
  ExpectInputError([&] { fetch.Group("leg"); }, {"fetch", "'leg'", "arm_with_torso"});
}

}  // namespace
}  // namespace planbench
