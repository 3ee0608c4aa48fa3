#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/read_text.h"
#include "robot_model/robot_folder.h"
#include "tests/robot_tools/make_robot_fixture.h"
#include "tests/support/generated_meshes.h"

namespace planbench {
namespace {

using testing::HasSubstr;

// What becomes of the URDF's shapes and mesh files, and what is told of them.

TEST_F(MakeRobotTest, MeshesAreEnclosedAndCopied) {
  const std::string mesh = std::string(kCraneUrdf)
                               .replace(std::string(kCraneUrdf).find("<sphere radius=\"0.06\"/>"),
                                        23, "<mesh filename=\"package://crane/hook.obj\"/>");
  folder_.Write("in/crane.urdf", mesh);
  ExpectRefused({"crane.urdf:7", "link 'hook'", "package://crane/hook.obj"});
  flags_.without_spheres = true;
  ExpectRefused({"crane.urdf:7", "link 'hook'", "package://crane/hook.obj"});

  Spheres("links: {hook: [{center: [0, 0, 0], radius: 0.1}]}");
  flags_.without_spheres = false;
  flags_.replace = true;
  EXPECT_THAT(Make(), AllOf(HasSubstr("1 mesh file missing"), HasSubstr("hook.obj")));

  folder_.Write("in/crane/hook.obj", MeshAsObj(TorusMesh(0.1, 0.03, 20, 10)));
  flags_.spheres.clear();
  EXPECT_THAT(Make(), AllOf(HasSubstr("1 mesh file copied"),
                            HasSubstr("meshes, boxes and cylinders of 4 links")));
  EXPECT_TRUE(std::filesystem::exists(flags_.out / "crane/hook.obj"));
  const Robot robot = LoadRobot(flags_.out);
  for (const double angle : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    const Eigen::Vector3d p(0.125 * std::cos(angle), 0.125 * std::sin(angle), 0);
    EXPECT_TRUE(std::any_of(robot.spheres.begin(), robot.spheres.end(), [&](const LinkSphere& s) {
      return s.link == robot.model.FindLink("hook") && (p - s.p_LS).norm() <= s.radius;
    }));
  }
}

// The crane with a mesh of that name for its hook and another for its base.
std::string MeshCrane(const std::string& hook, const std::string& base) {
  std::string urdf = kCraneUrdf;
  const auto replace = [&](const std::string& shape, const std::string& mesh) {
    urdf.replace(urdf.find(shape), shape.size(), "<mesh filename=\"" + mesh + "\"/>");
  };
  replace("<sphere radius=\"0.06\"/>", hook);
  replace("<box size=\"0.4 0.4 0.2\"/>", base);
  return urdf;
}

TEST_F(MakeRobotTest, AWrittenFolderCanBeMovedWhateverTheUrdfCallsItsMeshes) {
  namespace fs = std::filesystem;
  flags_.without_spheres = true;
  const fs::path outer = folder_.path() / "pkg";
  const std::string hook = MeshAsObj(TorusMesh(0.1, 0.03, 20, 10));
  const std::string base = MeshAsObj(TorusMesh(0.2, 0.05, 20, 10));
  const std::vector<std::pair<std::string, std::string>> names = {
      {"../meshes/a.obj", "../meshes/base/a.obj"},
      {"package://pkg/meshes/a.obj", (outer / "meshes/base/a.obj").string()},
      {"file://" + (outer / "meshes/a.obj").string(), "package://pkg/meshes/base/a.obj"},
      {"package://pkg/meshes/sp%20ace&amp;.obj", "../meshes/base/a.obj"},
      {"meshes/a.obj", "../meshes/base/a.obj"}};
  for (const auto& [of_hook, of_base] : names) {
    SCOPED_TRACE(of_hook);
    folder_.Write("pkg/meshes/a.obj", hook);
    folder_.Write("pkg/meshes/sp ace&.obj", hook);
    folder_.Write("pkg/urdf/meshes/a.obj", hook);
    folder_.Write("pkg/meshes/base/a.obj", base);
    flags_.urdf = folder_.Write("pkg/urdf/crane.urdf", MeshCrane(of_hook, of_base));
    Make();
    fs::rename(flags_.out, folder_.path() / "moved");
    fs::remove_all(outer);
    const Robot robot = LoadRobot(folder_.path() / "moved");
    const auto text_of = [&](const char* link) {
      const auto& shape = robot.model.links()[robot.model.FindLink(link)].collision[0].shape;
      return ReadText(robot.resources.Resolve(std::get<Mesh>(shape).resource));
    };
    EXPECT_EQ(text_of("hook"), hook);
    EXPECT_EQ(text_of("base"), base);
    fs::remove_all(folder_.path() / "moved");
  }
}

TEST_F(MakeRobotTest, FilesOfTheUrdfsOwnFolderAreKept) {
  flags_.without_spheres = true;
  const std::string hook = MeshAsObj(TorusMesh(0.1, 0.03, 20, 10));
  folder_.Write("else/a.obj", hook);
  folder_.Write("in/meshes/a.obj", "another");
  folder_.Write("in/base.obj", hook);
  const std::string urdf = MeshCrane("../else/a.obj", "base.obj");
  flags_.urdf = folder_.Write("in/crane.urdf", urdf);
  flags_.out = folder_.path() / "in";
  ExpectInputError([&] { MakeSilently(); }, {"in/crane.urdf", "written over", "--out"});
  EXPECT_EQ(ReadText(flags_.urdf), urdf);
  flags_.name = "crane2";
  EXPECT_THAT(Make(), AllOf(HasSubstr("2 mesh files copied"),
                            HasSubstr("../else/a.obj is meshes/a_2.obj in the URDF")));
  EXPECT_EQ(ReadText(flags_.urdf), urdf);
  EXPECT_EQ(ReadText(flags_.out / "meshes/a.obj"), "another");
  EXPECT_EQ(ReadText(flags_.out / "meshes/a_2.obj"), hook);
}

TEST_F(MakeRobotTest, ShapesInMillimetresAreNamed) {
  std::string urdf = kCraneUrdf;
  urdf.replace(urdf.find("0.06"), 4, "60");
  folder_.Write("in/crane.urdf", urdf);
  EXPECT_THAT(Make(), HasSubstr("link 'hook': a shape is 120 m large"));
}

TEST_F(MakeRobotTest, LinksThatAreOnlyDrawnAreNamed) {
  EXPECT_THAT(Make(), testing::Not(HasSubstr("drawn")));
  std::string urdf = kCraneUrdf;
  const std::string eye = "<link name=\"eye\"/>";
  urdf.replace(
      urdf.find(eye), eye.size(),
      "<link name=\"eye\"><visual><geometry><box size='1 1 1'/></geometry></visual></link>");
  folder_.Write("in/crane.urdf", urdf);
  flags_.replace = true;
  EXPECT_THAT(Make(), HasSubstr("drawn (<visual>) without collision geometry, so that nothing is "
                                "checked against them: eye\n"));
  Spheres("links: {eye: [{center: [0, 0, 0], radius: 0.1}]}");
  EXPECT_THAT(Make(), testing::Not(HasSubstr("drawn")));
}

TEST_F(MakeRobotTest, SizesAreToldWithoutSpheresToo) {
  folder_.Write("in/hook.obj", MeshAsObj(TorusMesh(100, 30, 20, 10)));
  folder_.Write("in/base.obj", MeshAsObj(TorusMesh(0.1, 0.03, 20, 10)));
  folder_.Write("in/crane.urdf", MeshCrane("hook.obj", "base.obj"));
  flags_.without_spheres = true;
  EXPECT_THAT(Make(), HasSubstr("link 'hook', hook.obj: is 260 m large"));
}

TEST_F(MakeRobotTest, SizesAreToldWhereverTheSpheresComeFrom) {
  folder_.Write("in/hook.obj", MeshAsObj(TorusMesh(100, 30, 20, 10)));
  folder_.Write("in/crane.urdf", MeshCrane("hook.obj", "nowhere.obj"));
  Spheres("links: {hook: [{center: [0, 0, 0], radius: 0.1}]}");
  EXPECT_THAT(Make(), AllOf(HasSubstr("link 'hook', hook.obj: is 260 m large"),
                            HasSubstr("1 mesh file missing")));

  folder_.Write("in/base.obj", "no mesh");
  folder_.Write("in/crane.urdf", MeshCrane("hook.obj", "base.obj"));
  Srdf(
      "<robot name='crane'><group name='jib'><joint name='slew'/></group>"
      "<link_sphere_approximation link='hook'><sphere center='0 0 0' radius='0.1'/>"
      "</link_sphere_approximation></robot>");
  flags_.spheres.clear();
  flags_.replace = true;
  EXPECT_THAT(Make(), AllOf(HasSubstr("the SRDF's approximations"),
                            HasSubstr("link 'hook', hook.obj: is 260 m large"),
                            testing::ContainsRegex("crane.urdf:[0-9]+: .*base.obj")));
}

TEST_F(MakeRobotTest, SpheresThatReachFurtherThanAskedAreNamed) {
  folder_.Write("in/crane.urdf",
                "<robot name='crane'><link name='base'><collision><geometry>"
                "<box size='0.2 0.2 0.2'/></geometry></collision></link><link name='mast'/>"
                "<joint name='slew' type='continuous'><parent link='base'/><child link='mast'/>"
                "</joint></robot>");
  EXPECT_THAT(Make(), testing::Not(HasSubstr("further than --protrusion")));
  flags_.protrusion_m = 1e-3;
  flags_.replace = true;
  EXPECT_THAT(Make(), HasSubstr("further than --protrusion 0.001: no link gets more than 100"));
}

TEST_F(MakeRobotTest, SizesAreToldBeforeAnythingIsFitted) {
  folder_.Write("in/hook.obj", MeshAsObj(TorusMesh(100, 30, 20, 10)));
  std::string open_mesh = MeshAsObj(TorusMesh(0.1, 0.03, 20, 10));
  open_mesh.resize(open_mesh.rfind("f "));
  folder_.Write("in/base.obj", open_mesh);
  folder_.Write("in/crane.urdf", MeshCrane("hook.obj", "base.obj"));
  std::vector<std::string> told;
  const auto say = [&](const std::string& line) {
    if (line.starts_with("link '")) told.push_back(line);
    if (line.find("holes are filled") != std::string::npos) throw InputError("enough");
  };
  ExpectInputError([&] { MakeRobot(flags_, say); }, {"enough"});
  EXPECT_THAT(told, testing::ElementsAre(HasSubstr("link 'hook', hook.obj: is 260 m large"),
                                         HasSubstr("link 'base', base.obj: small holes")));
}

}  // namespace
}  // namespace planbench
