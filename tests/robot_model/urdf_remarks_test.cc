#include "robot_model/urdf_remarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> Remarks(const std::string& elements) {
  return RemarkUnheeded("<robot name='r'>\n" + elements + "</robot>", "r.urdf");
}

TEST(UrdfRemarks, MisspeltNamesAreRemarkedWithTheOneThatIsMeant) {
  EXPECT_THAT(
      Remarks("<Link name='x'/>\n<link name='b'><Collision><geomtry/></Collision></link>\n"
              "<joint name='j'><Axis xyz='0 1 0'/>\n<limit lower='0' uper='1'/></joint>"),
      ElementsAre(
          "r.urdf:2: <Link> is unknown and does not count; is it <link>?",
          "r.urdf:3: link 'b': <Collision> is unknown and does not count; is it <collision>?",
          "r.urdf:4: joint 'j': <Axis> is unknown and does not count; is it <axis>?",
          "r.urdf:5: joint 'j': <limit>: the attribute uper is unknown and does not count; is it "
          "upper?"));
  EXPECT_THAT(Remarks("<link name='b'><collision><geometry><mesh filename='a.stl' scales='1 1 1'/>"
                      "</geometry><orgin/></collision></link>"),
              testing::SizeIs(2));
}

TEST(UrdfRemarks, WhatOtherToolsWriteIsNotRemarked) {
  EXPECT_THAT(
      Remarks("<material name='m'><color rgba='1 1 1 1'/></material>"
              "<link name='a' type='laser'><self_collision_checking/><collision_checking/>"
              "<contact><lateral_friction value='1'/></contact><visual><Origin/></visual>"
              "<inertial><orgin/></inertial><drake:collision/>"
              "<collision group='g'><verbose value='1'/></collision></link>"
              "<joint name='j' type='fixed' drake:types='x'><dynamics damping='1'/>"
              "<calibration rising='0'/><hardwareInterface/><limit acceleration='1' jerk='1'/>"
              "</joint><transmission name='t'><Joint/></transmission><gazebo><limits/></gazebo>"),
      IsEmpty());
}

TEST(UrdfRemarks, AxesOfPlanarJointsAreRemarkedWhereTheyAreNotZ) {
  const auto planar = [](const std::string& axis) {
    return Remarks("<joint name='p' type='planar'>" + axis + "</joint>");
  };
  EXPECT_THAT(planar("\n<axis xyz='0 1 0'/>"),
              ElementsAre("r.urdf:3: joint 'p': <axis>: does not count; a planar joint moves along "
                          "x and y of its frame and turns about z, as in MoveIt"));
  EXPECT_THAT(planar("<axis xyz='0 0 1'/>"), IsEmpty());
  EXPECT_THAT(planar("<axis xyz='0 0 -2'/>"), IsEmpty());
  EXPECT_THAT(planar(""), IsEmpty());
}

TEST(UrdfRemarks, AnglesOfOriginsThatAreProbablyInDegreesAreNamedOnce) {
  EXPECT_THAT(Remarks("<link name='a'><visual><origin rpy='90 0 0'/></visual><collision>\n"
                      "<origin rpy='0 -6.2832 3.14'/></collision></link>\n"
                      "<joint name='j'><origin xyz='9 9 9'/></joint>"),
              IsEmpty());
  EXPECT_THAT(Remarks("<link name='a'><collision>\n<origin rpy='0 -90 0'/></collision></link>"
                      "<joint name='j'><origin rpy='0 0 45'/></joint>"
                      "<joint name='k'><origin rpy='180 0 45'/></joint>"),
              ElementsAre("r.urdf:3: link 'a': <origin>: rpy turns by -90 rad; are those degrees? "
                          "URDFs are in radians; likewise 2 more"));
}

TEST(UrdfRemarks, AreAmongTheWarningsOfTheModel) {
  std::vector<std::string> warnings;
  RobotModel::FromUrdf("<robot name='r'><link name='a'><Collision/></link></robot>", "r.urdf",
                       &warnings);
  EXPECT_THAT(warnings, ElementsAre(testing::HasSubstr("r.urdf:1: link 'a': <Collision>")));
}

}  // namespace
}  // namespace planbench
