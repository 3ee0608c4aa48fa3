#include "collision/edge_checker.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "tests/contract/collision_oracle.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

/// Collides wherever a predicate says so, and keeps what it was asked.
class ScriptedChecker : public CollisionChecker {
 public:
  using Predicate = std::function<bool(std::span<const double>)>;

  ScriptedChecker(const Robot& robot, int batch_size)
      : CollisionChecker(robot, robot.groups.front(), CollisionModel::kSpheres),
        batch_size_(batch_size) {
    SetScene({}, robot.model.DefaultPositions());
  }
  std::string_view EngineName() const override { return "scripted"; }
  int BatchSize() const override { return batch_size_; }

  Predicate collides = [](std::span<const double>) { return false; };
  double clearance = 1;  ///< m, of whatever does not collide.
  /// Samples are looked at from the last on, up to one that collides.
  bool backwards = false;
  std::vector<std::vector<double>> asked;

 protected:
  MotionBound DoSetScene(const Scene&, std::span<const double> base_positions) override {
    return MotionBound(robot().model, group(), base_positions, robot().spheres);
  }
  bool DoIsFree(std::span<const double> q) override {
    asked.emplace_back(q.begin(), q.end());
    return !collides(q);
  }
  SampleVerdicts DoCheckSamples(std::span<const double> start, std::span<const double> motion,
                                std::span<const MotionSample> samples, SampleRole role) override {
    if (!backwards) return CollisionChecker::DoCheckSamples(start, motion, samples, role);
    SampleVerdicts verdicts;
    for (std::size_t k = samples.size(); k-- > 0 && verdicts.certain == 0;) {
      const SampleVerdicts one =
          CollisionChecker::DoCheckSamples(start, motion, samples.subspan(k, 1), role);
      verdicts.blocked |= one.blocked << k;
      verdicts.certain |= one.certain << k;
    }
    return verdicts;
  }
  std::optional<Contact> DoFindContact(std::span<const double>) override { return std::nullopt; }
  ClosestPair DoFindClosest(std::span<const double> q) override {
    return {collides(q) ? 0.0 : clearance, "", ""};
  }

 private:
  int batch_size_;
};

/// A rod of 1 m turning freely about z, a sphere of 0.1 m at its end; and a slide that carries it,
/// 0 to 1 m.
Robot MakePendulum() {
  Robot robot;
  robot.name = "pendulum";
  robot.model = RobotModel::FromUrdf(R"(<robot name="pendulum">
    <link name="base"/> <link name="cart"/> <link name="rod"/>
    <joint name="slide" type="prismatic"> <parent link="base"/> <child link="cart"/>
      <axis xyz="1 0 0"/> <limit lower="0" upper="1" velocity="1" effort="1"/> </joint>
    <joint name="turn" type="continuous"> <parent link="cart"/> <child link="rod"/>
      <axis xyz="0 0 1"/> <limit velocity="1" effort="1"/> </joint>
  </robot>)",
                                     "pendulum.urdf");
  robot.groups = {robot.model.MakeGroup("all", {"slide", "turn"}, "rod")};
  robot.spheres = {{robot.model.FindLink("rod"), Eigen::Vector3d(0.9, 0, 0), 0.1}};
  return robot;
}

TEST(EdgeCheckerTest, RefusesResolutionsThatAreNotLengths) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  for (double resolution : {0.0, -0.1, std::nan(""), std::numeric_limits<double>::infinity()}) {
    ExpectInputError([&] { EdgeChecker(&checker, resolution, EdgeCheck::kCertified); },
                     {"edge resolution"});
  }
  EdgeChecker tiny(&checker, 1e-300, EdgeCheck::kFixed);
  const std::vector<double> from = {0, 0};
  const std::vector<double> to = {1, 0};
  ExpectInputError([&] { tiny.IsValidEdge(from, to); }, {"edge resolution"});
}

TEST(EdgeCheckerTest, DividesEdgesByTheMotionBound) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  const EdgeChecker edges(&checker, 0.05, EdgeCheck::kFixed);
  const std::vector<double> origin = {0, 0};
  EXPECT_EQ(edges.NumIntervals(origin, origin), 1);
  EXPECT_EQ(edges.NumIntervals(origin, std::vector<double>{0.04, 0}), 1);
  EXPECT_EQ(edges.NumIntervals(origin, std::vector<double>{0.51, 0}), 11);
  EXPECT_EQ(edges.NumIntervals(origin, std::vector<double>{0.26, -0.23}), 10);
}

TEST(EdgeCheckerTest, ASamplingOfItsOwnDividesEdgesByItsNorm) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  const std::vector<double> from = {0, 3};
  const std::vector<double> to = {0.5, -3};  // 0.5 m, 0.2832 rad
  EdgeChecker sum(&checker, EdgeSampling{{1, 2}, 0.1});
  EXPECT_EQ(sum.NumIntervals(from, to), 11);
  EXPECT_TRUE(sum.IsValidEdge(from, to, /*from_is_free=*/true));
  EXPECT_EQ(checker.asked.size(), 11u);
  const EdgeChecker root(&checker, EdgeSampling{{1, 2}, 0.1, true});
  EXPECT_EQ(root.NumIntervals(from, to), 8);
  ExpectInputError([&] { EdgeChecker(&checker, EdgeSampling{{1}, 0.1}); }, {"1 values"});
  ExpectInputError([&] { EdgeChecker(&checker, EdgeSampling{{1, 1}, 0}); }, {"step", "0"});
}

TEST(EdgeCheckerTest, NoPointMovesFurtherThanTheResolutionBetweenSamples) {
  const Robot arm = MakeTestArm();
  ScriptedChecker checker(arm, 1);
  const double resolution = 0.02;
  const EdgeChecker edges(&checker, resolution, EdgeCheck::kFixed);
  const auto& space = checker.space();
  const auto base = arm.model.DefaultPositions();
  std::mt19937_64 generator(1);
  for (int i = 0; i < 20; ++i) {
    const auto from = RandomConfiguration(space, &generator);
    const auto to = RandomConfiguration(space, &generator);
    std::vector<Eigen::Isometry3d> before;
    edges.VisitSamples(from, to, [&](double, std::span<const double> q) {
      const auto poses = ComputeLinkPoses(arm.model, WithGroupAt(arm, checker.group(), base, q));
      for (const LinkSphere& sphere : arm.spheres) {
        if (before.empty()) break;
        const auto link = static_cast<std::size_t>(sphere.link);
        // Both the centre and the far side, which turns with the link.
        for (const Eigen::Vector3d& offset :
             {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
              Eigen::Vector3d(0, 0, -1)}) {
          const Eigen::Vector3d p = sphere.p_LS + sphere.radius * offset;
          EXPECT_LE((poses[link] * p - before[link] * p).norm(), resolution + 1e-12);
        }
      }
      before = poses;
      return true;
    });
  }
}

TEST(EdgeCheckerTest, VisitsItsSamplesInOrder) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  const EdgeChecker edges(&checker, 0.25, EdgeCheck::kFixed);
  const std::vector<double> from = {0, 0};
  const std::vector<double> to = {1, 0};
  std::vector<double> fractions;
  EXPECT_TRUE(edges.VisitSamples(from, to, [&](double fraction, std::span<const double> q) {
    EXPECT_EQ(q[0], fraction);
    fractions.push_back(fraction);
    return true;
  }));
  EXPECT_THAT(fractions, testing::ElementsAre(0, 0.25, 0.5, 0.75, 1));
  EXPECT_FALSE(edges.VisitSamples(
      from, to, [](double fraction, std::span<const double>) { return fraction < 0.5; }));
}

TEST(EdgeCheckerTest, ContinuousJointsGoTheShortWay) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  EdgeChecker edges(&checker, 0.05, EdgeCheck::kFixed);
  const std::vector<double> from = {0.5, 3.0};
  const std::vector<double> to = {0.5, -3.0};
  EXPECT_EQ(edges.NumIntervals(from, to), 6);  // 0.283 rad x 1 m
  checker.collides = [](std::span<const double> q) { return std::abs(q[1]) < 2.9; };
  EXPECT_TRUE(edges.IsValidEdge(from, to));
  checker.collides = [](std::span<const double> q) { return std::abs(q[1]) > 3.1; };
  EXPECT_FALSE(edges.IsValidEdge(from, to));
}

TEST(EdgeCheckerTest, HoldsBothEndsToTheLimits) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  EdgeChecker edges(&checker, 0.05, EdgeCheck::kFixed);
  const std::vector<double> inside = {0.9, 0};
  const std::vector<double> outside = {1.1, 0};
  EXPECT_TRUE(edges.IsValidState(inside));
  EXPECT_FALSE(edges.IsValidState(outside));
  EXPECT_TRUE(edges.IsValidState(std::vector<double>{1.0, 100.0}));
  EXPECT_FALSE(edges.IsValidState(std::vector<double>{std::nan(""), 0}));
  EXPECT_FALSE(edges.IsValidEdge(inside, outside));
  EXPECT_FALSE(edges.IsValidEdge(outside, inside));
  EXPECT_FALSE(edges.IsValidEdge(outside, inside, true));
}

TEST(EdgeCheckerTest, RefusesConfigurationsOfTheWrongSize) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  EdgeChecker edges(&checker, 0.05, EdgeCheck::kFixed);
  const std::vector<double> right = {0, 0};
  const std::vector<double> wrong = {0, 0, 0};
  ExpectInputError([&] { edges.IsValidState(wrong); }, {"3 values", "2 joints"});
  ExpectInputError([&] { edges.IsValidEdge(right, wrong); }, {"3 values"});
  ExpectInputError([&] { edges.IsValidEdge(wrong, right); }, {"3 values"});
  ExpectInputError([&] { edges.NumIntervals(right, {}); }, {"0 values"});
}

TEST(EdgeCheckerTest, FindsACollisionAtAnySample) {
  const Robot robot = MakePendulum();
  const std::vector<double> from = {0.1, 0.2};
  const std::vector<double> to = {0.7, -1.1};
  for (int batch : {1, 8}) {
    ScriptedChecker checker(robot, batch);
    EdgeChecker edges(&checker, 0.05, EdgeCheck::kFixed);
    EXPECT_TRUE(edges.IsValidEdge(from, to));
    const auto samples = checker.asked;
    ASSERT_EQ(static_cast<double>(samples.size()), edges.NumIntervals(from, to) + 1);
    for (const auto& blocked : samples) {
      checker.collides = [&](std::span<const double> q) {
        return std::equal(q.begin(), q.end(), blocked.begin());
      };
      EXPECT_FALSE(edges.IsValidEdge(from, to));
      EXPECT_EQ(edges.IsValidEdge(from, to, true), blocked == from);
    }
  }
}

TEST(EdgeCheckerTest, SamplesTheSameConfigurationsWhateverTheBatch) {
  const Robot robot = MakePendulum();
  const std::vector<double> from = {0.1, 0.2};
  const std::vector<double> to = {0.7, -1.1};
  std::vector<std::vector<double>> one_by_one;
  for (int batch : {1, 3, 8, 64, 1000}) {
    ScriptedChecker checker(robot, batch);
    EdgeChecker edges(&checker, 0.03, EdgeCheck::kFixed);
    EXPECT_TRUE(edges.IsValidEdge(from, to));
    auto asked = checker.asked;
    std::sort(asked.begin(), asked.end());
    EXPECT_EQ(std::adjacent_find(asked.begin(), asked.end()), asked.end()) << "sampled twice";
    if (batch == 1) one_by_one = asked;
    EXPECT_EQ(asked, one_by_one);
    EXPECT_TRUE(std::binary_search(asked.begin(), asked.end(), from));
    EXPECT_TRUE(std::binary_search(asked.begin(), asked.end(), to));
  }
}

TEST(EdgeCheckerTest, SpreadsItsSamples) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  EdgeChecker edges(&checker, 0.125, EdgeCheck::kFixed);
  EXPECT_TRUE(edges.IsValidEdge(std::vector<double>{0, 0}, std::vector<double>{1, 0}));
  std::vector<double> slides;
  for (const auto& q : checker.asked) slides.push_back(q[0]);
  EXPECT_THAT(slides, testing::ElementsAre(1, 0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875));
}

TEST(EdgeCheckerTest, Counts) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  EdgeChecker edges(&checker, 0.125, EdgeCheck::kFixed);
  const std::vector<double> from = {0, 0};
  const std::vector<double> to = {1, 0};
  EXPECT_TRUE(edges.IsValidState(from));
  EXPECT_FALSE(edges.IsValidState(std::vector<double>{2, 0}));
  EXPECT_EQ(edges.counters().states, 2);
  EXPECT_EQ(edges.counters().configurations, 1);
  EXPECT_TRUE(edges.IsValidEdge(from, to));
  EXPECT_TRUE(edges.IsValidEdge(from, to, true));
  EXPECT_EQ(edges.counters().edges, 2);
  EXPECT_EQ(edges.counters().configurations, 1 + 9 + 8);
  checker.collides = [](std::span<const double> q) { return q[0] == 0.25; };
  EXPECT_FALSE(edges.IsValidEdge(from, to));
  EXPECT_EQ(edges.counters().configurations, 1 + 9 + 8 + 4);
  EXPECT_EQ(static_cast<std::int64_t>(checker.asked.size()), edges.counters().configurations);
}

TEST(EdgeCheckerTest, ChecksStatesTogetherAsOneByOne) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 1);
  EdgeChecker edges(&checker, 0.125, EdgeCheck::kFixed);
  checker.collides = [](std::span<const double> q) { return q[0] == 0.25; };
  const double nan = std::nan("");
  const std::vector<double> states = {2, 0, 0.5, 0, 0.25, 0, nan, 0, 1, 0, 0.25, 1, 0.75, 9, -1, 0};
  std::vector<unsigned char> valid(8, 9);
  edges.CheckStates(states, 8, valid);
  EXPECT_THAT(valid, testing::ElementsAre(0, 1, 0, 0, 1, 0, 1, 0));
  EXPECT_EQ(edges.counters().states, 8);
  EXPECT_EQ(edges.counters().configurations, 5);
  edges.CheckStates({}, 0, {});
  std::vector<unsigned char> passed(8, 9);
  edges.ScreenStates(states, 8, passed);  // of an engine to which all is cheap
  EXPECT_EQ(passed, valid);
  EXPECT_EQ(edges.counters().states, 16);
  EXPECT_EQ(edges.counters().configurations, 10);
  ExpectInputError([&] { edges.CheckStates(states, 7, valid); }, {"16 values", "7 states"});
}

TEST(EdgeCheckerTest, EdgesAreGivenUpWhenToldTo) {
  const Robot robot = MakePendulum();
  const std::vector<double> from = {0, 0};
  const std::vector<double> to = {1, 3};
  const std::vector<double> near = {0.01, 0};
  for (const EdgeCheck method : {EdgeCheck::kFixed, EdgeCheck::kCertified}) {
    SCOPED_TRACE(EnumName(method));
    ScriptedChecker checker(robot, 1);
    checker.clearance = 1e-3;
    EdgeChecker edges(&checker, 1e-3, method);
    int num_asked = 0;
    bool goes_on = false;
    edges.StopWhen([&] { return ++num_asked > 3 && !goes_on; });
    EXPECT_FALSE(edges.IsValidEdge(from, to));
    EXPECT_TRUE(edges.Stopped());
    const std::int64_t configurations = edges.counters().configurations;
    EXPECT_GT(configurations, 64);
    EXPECT_LE(configurations, 4 * 64);
    EXPECT_FALSE(edges.IsValidEdge(from, near)) << "though it is short";
    EXPECT_TRUE(edges.GaveUp());
    EXPECT_EQ(edges.FindFreePart(from, near), 0);
    EXPECT_EQ(edges.counters().configurations, configurations);
    goes_on = true;
    EXPECT_TRUE(edges.IsValidEdge(from, near));
    EXPECT_FALSE(edges.GaveUp());
    EXPECT_EQ(edges.FindFreePart(from, to), 1);
    EXPECT_TRUE(edges.Stopped()) << "an edge was given up";
    edges.StopWhen({});
    EXPECT_FALSE(edges.Stopped());
    EXPECT_TRUE(edges.IsValidEdge(from, to));
    EXPECT_GT(edges.counters().configurations - configurations, 4 * 64);
  }
}

TEST(EdgeCheckerTest, FindsHowFarAnEdgeIsFree) {
  const Robot robot = MakePendulum();
  const std::vector<double> from = {0, 0}, to = {1, 0}, outside = {1.5, 0};
  for (const EdgeCheck method : {EdgeCheck::kFixed, EdgeCheck::kCertified}) {
    for (const double first : {0.005, 0.3, 0.77, 0.99}) {
      SCOPED_TRACE(fmt::format("{}, blocked from {}", EnumName(method), first));
      ScriptedChecker checker(robot, 4);
      checker.clearance = 1e-3;
      // A second obstacle behind it, which is found first where it holds the middle.
      checker.collides = [first](std::span<const double> q) {
        return (q[0] >= first && q[0] < first + 0.01) || (q[0] > 0.45 && first < 0.45);
      };
      EdgeChecker edges(&checker, 1e-3, method);
      const double part = edges.FindFreePart(from, to);
      EXPECT_LE(part, first + checker.clearance);
      EXPECT_GE(part, first - 2e-3);
      EXPECT_EQ(edges.counters().edges, 1);
      EXPECT_EQ(edges.FindFreePart(from, outside), 0);
      checker.collides = [](std::span<const double>) { return false; };
      EXPECT_EQ(edges.FindFreePart(from, to), 1);
    }
  }
}

TEST(EdgeCheckerTest, HowFarAnEdgeIsFreeIsTheSameWhateverTheEngineLooksAtFirst) {
  const Robot robot = MakePendulum();
  const std::vector<double> from = {0, 0}, to = {1, 0};
  for (const EdgeCheck method : {EdgeCheck::kFixed, EdgeCheck::kCertified}) {
    for (const double first : {0.0005, 0.3, 0.41}) {
      SCOPED_TRACE(fmt::format("{}, blocked from {}", EnumName(method), first));
      std::vector<double> parts;
      for (const int batch_size : {1, 4, 64}) {
        for (const bool backwards : {false, true}) {
          ScriptedChecker checker(robot, batch_size);
          checker.clearance = 1e-3;
          checker.backwards = backwards;
          checker.collides = [first](std::span<const double> q) {
            return (q[0] >= first && q[0] < first + 0.01) || q[0] > 0.45;
          };
          parts.push_back(EdgeChecker(&checker, 1e-3, method).FindFreePart(from, to));
        }
      }
      EXPECT_THAT(parts, testing::Each(parts.front()));
    }
  }
}

TEST(EdgeCheckerTest, ASampleThatBlocksEndsThePartThatIsFree) {
  const Robot robot = MakePendulum();
  ScriptedChecker checker(robot, 16);
  checker.backwards = true;
  checker.collides = [](std::span<const double> q) { return q[0] == 0.625 || q[0] == 0.875; };
  EdgeChecker edges(&checker, 0.125, EdgeCheck::kFixed);
  EXPECT_EQ(edges.FindFreePart(std::vector<double>{0, 0}, std::vector<double>{1, 0}), 0.5);
}

TEST(EdgeCheckerTest, ManyShortEdgesAreGivenUpAsOneLongOneIs) {
  const Robot robot = MakePendulum();
  for (const EdgeCheck method : {EdgeCheck::kFixed, EdgeCheck::kCertified}) {
    SCOPED_TRACE(EnumName(method));
    ScriptedChecker checker(robot, 1);
    EdgeChecker edges(&checker, 1e-3, method);
    edges.StopWhen([] { return true; });
    const std::vector<double> from = {0, 0}, near = {1e-6, 0};
    int num_free = 0;
    while (num_free < 1000 && edges.IsValidEdge(from, near)) ++num_free;
    EXPECT_TRUE(edges.Stopped());
    EXPECT_GT(num_free, 0);
    EXPECT_LE(edges.counters().configurations, 2 * 64);
  }
}

TEST(EdgeCheckerTest, CertifiesWhatIsAttachedFarAwayWithoutListingTheWholeEdge) {
  const Robot robot = MakePendulum();
  const std::vector<double> from = {0, 0};
  const std::vector<double> to = {0, 2};
  const auto box_at = [](const std::string& id, const Eigen::Vector3d& place) {
    SceneObject box{.id = id, .shapes = {{.shape = Box{{1, 1, 1}}}}};
    box.X_WO.translation() = place;
    return box;
  };
  for (const auto make : {MakeCollisionChecker, MakeReferenceChecker}) {
    const auto checker = make(robot, robot.groups.front(), CollisionModel::kSpheres);
    SCOPED_TRACE(checker->EngineName());
    EdgeChecker edges(checker.get(), 0.02, EdgeCheck::kCertified);
    for (const double distance : {2e3, 1e5, 9e8}) {
      SCOPED_TRACE(distance);
      Scene scene;
      scene.attached = {{"rod", box_at("tool", {distance, 0, 0}), {}}};
      checker->SetScene(scene, robot.model.DefaultPositions());
      const std::int64_t before = edges.counters().configurations;
      EXPECT_TRUE(edges.IsValidEdge(from, to));
      EXPECT_LE(edges.counters().configurations - before, 10'000);
    }
    const double distance = 1e5;
    Scene scene;
    scene.attached = {{"rod", box_at("tool", {distance, 0, 0}), {}}};
    scene.objects = {box_at("wall", {distance * std::cos(1.3), distance * std::sin(1.3), 0})};
    checker->SetScene(scene, robot.model.DefaultPositions());
    EXPECT_FALSE(edges.IsValidEdge(from, to));
  }
}

}  // namespace
}  // namespace planbench
