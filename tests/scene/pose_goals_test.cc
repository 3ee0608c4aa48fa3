#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "common/error.h"
#include "common/numbers.h"
#include "tests/robot_model/random_configuration.h"
#include "tests/scene/problem_texts.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/two_arm_robot.h"

namespace planbench {
namespace {

using testing::ElementsAre;

// The text robot's gripper is at (cos a, sin a, b), turned by a about z.
constexpr const char* kMast = R"(group_name: arm
start_state: {joint_state: {name: [a_joint, b_joint], position: [0, 0]}}
goal_constraints:
  - SET
)";
constexpr const char* kPosition =
    "position_constraints: [{link_name: gripper_link, constraint_region: {primitives: "
    "[{type: 2, dimensions: [0.001]}], primitive_poses: [{position: [0, 1, 3], "
    "orientation: [0, 0, 0, 1]}]}}]";
constexpr const char* kOrientation =
    "orientation_constraints: [{link_name: gripper_link, orientation: [0, 0, "
    "0.7071067811865476, 0.7071067811865476], absolute_z_axis_tolerance: 0.1}]";

std::vector<JointGoal> MastGoals(const std::string& set) {
  const std::string request = Replaced(kMast, "SET", "{" + set + "}");
  return ParseProblem("robot_model_name: fetch\n", request).goal;
}

// Both joints of every alternative.
std::vector<std::pair<double, double>> MastConfigurations(const std::string& set) {
  const std::vector<JointGoal> goals = MastGoals(set);
  std::vector<std::pair<double, double>> configurations;
  for (std::size_t i = 0; i + 1 < goals.size(); i += 2) {
    EXPECT_EQ(goals[i].joint, "a_joint");
    EXPECT_EQ(goals[i + 1].joint, "b_joint");
    configurations.emplace_back(goals[i].position, goals[i + 1].position);
  }
  return configurations;
}

TEST(GoalSets, OneThatIsOutOfReachIsLeftOutAndSaidSo) {
  const std::string far = Replaced(kPosition, "[0, 1, 3]", "[0, 9, 3]");
  const std::string near =
      "joint_constraints: [{joint_name: a_joint, position: 2}, "
      "{joint_name: b_joint, position: 1}]";
  const std::string request = Replaced(kMast, "SET", "{" + far + "}\n  - {" + near + "}");
  const Problem problem = ParseProblem("robot_model_name: fetch\n", request);
  EXPECT_EQ(problem.goal, (std::vector<JointGoal>{{"a_joint", 2, 0, 0}, {"b_joint", 1, 0, 0}}));
  EXPECT_THAT(problem.warnings, ElementsAre(testing::HasSubstr("goal_constraints[0]: is out of")));
  ExpectInputError([&] { MastGoals(far); }, {"goal_constraints[0]", "no configuration"});
}

TEST(GoalSets, AreAlternativesInTheGroupsOrderWhateverTheFiles) {
  const auto goals = MastGoals(
      "joint_constraints: [{joint_name: b_joint, position: 1}, {joint_name: a_joint, position: "
      "2}]}\n  - {joint_constraints: [{joint_name: a_joint, position: 3, tolerance_above: 0.5}, "
      "{joint_name: b_joint, position: 4}]");
  const std::vector<JointGoal> expected = {
      {"a_joint", 2, 0, 0}, {"b_joint", 1, 0, 0}, {"a_joint", 3, 0.5, 0}, {"b_joint", 4, 0, 0}};
  EXPECT_EQ(goals, expected);
}

TEST(PoseGoals, PositionAloneLeavesTheOrientationFree) {
  const auto found = MastConfigurations(kPosition);
  ASSERT_EQ(found.size(), 1u);  // There is no other.
  EXPECT_NEAR(found[0].first, kPi / 2, 1e-3);
  EXPECT_NEAR(found[0].second, 3, 1e-3);
}

TEST(PoseGoals, OrientationAloneLeavesThePositionFree) {
  const auto found = MastConfigurations(kOrientation);
  EXPECT_EQ(found.size(), 16u);
  double lowest = 9;
  double highest = -9;
  for (const auto& [a, b] : found) {
    EXPECT_NEAR(a, kPi / 2, 0.1 + 1e-6);
    lowest = std::min(lowest, b);
    highest = std::max(highest, b);
  }
  EXPECT_GT(highest - lowest, 5) << "of a lift of 18 m";
}

TEST(PoseGoals, JointConstraintsBesideThemRestrict) {
  const auto found = MastConfigurations(
      std::string(kOrientation) +
      ", joint_constraints: [{joint_name: b_joint, position: 1, tolerance_above: 0.5}, "
      "{joint_name: a_joint, position: 1.6, tolerance_below: 1}, {joint_name: l, position: 0}]");
  EXPECT_GE(found.size(), 2u);
  for (const auto& [a, b] : found) {
    EXPECT_GE(a, kPi / 2 - 0.1 - 1e-6);
    EXPECT_LE(a, 1.6);
    EXPECT_GE(b, 1);
    EXPECT_LE(b, 1.5);
  }
  ExpectInputError(
      [] {
        MastGoals(std::string(kOrientation) +
                  ", joint_constraints: [{joint_name: b_joint, position: 10}]");
      },
      {"request.yaml:4: goal_constraints[0].joint_constraints: ", "'b_joint'", "limits"});
}

TEST(PoseGoals, OfAnyTipOfTheGroup) {
  const Robot robot = MakeTwoArmRobot();
  const PlanningGroup& group = robot.Group("both");
  std::vector<std::string> names;
  for (const JointSpace::Joint& joint : group.space.joints()) names.push_back(joint.name);
  const std::vector<double> start = robot.model.DefaultPositions();
  std::vector<double> reached = start;
  for (double& position : reached) position += 0.3;
  const auto goals = [&](const std::string& constraints) {
    const std::string request = fmt::format(
        "group_name: both\nstart_state: {{joint_state: {{name: [{}], position: [{}]}}}}\n"
        "goal_constraints:\n  - {{{}}}\n",
        fmt::join(robot.model.position_names(), ", "), fmt::join(start, ", "), constraints);
    return ParseProblem(YamlNode::Parse("robot_model_name: two_arms\n", "scene.yaml"),
                        YamlNode::Parse(request, "request.yaml"), robot, {})
        .goal;
  };
  const auto position_of = [&](const std::string& link) {
    const Eigen::Vector3d p =
        ComputeLinkPoses(robot.model, reached)[static_cast<std::size_t>(robot.model.FindLink(link))]
            .translation();
    return fmt::format(
        "position_constraints: [{{link_name: {}, constraint_region: {{primitives: [{{type: 2, "
        "dimensions: [0.001]}}], primitive_poses: [{{position: [{}, {}, {}], orientation: [0, 0, "
        "0, 1]}}]}}}}]",
        link, p.x(), p.y(), p.z());
  };
  for (const char* link : {"left_hand", "right_hand"}) {
    const std::vector<JointGoal> found = goals(position_of(link));
    ASSERT_GE(found.size(), names.size());
    std::vector<double> q;
    for (std::size_t k = 0; k < names.size(); ++k) q.push_back(found[k].position);
    const auto at = [&](const std::vector<double>& full) -> Eigen::Vector3d {
      return ComputeLinkPoses(robot.model,
                              full)[static_cast<std::size_t>(robot.model.FindLink(link))]
          .translation();
    };
    EXPECT_LT((at(WithGroupAt(robot.model, group, start, q)) - at(reached)).norm(), 0.001 + 2e-6)
        << link;
  }
  ExpectInputError(
      [&] { goals(position_of("left_upper")); },
      {"request.yaml:4: goal_constraints[0].position_constraints[0].link_name",
       "'left_upper' does not move as one with 'left_hand' or 'right_hand', the tips"});
}

// The torso moves both: of the poses of two tips either depends on the other.
TEST(PoseGoals, OfSeveralTipsAtOnce) {
  const Robot robot = MakeTwoArmRobot(true);
  const PlanningGroup& group = robot.Group("both");
  const std::size_t n = group.joints.size();
  const std::vector<double> start = robot.model.DefaultPositions();
  std::vector<double> reached = start;
  for (double& position : reached) position += 0.4;
  const auto link_at = [&](const std::vector<double>& full, const std::string& link) {
    return ComputeLinkPoses(robot.model,
                            full)[static_cast<std::size_t>(robot.model.FindLink(link))];
  };
  const auto position_of = [&](const std::string& link, double beside = 0) {
    const Eigen::Vector3d p = link_at(reached, link).translation();
    return fmt::format(
        "{{link_name: {}, constraint_region: {{primitives: [{{type: 2, dimensions: [0.001]}}], "
        "primitive_poses: [{{position: [{}, {}, {}], orientation: [0, 0, 0, 1]}}]}}}}",
        link, p.x(), p.y() + beside, p.z());
  };
  const auto orientation_of = [&](const std::string& link) {
    const Eigen::Quaterniond q(link_at(reached, link).linear());
    return fmt::format("{{link_name: {}, orientation: [{}, {}, {}, {}]}}", link, q.x(), q.y(),
                       q.z(), q.w());
  };
  const auto goals = [&](const std::string& positions, const std::string& orientations) {
    const std::string request = fmt::format(
        "group_name: both\nstart_state: {{joint_state: {{name: [{}], position: [{}]}}}}\n"
        "goal_constraints:\n  - {{position_constraints: [{}], orientation_constraints: [{}]}}\n",
        fmt::join(robot.model.position_names(), ", "), fmt::join(start, ", "), positions,
        orientations);
    return ParseProblem(YamlNode::Parse("robot_model_name: two_arms\n", "scene.yaml"),
                        YamlNode::Parse(request, "request.yaml"), robot, {})
        .goal;
  };
  const std::string both = position_of("left_hand") + ", " + position_of("right_hand");
  for (const bool left_turned : {false, true}) {
    const std::vector<JointGoal> found =
        goals(both, left_turned ? orientation_of("left_hand") : "");
    ASSERT_GE(found.size(), n);
    for (std::size_t first = 0; first < found.size(); first += n) {
      std::vector<double> q;
      for (std::size_t k = 0; k < n; ++k) q.push_back(found[first + k].position);
      const std::vector<double> full = WithGroupAt(robot.model, group, start, q);
      for (const char* link : {"left_hand", "right_hand"}) {
        const auto at = link_at(full, link);
        const auto wanted = link_at(reached, link);
        EXPECT_LT((at.translation() - wanted.translation()).norm(), 0.001 + 2e-6) << link;
        if (!left_turned || link != std::string("left_hand")) continue;
        EXPECT_TRUE(at.linear().isApprox(wanted.linear(), 1e-5));
      }
    }
    EXPECT_EQ(goals(both, left_turned ? orientation_of("left_hand") : ""), found);
  }
  // The position of one, the orientation of the other.
  EXPECT_GE(goals(position_of("right_hand"), orientation_of("left_hand")).size(), n);
  ExpectInputError([&] { goals(both + ", " + position_of("left_hand"), ""); },
                   {"request.yaml:4: goal_constraints[0].position_constraints[2]",
                    "the second of this kind for the same tip"});
  ExpectInputError(
      [&] { goals(position_of("left_hand") + ", " + position_of("right_hand", 3), ""); },
      {"goal_constraints[0].position_constraints[0]",
       "no configuration of group 'both' reaches the poses of its tips"});
}

TEST(PoseGoals, StandBesideOtherAlternatives) {
  const auto goals = MastGoals(std::string(kPosition) +
                               "}\n  - {joint_constraints: [{joint_name: a_joint, position: 1}, "
                               "{joint_name: b_joint, position: 1}]");
  ASSERT_EQ(goals.size(), 4u);
  EXPECT_NEAR(goals[1].position, 3, 1e-3);
  EXPECT_EQ(goals[2], (JointGoal{"a_joint", 1, 0, 0}));
}

TEST(PoseGoals, FramesAndOffsets) {
  const auto reach = [](const std::string& from, const std::string& to) {
    return MastConfigurations(Replaced(kPosition, from, to));
  };
  const auto plain = MastConfigurations(kPosition);
  EXPECT_EQ(reach("[{link_name", "[{header: {frame_id: /base_link}, link_name"), plain);
  EXPECT_EQ(reach("gripper_link", "/gripper_link"), plain);
  const auto of_finger = reach("gripper_link", "l_finger");  // Fixed to the tip.
  ASSERT_EQ(of_finger.size(), 1u);
  EXPECT_NEAR(of_finger[0].first, plain[0].first, 1e-6);
  EXPECT_NEAR(of_finger[0].second, plain[0].second, 1e-6);
  // At the start the gripper is at (1, 0, 0).
  const auto moved = reach("[{link_name",
                           "[{header: {frame_id: gripper_link}, target_point_offset: [0, 1, 0], "
                           "link_name");
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_NEAR(moved[0].first, 0, 1e-3);
  EXPECT_NEAR(moved[0].second, 3, 1e-3);
}

TEST(PoseGoals, RefusesWhatItCannotMean) {
  const auto refuse = [](const std::string& good, const std::string& from, const std::string& to,
                         const std::string& field, const std::string& says) {
    SCOPED_TRACE(says);
    ExpectInputError([&] { MastGoals(Replaced(good, from, to)); },
                     {"request.yaml:4: goal_constraints[0]." + field + ": ", says});
  };
  const std::string position = "position_constraints[0]";
  const std::string orientation = "orientation_constraints[0]";
  refuse(kPosition, "[0, 1, 3]", "[0, 3, 3]", position,
         "no configuration of group 'arm' reaches the pose (nearest: 1.999 m and 0 rad off; "
         "1e-06 m and 1e-06 rad are allowed)");
  refuse(kPosition, "[0, 1, 3]", "[0, 1, 9.501]", position, "(nearest: 0.5 m and 0 rad off;");
  refuse(kOrientation, "[0, 0, 0.7071067811865476, 0.7071067811865476]", "[1, 0, 0, 0]",
         orientation, "(nearest: 0 m and ");
  refuse(kPosition, "gripper_link", "mast", position + ".link_name",
         "'mast' does not move as one with 'gripper_link', the tip of group 'arm'");
  refuse(kPosition, "gripper_link", "hand", position + ".link_name", "no link 'hand'");
  refuse(kPosition, "[{link_name", "[{header: {frame_id: lamp}, link_name",
         position + ".header.frame_id", "unknown frame 'lamp'");
  refuse(kPosition, "type: 2, dimensions: [0.001]", "type: 3, dimensions: [0.1, 0.1]",
         position + ".constraint_region.primitives[0].type", "boxes and spheres");
  refuse(kPosition, "type: 2, dimensions: [0.001]", "type: 2, dimensions: [0]",
         position + ".constraint_region.primitives[0].dimensions[0]", "greater than zero");
  refuse(kPosition, "{primitives", "{meshes: [{}], primitives",
         position + ".constraint_region.meshes[0]", "meshes are not supported");
  refuse(kPosition, "{type: 2, dimensions: [0.001]}", "", position + ".constraint_region",
         "no primitives");
  refuse(kPosition, "{type: 2,", "{type: 2, dimensions: [1]}, {type: 2,",
         position + ".constraint_region", "2 primitives but 1 primitive_poses");
  refuse(kOrientation, "constraints: [{",
         "constraints: [{link_name: l_finger, orientation: [0, 0, 0, 1]}, {",
         "orientation_constraints[1]", "the second of this kind for the same tip");
  refuse(kOrientation, "tolerance: 0.1", "tolerance: -0.1",
         orientation + ".absolute_z_axis_tolerance", "negative");
  refuse(kOrientation, "tolerance: 0.1", "tolerance: 0.1, parameterization: 2",
         orientation + ".parameterization", "found 2");
}

// Random constraints around poses that the Fetch reaches, in the frames and forms that files may
// give them in.
class RandomPoses : public testing::Test {
 protected:
  double Uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }
  static std::string Text(const Eigen::Vector3d& v) {
    return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
  }
  static std::string Text(const Eigen::Matrix3d& R) {
    const Eigen::Quaterniond q(R);
    return fmt::format("[{}, {}, {}, {}]", q.x(), q.y(), q.z(), q.w());
  }
  const Eigen::Isometry3d& Pose(const std::vector<Eigen::Isometry3d>& poses,
                                const std::string& link) const {
    return poses[static_cast<std::size_t>(fetch_.model.FindLink(link))];
  }

  const Robot fetch_ = LoadRobot(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "robots/fetch");
  const PlanningGroup& group_ = fetch_.groups.front();
  std::mt19937 random_{7};
};

TEST_F(RandomPoses, EveryAlternativeMeetsTheConstraint) {
  for (int trial = 0; trial < 24; ++trial) {
    SCOPED_TRACE(trial);
    const std::vector<double> start = RandomPositions(fetch_.model, &random_);
    const auto X_BL_start = ComputeLinkPoses(fetch_.model, start);
    const auto X_BL_goal = ComputeLinkPoses(
        fetch_.model,
        WithGroupAt(fetch_.model, group_, start, RandomConfiguration(group_.space, &random_)));
    const bool with_position = trial % 3 != 1;
    const bool with_orientation = trial % 3 != 2;
    const bool rotation_vector = trial % 2 == 0;
    const bool ball = trial % 4 < 2;
    const std::string frame = trial % 5 < 3 ? "base_link" : "elbow_flex_link";
    const std::string link = trial % 7 < 4 ? "gripper_link" : "wrist_roll_link";
    const Eigen::Isometry3d X_FB = Pose(X_BL_start, frame).inverse(Eigen::Isometry);
    const Eigen::Isometry3d X_FL = X_FB * Pose(X_BL_goal, link);
    const Eigen::Vector3d offset(Uniform(-0.1, 0.1), Uniform(-0.1, 0.1), Uniform(-0.1, 0.1));
    const Eigen::Vector3d size(Uniform(0.001, 0.2), Uniform(0.001, 0.2), Uniform(0.001, 0.2));
    const Eigen::Matrix3d R_FR =
        Eigen::Quaterniond(Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1))
            .normalized()
            .toRotationMatrix();
    const Eigen::Vector3d tolerance(Uniform(0, 0.5), trial % 6 == 0 ? 0 : Uniform(0, 0.5),
                                    Uniform(0, trial % 8 == 0 ? 4 : 0.5));

    std::string request = fmt::format(
        "group_name: {}\nstart_state: {{joint_state: {{name: [{}], position: [{}]}}}}\n"
        "goal_constraints:\n  - name: pose\n",
        group_.name, fmt::join(fetch_.model.position_names(), ", "), fmt::join(start, ", "));
    if (with_position) {
      request += fmt::format(
          "    position_constraints: [{{header: {{frame_id: {}}}, link_name: {}, "
          "target_point_offset: {}, constraint_region: {{primitives: [{{type: {}, dimensions: "
          "{}}}], primitive_poses: [{{position: {}, orientation: {}}}]}}, weight: 1}}]\n",
          frame, link, Text(offset), ball ? "sphere" : "box",
          ball ? fmt::format("[{}]", size.x()) : Text(size), Text(X_FL * offset), Text(R_FR));
    }
    if (with_orientation) {
      request += fmt::format(
          "    orientation_constraints: [{{header: {{frame_id: {}}}, link_name: {}, orientation: "
          "{}, absolute_x_axis_tolerance: {}, absolute_y_axis_tolerance: {}, "
          "absolute_z_axis_tolerance: {}, parameterization: {}}}]\n",
          frame, link, Text(Eigen::Matrix3d(X_FL.linear())), tolerance.x(), tolerance.y(),
          tolerance.z(), rotation_vector ? 1 : 0);
    }
    const Problem problem = ParseProblem(YamlNode::Parse("robot_model_name: fetch\n", "scene"),
                                         YamlNode::Parse(request, "request"), fetch_, {});
    const auto n = static_cast<std::size_t>(group_.space.size());
    ASSERT_EQ(problem.goal.size() % n, 0u);
    EXPECT_GE(problem.goal.size() / n, 2u) << "the arm is redundant";
    EXPECT_LE(problem.goal.size() / n, 16u);
    for (std::size_t first = 0; first < problem.goal.size(); first += n) {
      std::vector<double> q;
      for (std::size_t k = 0; k < n; ++k) {
        const JointGoal& goal = problem.goal[first + k];
        EXPECT_EQ(goal.joint, group_.space.joints()[k].name);
        EXPECT_EQ(goal.tolerance_above, 0);
        EXPECT_EQ(goal.tolerance_below, 0);
        q.push_back(goal.position);
      }
      EXPECT_TRUE(group_.space.WithinLimits(q));
      const auto X_BL = ComputeLinkPoses(fetch_.model, WithGroupAt(fetch_.model, group_, start, q));
      const Eigen::Isometry3d X_FL_found = X_FB * Pose(X_BL, link);
      if (with_position) {
        const Eigen::Vector3d off = X_FL_found * offset - X_FL * offset;
        const Eigen::Vector3d off_R = R_FR.transpose() * off;
        if (ball) {
          EXPECT_LE(off.norm(), size.x() + 2e-6);
        } else {
          EXPECT_LE((off_R.cwiseAbs() - size / 2).maxCoeff(), 2e-6);
        }
      }
      if (!with_orientation) continue;
      const Eigen::Matrix3d R = X_FL.linear().transpose() * X_FL_found.linear();
      if (rotation_vector) {
        const Eigen::AngleAxisd turn(R);
        EXPECT_LE((turn.angle() * turn.axis().cwiseAbs() - tolerance).maxCoeff(), 2e-6);
        continue;
      }
      // The three angles come in two forms.
      const Eigen::Vector3d angles = R.eulerAngles(0, 1, 2);
      const Eigen::Vector3d others(angles.x() - kPi, kPi - angles.y(), angles.z() - kPi);
      const auto excess = [&](const Eigen::Vector3d& a) {
        double most = -1;
        for (int i = 0; i < 3; ++i) {
          most = std::max(most, std::abs(std::remainder(a[i], 2 * kPi)) - tolerance[i]);
        }
        return most;
      };
      EXPECT_LE(std::min(excess(angles), excess(others)), 2e-6);
    }
    // Every run finds the same.
    if (trial % 8 != 0) continue;
    EXPECT_EQ(ParseProblem(YamlNode::Parse("robot_model_name: fetch\n", "scene"),
                           YamlNode::Parse(request, "request"), fetch_, {})
                  .goal,
              problem.goal);
  }
}

}  // namespace
}  // namespace planbench
