#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {
namespace {

// Joint `j` with the limits [-1, 2], unless it is continuous, and a safety controller with these
// soft limits.
Joint WithSoftLimits(const std::string& type, const std::string& soft,
                     std::vector<std::string>* warnings) {
  return RobotModel::FromUrdf(
             fmt::format("<robot name='r'><link name='a'/><link name='b'/>"
                         "<joint name='j' type='{}'><parent link='a'/><child link='b'/>"
                         "<limit {} velocity='1' effort='1'/>"
                         "<safety_controller k_velocity='1' {}/></joint></robot>",
                         type, type == "continuous" ? "" : "lower='-1' upper='2'", soft),
             "r.urdf", warnings)
      .joints()[0];
}

struct SoftLimitsCase {
  std::string name;
  std::string type;
  std::string soft;
  double lower;
  double upper;
  std::vector<std::string> warnings;
};
void PrintTo(const SoftLimitsCase& limits, std::ostream* out) { *out << limits.name; }

class SoftLimitsTest : public testing::TestWithParam<SoftLimitsCase> {};

TEST_P(SoftLimitsTest, NarrowTheLimitsOnTheSidesThatAreGiven) {
  std::vector<std::string> warnings;
  const Joint joint = WithSoftLimits(GetParam().type, GetParam().soft, &warnings);
  EXPECT_EQ(joint.lower, GetParam().lower);
  EXPECT_EQ(joint.upper, GetParam().upper);
  EXPECT_EQ(joint.type == JointType::kContinuous, std::isinf(joint.lower));
  EXPECT_EQ(warnings, GetParam().warnings);
}

constexpr double kEndless = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(
    Table, SoftLimitsTest,
    testing::Values(
        SoftLimitsCase{"None", "revolute", "", -1, 2, {}},
        SoftLimitsCase{
            "BothAtZero", "revolute", "soft_lower_limit='0' soft_upper_limit='0'", -1, 2, {}},
        SoftLimitsCase{"Within",
                       "prismatic",
                       "soft_lower_limit='-0.5' soft_upper_limit='1.5'",
                       -0.5,
                       1.5,
                       {"r.urdf: soft limits (safety_controller) narrow: j to [-0.5, 1.5]"}},
        SoftLimitsCase{"LowerAlone",
                       "revolute",
                       "soft_lower_limit='-0.5'",
                       -0.5,
                       2,
                       {"r.urdf: soft limits (safety_controller) narrow: j to [-0.5, 2]"}},
        SoftLimitsCase{"LowerAloneAtZero",
                       "revolute",
                       "soft_lower_limit='0'",
                       0,
                       2,
                       {"r.urdf: soft limits (safety_controller) narrow: j to [0, 2]"}},
        SoftLimitsCase{"UpperAlone",
                       "revolute",
                       "soft_upper_limit='1'",
                       -1,
                       1,
                       {"r.urdf: soft limits (safety_controller) narrow: j to [-1, 1]"}},
        SoftLimitsCase{"Beyond",
                       "revolute",
                       "soft_lower_limit='-3' soft_upper_limit='2'",
                       -1,
                       2,
                       {"r.urdf: soft limits (safety_controller) beyond the limits do not count: "
                        "j"}},
        SoftLimitsCase{"BeyondOnOneSide",
                       "revolute",
                       "soft_lower_limit='-0.5' soft_upper_limit='5'",
                       -0.5,
                       2,
                       {"r.urdf: soft limits (safety_controller) beyond the limits do not count: j",
                        "r.urdf: soft limits (safety_controller) narrow: j to [-0.5, 2]"}},
        SoftLimitsCase{"Continuous",
                       "continuous",
                       "soft_lower_limit='-2' soft_upper_limit='2'",
                       -2,
                       2,
                       {"r.urdf: soft limits (safety_controller) narrow: j to [-2, 2]"}},
        SoftLimitsCase{"ContinuousWithOne",
                       "continuous",
                       "soft_lower_limit='-2'",
                       -kEndless,
                       kEndless,
                       {"r.urdf: a soft limit (safety_controller) on one side bounds no continuous "
                        "joint, and does not count: j"}}),
    [](const auto& test) { return test.param.name; });

TEST(ContinuousJoints, HaveNoLimitsThoughSomeAreGiven) {
  std::string urdf = "<robot name='r'><link name='a'/>";
  for (const char* limits : {"", "lower='-1' upper='2'", "lower='0' upper='0'", "upper='6.28'"}) {
    urdf += fmt::format(
        "<link name='l{0}'/><joint name='j{0}' type='continuous'><parent link='a'/>"
        "<child link='l{0}'/><limit {1} velocity='1' effort='1'/></joint>",
        urdf.size(), limits);
  }
  std::vector<std::string> warnings;
  const RobotModel model = RobotModel::FromUrdf(urdf + "</robot>", "r.urdf", &warnings);
  for (const Joint& joint : model.joints()) EXPECT_EQ(joint.upper, kEndless) << joint.name;
  EXPECT_THAT(warnings,
              testing::ElementsAre(fmt::format(
                  "r.urdf: lower and upper limits bound no continuous joint, and do not count; one "
                  "that has limits is revolute: {} ([-1, 2]), {} ([0, 6.28])",
                  model.joints()[1].name, model.joints()[3].name)));
}

TEST(VelocityLimits, AreNoneWhereNoJointIsSoSlow) {
  std::string urdf = "<robot name='r'><link name='a'/>";
  for (const char* velocity : {"1e-300", "0", "5", "1e300", "1e-4"}) {
    urdf += fmt::format(
        "<link name='l{0}'/><joint name='j{0}' type='continuous'><parent link='a'/>"
        "<child link='l{0}'/><limit velocity='{0}' effort='1'/></joint>",
        velocity);
  }
  std::vector<std::string> warnings;
  const RobotModel model = RobotModel::FromUrdf(urdf + "</robot>", "r.urdf", &warnings);
  std::vector<double> limits;
  for (const Joint& joint : model.joints()) limits.push_back(joint.max_velocity);
  EXPECT_EQ(limits, (std::vector<double>{0, 0, 5, 1e4, 1e-4}));
  EXPECT_THAT(warnings, testing::ElementsAre(
                            "r.urdf: limits of velocity below 0.0001 count as none given, that is "
                            "as 1 rad/s or m/s: j1e-300 (1e-300)"));
}

}  // namespace
}  // namespace planbench
