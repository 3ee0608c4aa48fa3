#include "robot_tools/make_spheres.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/read_text.h"
#include "robot_model/link_spheres.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/generated_meshes.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr char kRingerUrdf[] = R"(<robot name="ringer">
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual>
    <collision><geometry><mesh filename="package://parts/ring.obj" scale="0.5 0.5 0.5"/></geometry></collision>
    <collision><origin xyz="0 0 0.2"/><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="bare"/>
  <link name="arm"><collision><origin xyz="0.2 0 0" rpy="0 1.5 0"/><geometry>
    <cylinder radius="0.05" length="0.3"/></geometry></collision></link>
  <joint name="j" type="continuous"><parent link="base"/><child link="arm"/></joint>
  <joint name="k" type="fixed"><parent link="arm"/><child link="bare"/></joint>
</robot>)";

class MakeSpheresTest : public testing::Test {
 protected:
  MakeSpheresTest() {
    Ring(TorusMesh(0.3, 0.1, 30, 20));
    flags_.urdf = folder_.Write("ringer.urdf", kRingerUrdf);
    flags_.outer = folder_ / "outer.yaml";
    flags_.spheres = 12;
  }
  void Ring(const TriangleMesh& mesh) { folder_.Write("parts/ring.obj", MeshAsObj(mesh)); }
  std::string Make() {
    std::string report;
    MakeSpheres(flags_, [&](const std::string& line) { report += line + "\n"; });
    return report;
  }
  std::vector<LinkSphere> Read(const std::filesystem::path& file) {
    return ReadLinkSpheres(file, ReadText(file), RobotModel::FromUrdf(kRingerUrdf, "ringer.urdf"));
  }

  TemporaryFolder folder_;
  MakeSpheresFlags flags_;
};

TEST_F(MakeSpheresTest, WritesOneModelInThreeForms) {
  flags_.srdf = folder_ / "spheres.srdf";
  flags_.urdf_out = folder_ / "spheres.urdf";
  flags_.inner = folder_ / "inner.yaml";
  const std::string report = Make();
  EXPECT_THAT(report, AllOf(HasSubstr("base"), HasSubstr("arm"), HasSubstr("all")));
  EXPECT_THAT(report, Not(HasSubstr("ring.obj"))) << "nothing is odd about it";
  const std::vector<LinkSphere> outer = Read(flags_.outer);
  EXPECT_EQ(outer.size(), 12u);
  for (const auto& file : {flags_.srdf, flags_.urdf_out}) {
    const std::vector<LinkSphere> same = Read(file);
    ASSERT_EQ(same.size(), outer.size());
    for (std::size_t i = 0; i < same.size(); ++i) {
      EXPECT_EQ(same[i].link, outer[i].link);
      EXPECT_EQ(same[i].p_LS, outer[i].p_LS);
      EXPECT_EQ(same[i].radius, outer[i].radius);
    }
  }
  EXPECT_THAT(ReadText(flags_.urdf_out), AllOf(HasSubstr("visual"), Not(HasSubstr("mesh"))));
  EXPECT_GT(Read(flags_.inner).size(), 2u);
}

TEST_F(MakeSpheresTest, ScaleAndOriginsCount) {
  Make();
  std::mt19937_64 random(1);
  const TriangleMesh ring = TorusMesh(0.15, 0.05, 30, 20);
  const std::vector<LinkSphere> outer = Read(flags_.outer);
  const auto in_one = [&](int link, const Vector3d& p) {
    return std::any_of(outer.begin(), outer.end(), [&](const LinkSphere& sphere) {
      return sphere.link == link && (p - sphere.p_LS).norm() <= sphere.radius + 1e-6;
    });
  };
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(in_one(0, RandomSurfacePoint(ring, &random)));
  const Vector3d along(std::sin(1.5), 0, std::cos(1.5));
  for (const double s : {-0.15, 0.0, 0.15}) {
    EXPECT_TRUE(in_one(1, Vector3d(0.2, 0, 0) + s * along)) << "links are numbered as a tree";
  }
  for (const LinkSphere& sphere : outer) EXPECT_LT(sphere.p_LS.norm() + sphere.radius, 0.5);
}

TEST_F(MakeSpheresTest, NamesWhatIsOddAboutMeshes) {
  flags_.spheres = 3;
  TriangleMesh ring = TorusMesh(0.3, 0.1, 30, 20);
  TriangleMesh odd = ring;
  odd.triangles.pop_back();
  Ring(odd);
  EXPECT_THAT(Make(),
              HasSubstr("link 'base', package://parts/ring.obj: small holes are filled (1)"));
  Ring(TurnedInsideOut(ring));
  EXPECT_THAT(Make(), HasSubstr("inside out"));
  std::swap(ring.triangles[0][0], ring.triangles[0][1]);
  Ring(ring);
  EXPECT_THAT(Make(), HasSubstr("1 of 1 parts disagree"));
  Ring(SheetMesh(0.1, 0.1, 5, 5));
  EXPECT_THAT(Make(), HasSubstr("not closed"));
  Ring(Joined(SheetMesh(0.1, 0.1, 5, 5), SphereMesh(0.1, 10, 10), {1, 0, 0}));
  EXPECT_THAT(Make(), HasSubstr("1 of 2 parts are not closed"));
  Ring(TorusMesh(300, 100, 30, 20));
  EXPECT_THAT(Make(), HasSubstr("is 400 m large"));
}

TEST_F(MakeSpheresTest, ALinkMayHaveAProtrusionOfItsOwn) {
  const auto counts = [&] {
    Make();
    std::pair<int, int> on_base_and_arm = {0, 0};
    for (const LinkSphere& sphere : Read(flags_.outer)) {
      ++(sphere.link == 0 ? on_base_and_arm.first : on_base_and_arm.second);
    }
    return on_base_and_arm;
  };
  flags_.spheres = 0;
  flags_.protrusion_m = 0.06;
  const auto before = counts();
  flags_.links = {"arm=0.035"};
  const auto after = counts();
  EXPECT_EQ(after.first, before.first);
  EXPECT_GT(after.second, before.second);
  for (const auto& [flag, fault] : std::vector<std::pair<std::string, std::string>>{
           {"leg=0.1", "no link 'leg'"},
           {"bare=0.1", "no link 'bare' with collision geometry"},
           {"arm=much", "'much' is no length"},
           {"arm=-1", "'-1' is no length"},
           {"arm", "NAME=M"}}) {
    flags_.links = {flag};
    ExpectInputError([&] { Make(); }, {"--link", fault});
  }
}

TEST_F(MakeSpheresTest, RefusesInOneLine) {
  flags_.spheres = 2;
  ExpectInputError([&] { Make(); }, {"2 spheres", "3 at least"});
  flags_.spheres = 5;
  folder_.Write("parts/ring.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n");
  ExpectInputError([&] { Make(); }, {"ringer.urdf:2", "link 'base'", "ring.obj"});
  folder_.Write("parts/ring.obj", "v 0 0 0\n");
  ExpectInputError([&] { Make(); }, {"link 'base'", "ring.obj"});
  folder_.Write("ringer.urdf", "<robot name='bare'><link name='base'/></robot>");
  ExpectInputError([&] { Make(); }, {"ringer.urdf", "no link has collision geometry"});
  EXPECT_FALSE(std::filesystem::exists(flags_.outer)) << "something was written";
  flags_.outer = folder_ / "no/folder.yaml";
  folder_.Write("ringer.urdf", kRingerUrdf);
  Ring(TorusMesh(0.3, 0.1, 30, 20));
  ExpectInputError([&] { Make(); }, {"cannot write", "no/folder.yaml: No such file or directory"});
}

}  // namespace
}  // namespace planbench
