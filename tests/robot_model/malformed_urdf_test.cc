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

// Two revolute joints in a row, `j` on line 2 and `k` on line 3, with more elements inside.
std::string WithChain(const std::string& of_j, const std::string& of_k,
                      const std::string& more = "") {
  const std::string limit = "<limit lower='0' upper='1' velocity='1' effort='1'/>";
  return "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>\n"
         "<joint name='j' type='revolute'><parent link='a'/><child link='b'/>" +
         limit + of_j +
         "</joint>\n<joint name='k' type='revolute'><parent link='b'/><child link='c'/>" + limit +
         of_k + "</joint>" + more + "</robot>";
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
    {"Empty", "", {"not a valid URDF", "no XML element"}},
    {"NoXml", "robot: r", {"not a valid URDF", "no XML element"}},
    {"CutOff", "<robot name='r'><link name='a'>", {":1:", "<link> is not closed"}},
    {"NoRobot",
     "<!-- A model. -->\n<model name='r'/>",
     {":2:", "not a valid URDF", "<model>", "<robot>"}},
    {"NoName",
     "<!-- A model. -->\n<robot><link name='a'/></robot>",
     {":2:", "<robot> has no name"}},
    {"BadVersion",
     "<?xml version='1.0'?>\n<robot name='r' version='one'><link name='a'/></robot>",
     {":2:", "version", "1.0, 1.1 or 1.2", "'one'"}},
    {"SecondOutermost",
     "<robot name='r'><link name='a'/></robot>\n<robot name='s'/>",
     {":2:", "<robot> stands after the outermost element"}},
    {"Entities",
     "<?xml version='1.0'?>\n<!-- <!DOCTYPE robot> -->\n<!DOCTYPE robot [\n<!ENTITY h '1'>\n]>"
     "<robot name='r'><link name='a'/></robot>",
     {":3:", "<!DOCTYPE>", "definitions", "not read"}},
    {"TextOfATool",
     "String value is: <?xml version='1.0'?>\n<robot name='r'><link name='a'/></robot>",
     {":1: text stands before the first element: 'String value is: '"}},
    {"YamlBlock",
     "\n# arm\nrobot_description: |\n  <robot name='r'><link name='a'/></robot>",
     {":2: text stands before the first element: '# arm'"}},
    {"TextBehindTheDeclaration",
     "\xef\xbb\xbf<?xml version='1.0'?>\n<!DOCTYPE robot>\x1b[33mwarning\n<robot name='r'/>",
     {":2: text stands before the first element: '\\x1b[33mwarning'"}},
    {"XInclude",
     "<robot name='r' xmlns:xi='http://www.w3.org/2001/XInclude'><link name='a'/>\n"
     "<xi:include href='hand.urdf'/></robot>",
     {":2:", "<xi:include> is not followed", "xmllint --xinclude robots/r.urdf > expanded.urdf"}},
    {"AttributeWithoutValue",
     WithJoint("fixed", "\n<origin xyz='0 0 1' fixed/>"),
     {":3:", "joint 'j'", "<origin>", "found: fixed"}},
    {"AttributeWithoutQuotes",
     WithCollision("<geometry>\n<sphere radius=1/></geometry>"),
     {":4:", "link 'a'", "<sphere>", "NAME=\"VALUE\"", "radius=1"}},
    {"AttributeWithoutSpace",
     WithJoint("fixed", "\n<origin xyz='0 0 1'rpy='0 0 1'/>"),
     {":3:", "joint 'j'", "<origin>", "after a space", "found: rpy="}},
    {"AttributeTwice",
     WithJoint("fixed", "\n<origin xyz='0 0 1' xyz='0 0 2'/>"),
     {":3:", "joint 'j'", "<origin>", "xyz twice"}},
    {"TwoOrientations",
     WithJoint("fixed", "\n<origin rpy='0 0 1' quat_xyzw='0 0 0 1'/>"),
     {":3:", "joint 'j'", "<origin>", "both rpy and quat_xyzw"}},
    {"QuaternionOfThree",
     WithCollision("\n<origin quat_xyzw='0 0 1'/><geometry><sphere radius='1'/></geometry>"),
     {":4:", "link 'a'", "<origin>", "quat_xyzw", "four numbers", "'0 0 1'"}},
    {"ZeroQuaternion",
     WithJoint("fixed", "\n<origin quat_xyzw='0 0 0 0'/>"),
     {":3:", "joint 'j'", "quat_xyzw", "not zero"}},
    {"CapsuleWithoutLength",
     WithCollision("<geometry>\n<capsule radius='1'/></geometry>"),
     {":4:", "link 'a'", "<capsule>", "radius and length"}},
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
     "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
     "<joint name='i' type='fixed'><parent link='b'/><child link='c'/></joint>\n"
     "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>\n"
     "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>",
     {":3:", "joint 'k'", "loop (a, b, a)", "root"}},
    {"LoopOfALink",
     "<robot name='r'><link name='a'/>\n"
     "<joint name='j' type='fixed'><parent link='a'/><child link='a'/></joint></robot>",
     {":2:", "joint 'j'", "loop (a, a)", "root"}},
    {"LoopBesideTheTree",
     "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><link name='d'/>\n"
     "<joint name='j' type='fixed'><parent link='d'/><child link='b'/></joint>\n"
     "<joint name='k' type='fixed'><parent link='b'/><child link='d'/></joint>\n"
     "<joint name='l' type='fixed'><parent link='d'/><child link='c'/></joint></robot>",
     {":2:", "joint 'j'", "loop (b, d, b)", "tree"}},
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
    {"MimicOfNone",
     WithJoint("revolute", std::string(kLimit) + "<mimic joint='other'/>"),
     {":2:", "joint 'j'", "mimic", "'other' is unknown"}},
    {"MimicOfItself",
     WithJoint("revolute", std::string(kLimit) + "<mimic joint='j'/>"),
     {":2:", "joint 'j'", "mimic", "circle: j, j"}},
    {"MimicInACircle",
     WithChain("<mimic joint='k'/>", "<mimic joint='j'/>"),
     {":2:", "joint 'j'", "mimic", "circle: j, k, j"}},
    {"MimicOfAPose",
     WithChain("<mimic joint='f'/>", "",
               "<link name='d'/><joint name='f' type='floating'>"
               "<parent link='a'/><child link='d'/></joint>"),
     {":2:", "joint 'j'", "mimic", "'f' has a pose"}},
    {"FloatingMimic",
     WithChain("", "",
               "<link name='d'/>\n<joint name='f' type='floating'>"
               "<parent link='a'/><child link='d'/><mimic joint='j'/></joint>"),
     {":4:", "joint 'f'", "mimic"}},
    {"MimicByNoNumber",
     WithJoint("revolute", std::string(kLimit) + "<mimic joint='j' multiplier='much'/>"),
     {":2:", "[j]", "mimic"}},
    {"SoftLimitsOutside",
     WithJoint("revolute", std::string(kLimit) +
                               "<safety_controller soft_lower_limit='2' soft_upper_limit='3' "
                               "k_velocity='1'/>"),
     {":2:", "joint 'j'", "safety_controller", "[2, 3] lie outside the limits [0, 1]"}},
    {"SoftLimitOfOneSideOutside",
     WithJoint("revolute",
               std::string(kLimit) + "<safety_controller soft_upper_limit='-1' k_velocity='1'/>"),
     {":2:", "joint 'j'", "safety_controller", "[-inf, -1] lie outside the limits [0, 1]"}},
    {"SoftLowerAboveUpper",
     WithJoint("revolute", std::string(kLimit) +
                               "<safety_controller soft_lower_limit='0.5' soft_upper_limit='0.2' "
                               "k_velocity='1'/>"),
     {":2:", "joint 'j'", "safety_controller", "0.5", "0.2"}},
    {"XacroCall",
     "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'><link name='a'/>\n"
     "<xacro:gripper parent='a'/></robot>",
     {":2:", "<xacro:gripper>", "not expanded", "xacro robots/r.urdf > "}},
    {"XacroInside",
     "<robot name='r'><link name='a'>\n\n<xacro:body/></link></robot>",
     {":3:", "<xacro:body>", "not expanded"}},
    {"XacroExpression",
     "<robot name='r'>\n<link name='${prefix}a'/></robot>",
     {":2:", "<link>", "'${prefix}'", "not expanded"}},
    {"XacroFind",
     WithCollision("<geometry>\n<mesh filename='file://$(find arm)/hand.stl'/></geometry>"),
     {":4:", "link 'a'", "'$(find arm)'", "not expanded"}},
    {"OldXacro",
     "<robot name='r'><link name='a'/>\n<include filename='b.xacro'/></robot>",
     {":2:", "<include>", "not expanded"}},
    {"XacroOfAnotherPrefix",
     "<robot name='r' xmlns:xa = \"http://www.ros.org/wiki/xacro\"><link name='a'/>\n"
     "<xa:big_gripper/></robot>",
     {":2:", "<xa:big_gripper>", "not expanded"}},
    {"XacroThatTellsItsPrefix",
     "<robot name='r'><link name='a'/>\n<x:arm xmlns:x='http://ros.org/wiki/xacro'/></robot>",
     {":2:", "<x:arm>", "not expanded"}},
    {"XacroWithoutAPrefix",
     "<robot name='r'><link name='a'/>\n<arm xmlns='http://wiki.ros.org/xacro'/></robot>",
     {":2:", "<arm>", "not expanded"}},
    {"XacroAttribute",
     "<robot name='r'>\n<link name='a' xacro:if='0'/></robot>",
     {":2:", "<link>", "xacro:if", "not expanded"}},
    {"XacroAttributeOfAnotherPrefix",
     "<robot name='r' xmlns:xa='http://www.ros.org/wiki/xacro'><link name='a'>\n"
     "<visual xa:unless='1'/></link></robot>",
     {":2:", "link 'a'", "<visual>", "xa:unless", "not expanded"}},
    {"NameIsNoUtf8",
     "<robot name='r'>\n<link name='caf\xe9'/></robot>",
     {":2:", "<link>", "\\xe9", "UTF-8"}},
    {"NameTurnsDirection",
     "<robot name='r'>\n<link name='a\xe2\x80\xae'/></robot>",
     {":2:", "<link>", "control character", "name='a\\xe2\\x80\\xae'"}},
    {"NameRefersToACharacter",
     "<robot name='r'><link name='a'/>\n<joint name='j&#x202e;'/></robot>",
     {":2:", "<joint>", "'j&#x202e;'", "references to characters"}},
    {"NameOfTwoLines",
     "<robot name='r'>\n<link name='a\nb'/></robot>",
     {":2:", "<link>", "'a\\nb'", "one line"}},
    {"ControlCharacterInAReference",
     "<robot name='r'><link name='a'/>\n<joint name='j'>\n<parent "
     "link='a\x1b[2J'/></joint></robot>",
     {":3:", "<parent>", "control character", "\\x1b[2J"}},
    {"NameOfTheRobotInXacro",
     "\n<robot name='$(arg name)'><link name='a'/></robot>",
     {":2:", "<robot>", "'$(arg name)'", "not expanded"}},
    {"NamelessJoint",
     "<robot name='r'><link name='a'/><link name='b'/>\n"
     "<joint name='' type='fixed'><parent link='a'/><child link='b'/></joint></robot>",
     {":2:", "<joint>", "no name"}},
    {"NamelessLink", "<robot name='r'>\n<link name=''/></robot>", {":2:", "<link>", "no name"}},
    {"LinkThatHasNoName", "<robot name='r'>\n<link/></robot>", {":2:", "<link>", "no name"}},
    {"MaterialTwice",
     "<robot name='r'><link name='a'/><material name='m'><color rgba='1 1 1 1'/></material>\n"
     "<material name='m'><color rgba='1 1 1 1'/></material></robot>",
     {":2:", "'m'", "unique"}},
    {"ColorOfAMaterial",
     "<robot name='r'><link name='a'><visual><geometry><sphere radius='1'/></geometry>\n"
     "<material name='m'><color rgba='255 255 255 1'/></material></visual></link></robot>",
     {":2:", "[m]", "color"}},
    {"ClosedInDisorder",
     "<robot name='r'>\n<link name='a'>\n</robot>",
     {":3:", "</robot>", "<link> of line 2"}},
    {"NeverClosed",
     "<robot name='r'>\n<link name='a'>\n<visual/></link>\n<link name='b'>",
     {":4:", "<link> is not closed"}},
    {"UnknownType", WithJoint("screw", ""), {":2:", "[j]", "screw"}},
    {"RevoluteWithoutLimit", WithJoint("revolute", ""), {":2:", "[j]", "limits"}},
    {"PrismaticWithoutLimit", WithJoint("prismatic", ""), {":2:", "[j]", "limits"}},
    {"LowerAboveUpper",
     WithJoint("revolute", "<limit lower='1' upper='0.5' velocity='1' effort='1'/>"),
     {":2:", "joint 'j'", "limit", "lower 1 ", "upper 0.5"}},
    {"LimitNoNumber",
     WithJoint("revolute", "<limit lower='low' upper='1' velocity='1' effort='1'/>"),
     {":2:", "[j]", "lower", "low"}},
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
    {"EmptyCollision", WithCollision(""), {":3:", "[a]", "collision"}},
    {"UnknownGeometry", WithCollision("<geometry><torus/></geometry>"), {":3:", "[a]", "torus"}},
    {"SphereWithoutRadius",
     WithCollision("<geometry><sphere/></geometry>"),
     {":3:", "[a]", "radius"}},
    {"NegativeSphere",
     WithCollision("<geometry><sphere radius='-1'/></geometry>"),
     {":3:", "link 'a'", "sphere radius", "-1"}},
    {"FlatBox",
     WithCollision("<geometry><box size='1 0 1'/></geometry>"),
     {":3:", "link 'a'", "box size"}},
    {"FlatCylinder",
     WithCollision("<geometry><cylinder radius='1' length='0'/></geometry>"),
     {":3:", "link 'a'", "cylinder length"}},
    {"TwoShapesInOneGeometry",
     WithCollision("<geometry><box size='1 1 1'/>\n<sphere radius='1'/></geometry>"),
     {":4:", "link 'a'", "<geometry>", "<box> and <sphere>", "<collision> of its own"}},
    {"TwoGeometriesInOneCollision",
     WithCollision("<geometry><sphere radius='1'/></geometry>\n"
                   "<geometry><sphere radius='2'/></geometry>"),
     {":4:", "link 'a'", "<collision>", "<geometry>", "<collision> of its own"}},
    {"TwoOriginsOfACollision",
     WithCollision("<origin/>\n<origin xyz='0 0 1'/><geometry><sphere radius='1'/></geometry>"),
     {":4:", "link 'a'", "<origin>", "one"}},
    {"TwoLimits",
     WithJoint("revolute", std::string(kLimit) + "\n" + kLimit),
     {":3:", "joint 'j'", "<limit>", "one"}},
    {"TwoAxes", WithJoint("fixed", "<axis xyz='1 0 0'/><axis xyz='0 1 0'/>"), {":2:", "<axis>"}},
    {"JointWithoutType",
     "<robot name='r'><link name='a'/><link name='b'/>\n"
     "<joint name='j'><parent link='a'/><child link='b'/></joint></robot>",
     {":2:", "[j]", "type"}},
    {"Utf16",
     std::string("\xff\xfe<\0r\0", 6),
     {"UTF-16", "iconv -f UTF-16 -t UTF-8 robots/r.urdf"}},
    {"Utf16WithoutMark", std::string("\0<\0r\0o", 6), {"iconv -f UTF-16BE"}},
    {"HugeSphere",
     WithCollision("<geometry><sphere radius='1e5'/></geometry>"),
     {":3:", "link 'a'", "sphere radius", "100000 m", "metres"}},
    {"HugeCollisionOrigin",
     WithCollision("<origin xyz='0 -1e12 0'/><geometry><sphere radius='1'/></geometry>"),
     {":3:", "link 'a'", "collision origin", "1e+12 m", "metres"}},
    {"HugeOrigin",
     WithJoint("fixed", "<origin xyz='1e308 0 0'/>"),
     {":2:", "joint 'j'", "origin", "1e+308 m", "metres"}},
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
  EXPECT_NO_THROW(RobotModel::FromUrdf(WithJoint("floating", "<axis xyz='0 0 0'/>"), "r"));
  EXPECT_NO_THROW(RobotModel::FromUrdf(WithJoint("planar", ""), "r"));
}

TEST(UrdfText, CommentsAndOtherToolsElementsMayHoldAnything) {
  EXPECT_NO_THROW(RobotModel::FromUrdf(
      "<?xml version='1.0'?>\n<!-- caf\xe9 <xacro:gripper/> ${prefix} <link> -->\n"
      "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n"
      "<gazebo><plugin file='$(find x)/y'><a>1 &lt; 2</a></plugin></gazebo>\n"
      "<link name='a > b'><visual><geometry><sphere radius='1'/></geometry></visual></link>\n"
      "</robot>\n",
      "r"));
}

TEST(UrdfText, SeveralCollisionsAndElementsOfOtherToolsAreFine) {
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='r'><link name='a'>"
      "<visual><geometry><box size='1 1 1'/></geometry></visual>"
      "<collision><geometry><sphere radius='1'/><drake:capsule/></geometry></collision>"
      "<collision><geometry><sphere radius='2'/></geometry></collision></link>"
      "<transmission name='t'><joint name='j'/><limit/><limit/></transmission></robot>",
      "r");
  EXPECT_EQ(model.links()[0].collision.size(), 2u);
}

TEST(UrdfText, NamesMayHoldWhatXmlWritesAsEntities) {
  const auto joint = [](const std::string& name, const std::string& child) {
    return "<joint name='" + name + "' type='revolute'><parent link='a'/><child link='" + child +
           "'/>" + kLimit + "<safety_controller k_velocity='1' soft_lower_limit='0' " +
           "soft_upper_limit='0.5'/></joint>";
  };
  const RobotModel model = RobotModel::FromUrdf(
      "<robot name='r'><link name='a'/>\n<link name='b&amp;c'><collision><geometry>"
      "<capsule radius='0.1' length='1'/></geometry></collision></link><link name='d'/>\n" +
          joint("j&lt;&quot;&apos;&gt;", "b&amp;c") + joint("k", "d") + "</robot>",
      "r");
  ASSERT_EQ(model.joints().size(), 2u);
  EXPECT_EQ(model.joints()[0].name, "j<\"'>");
  EXPECT_EQ(model.joints()[0].where, "r:3: joint 'j<\"'>'");
  EXPECT_EQ(model.joints()[0].upper, 0.5);
  EXPECT_EQ(model.links()[1].where, "r:2: link 'b&c'");
  EXPECT_EQ(model.links()[1].collision.size(), 3u);
}

TEST(UrdfText, TheHintToExpandXacroNamesAFileOfTheSameKind) {
  const auto expect = [](const std::string& file, const std::string& command) {
    ExpectInputError([&] { RobotModel::FromUrdf("<robot><xacro:arm/></robot>", file); },
                     {file + ":1:", "expand the file first: " + command});
  };
  expect("in/arm.srdf.xacro", "xacro in/arm.srdf.xacro > in/arm.srdf");
  expect("arm.urdf.xacro", "xacro arm.urdf.xacro > arm.urdf");
  expect("arm.srdf", "xacro arm.srdf > expanded.srdf");
  expect("arm.xacro", "xacro arm.xacro > expanded.xml");
}

}  // namespace
}  // namespace planbench
