#include "problem_generator/scene_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "collision/fcl/fcl_shape.h"
#include "tests/problem_generator/generator_support.h"

namespace planbench {
namespace {

constexpr char kTail[] = R"(
queries:
  - name: approach
    start: {configuration: tuck}
    goal: {gripper: {object: thing, position: [0, 0, 0]}}
)";
constexpr char kHead[] = R"(setup: fetch_setup.yaml
clearance: 0
min_joint_distance: 0
effort: {scenes: 1, poses: 1, solutions: 1, ik_starts: 1}
objects:
)";

class SceneSamplerTest : public testing::Test {
 protected:
  ProblemSpec Spec(const std::string& objects, const std::string& gap = "0.02") {
    return folder_.Load("object_gap: " + gap + "\n" + kHead + objects + kTail, fetch_);
  }
  std::optional<SampledScene> Sample(const ProblemSpec& spec, int problem) {
    RandomStream random("set", 1, problem, 0);
    return SampleScene(spec, fetch_, &random, &rejections_);
  }

  const Robot fetch_ = LoadFetch();
  const SpecFolder folder_;
  Rejections rejections_;
};

TEST_F(SceneSamplerTest, PosesFollowFramesAndRotationAboutTheBase) {
  const ProblemSpec spec = Spec(R"(
  - id: shelf
    position: [1, 0, 0.5]
    about_base: 1.5707963267948966
    parts: [{name: board, box: [0.5, 0.8, 0.04], position: [0, 0, 0.1]}]
  - id: thing
    relative_to: shelf
    position: [0, 0.1, 0.3]
    rpy: [0, 0, 1.5707963267948966]
    parts: [{sphere: 0.05, position: [0.02, 0, 0]}]
)");
  const auto sampled = Sample(spec, 1);
  ASSERT_TRUE(sampled);
  // x of the shelf points along the base's y; of the thing along -x.
  EXPECT_TRUE(sampled->poses[0]->translation().isApprox(Eigen::Vector3d(0, 1, 0.5)));
  EXPECT_TRUE(sampled->poses[1]->translation().isApprox(Eigen::Vector3d(-0.1, 1, 0.8)));
  const SceneObject& thing = sampled->scene.objects[1];
  EXPECT_TRUE(thing.X_WO.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(thing.shapes[0].X_FS.translation().isApprox(Eigen::Vector3d(-0.12, 1, 0.8), 1e-9));
  EXPECT_EQ(sampled->scene.world_frame, "base_link");
}

TEST_F(SceneSamplerTest, StandingObjectsTouchTheirSupportFromAbove) {
  const ProblemSpec spec = Spec(R"(
  - id: shelf
    position: [1, 0, [0.5, 1]]
    about_base: [-1, 1]
    parts: [{name: board, box: [0.5, 0.8, 0.04], position: [0, 0, 0.1]}]
  - id: thing
    stands_on: shelf
    position: [[-0.1, 0.1], [-0.3, 0.3]]
    yaw: [-3, 3]
    parts:
      - {cylinder: [[0.1, 0.2], 0.03], position: [0, 0, 0.3]}
      - {box: [0.02, 0.02, 0.1], position: [0.05, 0, 0.25]}
)");
  for (int problem = 1; problem <= 50; ++problem) {
    const auto sampled = Sample(spec, problem);
    ASSERT_TRUE(sampled);
    const double board_top = sampled->poses[0]->translation().z() + 0.12;
    double lowest = 10;
    for (const PlacedShape& placed : sampled->scene.objects[1].shapes) {
      const double half = std::holds_alternative<Cylinder>(placed.shape)
                              ? std::get<Cylinder>(placed.shape).length / 2
                              : 0.05;
      lowest = std::min(lowest, placed.X_FS.translation().z() - half);
    }
    EXPECT_NEAR(lowest, board_top, 1e-9);
  }
}

TEST_F(SceneSamplerTest, ObjectsKeepTheGapAndStandWhollyOnTheirSupport) {
  const ProblemSpec spec = Spec(R"(
  - id: shelf
    position: [1, 0, 0.5]
    about_base: [-3, 3]
    parts:
      - {name: board, box: [0.4, 0.4, 0.04]}
      - {box: [0.4, 0.04, 0.4], position: [0, 0.2, 0.2]}
  - id: a
    stands_on: shelf.board
    position: [[-0.2, 0.2], [-0.2, 0.2]]
    parts: [{cylinder: [0.1, 0.04]}]
  - id: thing
    stands_on: shelf.board
    position: [[-0.2, 0.2], [-0.2, 0.2]]
    yaw: [-3, 3]
    parts: [{box: [0.1, 0.05, 0.2]}]
)");
  int accepted = 0;
  for (int problem = 1; problem <= 300; ++problem) {
    const auto sampled = Sample(spec, problem);
    if (!sampled) continue;
    ++accepted;
    const auto& objects = sampled->scene.objects;
    const auto distance = [](const PlacedShape& a, const PlacedShape& b) {
      return FclShape(a.shape, "")
          .Distance(FclShape(b.shape, ""), Pose::From(a.X_FS.inverse() * b.X_FS), 1);
    };
    EXPECT_GE(distance(objects[1].shapes[0], objects[2].shapes[0]), 0.02 - 1e-6);
    for (int i : {1, 2}) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_GE(distance(objects[0].shapes[1], objects[k].shapes[0]), 0.02 - 1e-6);
      // On the board, whichever way it is turned.
      const Eigen::Vector3d p =
          sampled->poses[0]->inverse() * objects[k].shapes[0].X_FS.translation();
      EXPECT_LE(std::abs(p.x()), 0.2 - 0.025);
      EXPECT_LE(std::abs(p.y()), 0.2 - 0.025);
    }
  }
  EXPECT_GT(accepted, 10);
  const auto reasons = rejections_.ByReason();
  EXPECT_GT(reasons.at("thing too near to a"), 0);
  EXPECT_GT(reasons.at("a too near to shelf"), 0);
  EXPECT_GT(reasons.at("thing does not stand wholly on its support"), 0);
}

TEST_F(SceneSamplerTest, WithoutAGapObjectsThatTouchAreRefusedAlone) {
  const auto is_made = [&](const std::string& one, const std::string& other, const std::string& x) {
    return Sample(Spec("  - {id: wall, position: [1, 0, 0], parts: [{" + one +
                           "}]}\n  - {id: thing, position: [" + x + ", 0, 0], parts: [{" + other +
                           "}]}",
                       "0"),
                  1)
        .has_value();
  };
  const std::string box = "box: [0.2, 0.2, 0.2]", cylinder = "cylinder: [0.2, 0.1]",
                    sphere = "sphere: 0.1";
  for (const std::string& one : {box, cylinder, sphere}) {
    for (const std::string& other : {box, cylinder, sphere}) {
      SCOPED_TRACE(one + " " + other);
      EXPECT_TRUE(is_made(one, other, "3"));
      EXPECT_TRUE(is_made(one, other, "1.201")) << "their bounding spheres meet";
      EXPECT_FALSE(is_made(one, other, "1.199"));
    }
  }
}

TEST_F(SceneSamplerTest, WhatIsTurnedStandsAsFarDownAndAsFarOutAsItReaches) {
  // Height of the object's frame above the face, nothing if it does not stand on it.
  const auto height = [&](const std::string& part, const std::string& x) -> std::optional<double> {
    const auto sampled =
        Sample(Spec("  - {id: table, position: [1, 0, 0.5], parts: [{box: [1, 1, 0.2]}]}\n"
                    "  - {id: thing, stands_on: table, position: [" +
                    x + ", 0], yaw: 0.3, parts: [{" + part + "}]}"),
               1);
    if (!sampled) return std::nullopt;
    return sampled->poses[1]->translation().z() - 0.6;
  };
  const std::string sphere = "sphere: 0.1, rpy: [0.5, 0.6, 0.7]";
  EXPECT_NEAR(height(sphere, "0").value(), 0.1, 1e-9);
  EXPECT_TRUE(height(sphere, "0.4"));
  EXPECT_FALSE(height(sphere, "0.401"));
  const std::string upright = "cylinder: [0.3, 0.1]";
  EXPECT_NEAR(height(upright, "0").value(), 0.15, 1e-9);
  EXPECT_TRUE(height(upright, "-0.4"));
  EXPECT_FALSE(height(upright, "-0.401"));
  // Its axis leans by the angle between z and Ry(0.7) Rx(0.7) z, whose cosine is cos(0.7)^2.
  const std::string leaning = "cylinder: [0.3, 0.1], rpy: [0.7, 0.7, 0]";
  const double up = std::cos(0.7) * std::cos(0.7);
  EXPECT_NEAR(height(leaning, "0").value(), 0.15 * up + 0.1 * std::sqrt(1 - up * up), 1e-9);
  EXPECT_NEAR(height("box: [0.1, 0.1, 0.1], rpy: [0.7853981633974483, 0, 0]", "0").value(),
              0.05 * std::sqrt(2), 1e-9);
}

TEST_F(SceneSamplerTest, AbsentObjectsTakeWhatStandsOnThemAlong) {
  const ProblemSpec spec = Spec(R"(
  - id: tray
    probability: 0.5
    position: [1, 0, 0.5]
    parts: [{box: [0.4, 0.4, 0.04]}]
  - id: thing
    stands_on: tray
    position: [0, 0]
    parts: [{sphere: 0.03}]
)");
  int with = 0;
  for (int problem = 1; problem <= 200; ++problem) {
    const auto sampled = Sample(spec, problem);
    ASSERT_TRUE(sampled);
    EXPECT_EQ(sampled->poses[0].has_value(), sampled->poses[1].has_value());
    EXPECT_EQ(sampled->scene.objects.size(), sampled->poses[0] ? 2 : 0);
    with += sampled->poses[0] ? 1 : 0;
  }
  EXPECT_GT(with, 60);
  EXPECT_LT(with, 140);
}

TEST_F(SceneSamplerTest, DrawsStayInTheirRangesAndFillThem) {
  const ProblemSpec spec = Spec(R"(
  - id: thing
    position: [[0.5, 1.5], -0.25, 1]
    parts: [{box: [[0.1, 0.3], 0.1, 0.1]}]
)");
  double least = 10, most = 0, narrowest = 10, widest = 0;
  for (int problem = 1; problem <= 300; ++problem) {
    const auto sampled = Sample(spec, problem);
    ASSERT_TRUE(sampled);
    const Eigen::Vector3d p = sampled->poses[0]->translation();
    EXPECT_EQ(p.y(), -0.25);
    least = std::min(least, p.x());
    most = std::max(most, p.x());
    const double width = std::get<Box>(sampled->scene.objects[0].shapes[0].shape).size.x();
    narrowest = std::min(narrowest, width);
    widest = std::max(widest, width);
  }
  EXPECT_GE(least, 0.5);
  EXPECT_LT(least, 0.55);
  EXPECT_LT(most, 1.5);
  EXPECT_GT(most, 1.45);
  EXPECT_GE(narrowest, 0.1);
  EXPECT_LT(narrowest, 0.11);
  EXPECT_LT(widest, 0.3);
  EXPECT_GT(widest, 0.29);
}

}  // namespace
}  // namespace planbench
