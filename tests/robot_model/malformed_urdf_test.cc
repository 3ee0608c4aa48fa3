#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "robot_model/robot_model.h"
#include "tests/support/expect_input_error.h"

// Read by LeakSanitizer. urdfdom's links own their children: those of a loop own each other, and
// are lost where urdfdom itself gives the model up.
extern "C" const char* __lsan_default_suppressions() { return "leak:liburdfdom_model"; }

namespace planbench {
namespace {

// Joint `j` of the given type from link a to link b, on line 2 of the text, with more elements
// inside.
std::string WithJoint(const std::string& type, const std::string& elements) {
  return "<robot name='r'><link name='a'/><link name='b'/>\n<joint name='j' type='" + type +
         "'><parent link='a'/><child link='b'/>" + elements + "</joint></robot>";
}

std::string WithCollision(const std::string& elements) {
  return "<robot name='r'>\n\n<link name='a'><collision>" + elements +
         "</collision></link></robot>";
}

constexpr char kLimit[] = "<limit lower='0' upper='1' velocity='1' effort='1'/>";

struct MalformedUrdf {
  std::string name;
  std::string text;
  std::vector<std::string> message;  // Parts of it, besides the file's name.
};

void PrintTo(const MalformedUrdf& malformed, std::ostream* out) { *out << malformed.name; }

class MalformedUrdfTest : public testing::TestWithParam<MalformedUrdf> {};

TEST_P(MalformedUrdfTest, IsRefusedByName) {
  std::vector<std::string> parts = GetParam().message;
  parts.push_back("robots/r.urdf:");
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  ExpectInputError([] { RobotModel::FromUrdf(GetParam().text, "robots/r.urdf"); }, parts);
  // The parser's own reports belong in the message, not on the terminal.
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

const MalformedUrdf kMalformed[] = {
    {"Empty", "", {"not a valid URDF"}},
    {"NoXml", "robot: r", {"not a valid URDF"}},
    {"CutOff", "<robot name='r'><link name='a'>", {"not a valid URDF"}},
    {"NoRobot", "<model name='r'/>", {"not a valid URDF"}},
    {"NoName", "<robot><link name='a'/></robot>", {"name"}},
    {"BadVersion", "<robot name='r' version='one'><link name='a'/></robot>", {"version"}},
    {"NoLinks", "<robot name='r'/>", {"No link elements"}},
    {"RepeatedLink", "<robot name='r'><link name='a'/><link name='a'/></robot>", {"'a'", "unique"}},
    {"RepeatedJoint",
     "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
     "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
     "<joint name='j' type='fixed'><parent link='a'/><child link='c'/></joint></robot>",
     {"'j'", "unique"}},
    {"TwoRoots",
     "<robot name='r'><link name='a'/><link name='b'/></robot>",
     {"[a]", "[b]", "root"}},
    {"Loop",
     "<robot name='r'><link name='a'/><link name='b'/>"
     "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
     "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>",
     {"root"}},
    {"LoopBesideTheTree",
     "<robot name='r'><link name='a'/>\n<link name='b'/><link name='c'/>"
     "<joint name='j' type='fixed'><parent link='b'/><child link='c'/></joint>"
     "<joint name='k' type='fixed'><parent link='c'/><child link='b'/></joint></robot>",
     {":2:", "link 'b'", "not connected"}},
    {"TwoParents",
     "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
     "<joint name='i' type='fixed'><parent link='a'/><child link='b'/></joint>\n"
     "<joint name='j' type='fixed'><parent link='a'/><child link='c'/></joint>\n"
     "<joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint></robot>",
     {":3:", "joint 'k'", "'c'", "'j'", "tree"}},
    {"UnknownChild",
     "<robot name='r'><link name='a'/>"
     "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint></robot>",
     {"[j]", "[b]"}},
    {"Mimic",
     WithJoint("revolute", std::string(kLimit) + "<mimic joint='other'/>"),
     {":2:", "joint 'j'", "mimic"}},
    {"Floating", WithJoint("floating", ""), {":2:", "joint 'j'", "floating"}},
    {"Planar", WithJoint("planar", ""), {":2:", "joint 'j'", "planar"}},
    {"UnknownType", WithJoint("screw", ""), {"[j]", "screw"}},
    {"RevoluteWithoutLimit", WithJoint("revolute", ""), {"[j]", "limits"}},
    {"PrismaticWithoutLimit", WithJoint("prismatic", ""), {"[j]", "limits"}},
    {"LowerAboveUpper",
     WithJoint("revolute", "<limit lower='1' upper='0.5' velocity='1' effort='1'/>"),
     {":2:", "joint 'j'", "limit", "lower 1 ", "upper 0.5"}},
    {"LimitNoNumber",
     WithJoint("revolute", "<limit lower='low' upper='1' velocity='1' effort='1'/>"),
     {"[j]", "lower", "low"}},
    {"LimitNan",
     WithJoint("revolute", "<limit lower='nan' upper='1' velocity='1' effort='1'/>"),
     {"[j]", "lower"}},
    {"NegativeVelocity",
     WithJoint("revolute", "<limit lower='0' upper='1' velocity='-1' effort='1'/>"),
     {":2:", "joint 'j'", "velocity"}},
    {"ZeroAxis",
     WithJoint("revolute", std::string(kLimit) + "<axis xyz='0 0 0'/>"),
     {":2:", "joint 'j'", "axis"}},
    {"ShortOrigin", WithJoint("fixed", "<origin xyz='1 2'/>"), {"[j]", "origin"}},
    {"EmptyCollision", WithCollision(""), {"[a]", "collision"}},
    {"UnknownGeometry", WithCollision("<geometry><torus/></geometry>"), {"[a]", "torus"}},
    {"SphereWithoutRadius", WithCollision("<geometry><sphere/></geometry>"), {"[a]", "radius"}},
    {"NegativeSphere",
     WithCollision("<geometry><sphere radius='-1'/></geometry>"),
     {":3:", "link 'a'", "sphere radius", "-1"}},
    {"FlatBox",
     WithCollision("<geometry><box size='1 0 1'/></geometry>"),
     {":3:", "link 'a'", "box size"}},
    {"FlatCylinder",
     WithCollision("<geometry><cylinder radius='1' length='0'/></geometry>"),
     {":3:", "link 'a'", "cylinder length"}},
    {"FlatMesh",
     WithCollision("<geometry><mesh filename='a.stl' scale='1 1 0'/></geometry>"),
     {":3:", "link 'a'", "mesh scale"}},
    {"NamelessMesh", WithCollision("<geometry><mesh/></geometry>"), {"[a]", "filename"}},
};

INSTANTIATE_TEST_SUITE_P(Table, MalformedUrdfTest, testing::ValuesIn(kMalformed),
                         [](const auto& test) { return test.param.name; });

TEST(UrdfLimits, ZeroAxesAndMissingLimitsAreFineWhereTheyAreNotUsed) {
  EXPECT_NO_THROW(RobotModel::FromUrdf(WithJoint("fixed", "<axis xyz='0 0 0'/>"), "r"));
  EXPECT_NO_THROW(RobotModel::FromUrdf(WithJoint("continuous", ""), "r"));
}

}  // namespace
}  // namespace planbench
