#include "robot_model/motion_bound.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "robot_model/group_kinematics.h"
#include "robot_model/robot_folder.h"
#include "tests/robot_model/random_configuration.h"

namespace planbench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

struct Fixture {
  RobotModel model;
  PlanningGroup group;
  std::vector<double> held;
  std::vector<LinkSphere> balls;
};

Fixture FetchFixture() {
  const Robot fetch = LoadRobot(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "robots/fetch");
  return {fetch.model, fetch.Group(""), fetch.model.DefaultPositions(), fetch.spheres};
}

// A chain of random joints about random axes, some held, some following an earlier one, a few balls
// on each link.
Fixture RandomFixture(std::mt19937* random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto number = [&] { return unit(*random); };
  const int num_joints = 2 + static_cast<int>((*random)() % 5);
  std::string urdf = "<robot name='random'><link name='l0'/>";
  std::vector<std::string> moved;
  std::vector<std::string> leaders;  // Bounded joints so far that follow none.
  for (int j = 0; j < num_joints; ++j) {
    const char* types[] = {"revolute", "continuous", "prismatic", "fixed", "revolute"};
    const std::string type = types[(*random)() % 5];
    const double lower = number();
    std::string mimic;
    if (type != "fixed" && !leaders.empty() && (*random)() % 3 == 0) {
      mimic = fmt::format("<mimic joint='{}' multiplier='{}' offset='{}'/>",
                          leaders[(*random)() % leaders.size()], 2 * number(), number());
    }
    urdf += fmt::format(
        "<link name='l{1}'/><joint name='j{0}' type='{2}'><parent link='l{0}'/>"
        "<child link='l{1}'/><origin xyz='{3} {4} {5}' rpy='{6} {7} {8}'/>"
        "<axis xyz='{9} {10} {11}'/>"
        "<limit lower='{12}' upper='{13}' velocity='1' effort='1'/>{14}</joint>",
        j, j + 1, type, number(), number(), number(), 3 * number(), 3 * number(), 3 * number(),
        number(), number(), number(), lower, lower + std::abs(number()), mimic);
    if (type == "fixed" || !mimic.empty()) continue;
    if (type != "continuous") leaders.push_back(fmt::format("j{}", j));
    if ((*random)() % 5 != 0) moved.push_back(fmt::format("j{}", j));
  }
  if (moved.empty()) return RandomFixture(random);
  Fixture fixture;
  fixture.model = RobotModel::FromUrdf(urdf + "</robot>", "random");
  fixture.group = fixture.model.MakeGroup("group", moved, fmt::format("l{}", num_joints));
  fixture.held = RandomPositions(fixture.model, random);
  for (int link = 0; link <= num_joints; ++link) {
    for (int i = 0; i < 2; ++i) {
      fixture.balls.push_back(
          {link, Vector3d(number(), number(), number()), 0.1 * std::abs(number())});
    }
  }
  return fixture;
}

// Largest movement of any point of the balls between two configurations: of a random point of each
// ball's surface.
double SampledMotion(const Fixture& fixture, const GroupKinematics& from, const GroupKinematics& to,
                     std::mt19937* random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  double largest = 0;
  for (const LinkSphere& ball : fixture.balls) {
    const Vector3d direction(unit(*random), unit(*random), unit(*random));
    const Vector3d p_L = ball.p_LS + ball.radius * direction.normalized();
    largest = std::max(largest, (to.X_BL(ball.link) * p_L - from.X_BL(ball.link) * p_L).norm());
  }
  return largest;
}

bool Carries(const RobotModel& model, int joint, int link) {
  while (link > 0) {
    const int parent = model.links()[static_cast<std::size_t>(link)].parent_joint;
    if (parent == joint) return true;
    link = model.joints()[static_cast<std::size_t>(parent)].parent_link;
  }
  return false;
}

// Largest distance of a ball's far side from the axis of a group joint, at one configuration.
double SampledReach(const Fixture& fixture, const GroupKinematics& kinematics, int joint) {
  const Joint& j = fixture.model.joints()[static_cast<std::size_t>(joint)];
  const Isometry3d& X_BC = kinematics.X_BL(j.child_link);
  const Vector3d axis = X_BC.linear() * j.axis_J;
  double largest = 0;
  for (const LinkSphere& ball : fixture.balls) {
    if (!Carries(fixture.model, joint, ball.link)) continue;
    const Vector3d offset = kinematics.X_BL(ball.link) * ball.p_LS - X_BC.translation();
    largest = std::max(largest, offset.cross(axis).norm() + ball.radius);
  }
  return largest;
}

TEST(MotionBound, HoldsForRandomMotionsOfTheFetch) {
  const Fixture fetch = FetchFixture();
  const MotionBound bound(fetch.model, fetch.group, fetch.held, fetch.balls);
  GroupKinematics from(fetch.model, fetch.group, fetch.held);
  GroupKinematics to = from;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> fraction(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const std::vector<double> a = RandomConfiguration(fetch.group.space, &random);
    std::vector<double> b = RandomConfiguration(fetch.group.space, &random);
    // Short motions show the bound at its tightest, motions of one joint each joint's own share.
    fetch.group.space.Interpolate(a, b, std::pow(fraction(random), 4), b);
    if (i % 2 == 0) {
      const std::size_t only = random() % a.size();
      for (std::size_t j = 0; j < a.size(); ++j) {
        if (j != only) b[j] = a[j];
      }
    }
    from.Update(a);
    to.Update(b);
    ASSERT_LE(SampledMotion(fetch, from, to, &random),
              bound.Between(fetch.group.space, a, b) + 1e-12);
  }
}

TEST(MotionBound, ReachOfTheFetchIsTrueAndTight) {
  const Fixture fetch = FetchFixture();
  const MotionBound bound(fetch.model, fetch.group, fetch.held, fetch.balls);
  GroupKinematics kinematics(fetch.model, fetch.group, fetch.held);
  std::vector<double> sampled(fetch.group.joints.size(), 0.0);
  std::mt19937 random(2);
  for (int i = 0; i < 20000; ++i) {
    kinematics.Update(RandomConfiguration(fetch.group.space, &random));
    for (std::size_t j = 0; j < sampled.size(); ++j) {
      sampled[j] = std::max(sampled[j], SampledReach(fetch, kinematics, fetch.group.joints[j]));
    }
  }
  EXPECT_EQ(bound.reach()[0], 1);  // The torso slides.
  for (std::size_t j = 1; j < sampled.size(); ++j) {
    SCOPED_TRACE(fetch.group.space.joint(static_cast<int>(j)).name);
    EXPECT_GE(bound.reach()[j], sampled[j] - 1e-12);
    EXPECT_LE(bound.reach()[j], 1.1 * sampled[j]);
  }
}

TEST(MotionBound, HoldsForRandomRobots) {
  std::mt19937 random(3);
  for (int robot = 0; robot < 200; ++robot) {
    const Fixture fixture = RandomFixture(&random);
    const MotionBound bound(fixture.model, fixture.group, fixture.held, fixture.balls);
    GroupKinematics from(fixture.model, fixture.group, fixture.held);
    GroupKinematics to = from;
    for (int i = 0; i < 200; ++i) {
      const std::vector<double> a = RandomConfiguration(fixture.group.space, &random);
      std::vector<double> b = RandomConfiguration(fixture.group.space, &random);
      if (i % 2 == 0) fixture.group.space.Interpolate(a, b, 0.01, b);
      from.Update(a);
      to.Update(b);
      ASSERT_LE(SampledMotion(fixture, from, to, &random),
                bound.Between(fixture.group.space, a, b) + 1e-9);
      for (std::size_t j = 0; j < fixture.group.joints.size(); ++j) {
        if (fixture.group.space.joint(static_cast<int>(j)).prismatic) continue;
        ASSERT_LE(SampledReach(fixture, from, fixture.group.joints[j]), bound.reach()[j] + 1e-9);
      }
    }
  }
}

TEST(MotionBound, IsExactForAPlanarArm) {
  const RobotModel model = RobotModel::FromUrdf(R"(<robot name="planar">
    <link name="a"/><link name="b"/><link name="c"/><link name="d"/>
    <joint name="one" type="continuous"><parent link="a"/><child link="b"/>
      <axis xyz="0 0 1"/></joint>
    <joint name="two" type="prismatic"><parent link="b"/><child link="c"/>
      <origin xyz="0.5 0 0"/><axis xyz="1 0 0"/>
      <limit lower="0" upper="0.25" velocity="1" effort="1"/></joint>
    <joint name="three" type="continuous"><parent link="c"/><child link="d"/>
      <axis xyz="0 0 1"/></joint></robot>)",
                                                "planar");
  const PlanningGroup all = model.MakeGroup("all", {"one", "two", "three"}, "d");
  const std::vector<LinkSphere> tip = {{model.FindLink("d"), Vector3d(0.2, 0, 3), 0.05}};
  const MotionBound bound(model, all, model.DefaultPositions(), tip);
  EXPECT_NEAR(bound.reach()[0], 0.5 + 0.25 + 0.2 + 0.05, 1e-5);
  EXPECT_EQ(bound.reach()[1], 1);
  EXPECT_NEAR(bound.reach()[2], 0.25, 1e-12);
  const std::vector<double> a = {3, 0, 0};
  const std::vector<double> b = {-3, 0.1, 0.5};
  EXPECT_NEAR(bound.Between(all.space, a, b),
              (2 * M_PI - 6) * bound.reach()[0] + 0.1 + 0.5 * bound.reach()[2], 1e-12);

  // With the slide held, it counts at the position it is held at.
  const PlanningGroup turns = model.MakeGroup("turns", {"three", "one"}, "d");
  const MotionBound held(model, turns, std::vector<double>{0, 0.1, 0}, tip);
  EXPECT_NEAR(held.reach()[0], 0.25, 1e-12);
  EXPECT_NEAR(held.reach()[1], 0.5 + 0.1 + 0.2 + 0.05, 1e-9);
}

TEST(MotionBound, JointsThatCarryNothingHaveNoReach) {
  Fixture fetch = FetchFixture();
  std::erase_if(fetch.balls, [&](const LinkSphere& ball) {
    return ball.link != fetch.model.FindLink("shoulder_lift_link");
  });
  const MotionBound bound(fetch.model, fetch.group, fetch.held, fetch.balls);
  EXPECT_EQ(bound.reach()[0], 1);
  EXPECT_GT(bound.reach()[2], 0);
  for (std::size_t j = 3; j < bound.reach().size(); ++j) EXPECT_EQ(bound.reach()[j], 0);
  const MotionBound none(fetch.model, fetch.group, fetch.held, {});
  EXPECT_EQ(none.reach(), std::vector<double>(8, 0.0));
}

}  // namespace
}  // namespace planbench
