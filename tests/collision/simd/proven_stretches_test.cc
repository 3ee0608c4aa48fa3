// How far stretches of motions are proven free for meshes: never beyond what is free, and further
// than a bound on the motion in any direction would prove.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "collision/fcl/fcl_checker.h"
#include "collision/simd/simd_checker.h"
#include "common/random.h"
#include "robot_model/full_positions.h"
#include "tests/contract/collision_test_worlds.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trials.h"

namespace planbench {
namespace {

/// Two arms of boxes on a base, either of which the other meets: one slides along a slanted axis.
Robot MakeTwoArms() {
  const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                        const std::string& child, const std::string& origin,
                        const std::string& axis, const std::string& limit) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin " + origin + "/><axis xyz='" + axis +
           "'/><limit " + limit + " velocity='1' effort='1'/></joint>";
  };
  const auto link = [](const std::string& name, const std::string& size) {
    return "<link name='" + name + "'><collision><origin xyz='0.15 0 0'/><geometry><box size='" +
           size + "'/></geometry></collision></link>";
  };
  const std::string turn = "lower='-2.5' upper='2.5'";
  Robot robot;
  robot.name = "two_arms";
  robot.model = RobotModel::FromUrdf(
      "<robot name='two_arms'>" + link("base", "0.1 0.2 0.1") + link("left0", "0.25 0.06 0.1") +
          link("left1", "0.3 0.05 0.04") + link("left2", "0.28 0.08 0.02") +
          link("right0", "0.3 0.07 0.07") + link("right1", "0.28 0.04 0.09") +
          joint("slide", "prismatic", "base", "left0", "xyz='0 0.2 0.1' rpy='0 0 0.4'",
                "0.3 0.2 0.9", "lower='-0.2' upper='0.3'") +
          joint("left_lift", "revolute", "left0", "left1", "xyz='0.3 0 0' rpy='0.3 0 -0.5'",
                "0 1 0", turn) +
          joint("left_turn", "revolute", "left1", "left2", "xyz='0.3 0 0'", "0.2 0.1 1", turn) +
          joint("right_turn", "revolute", "base", "right0", "xyz='0 -0.2 0.1'", "0 0 1", turn) +
          joint("right_roll", "revolute", "right0", "right1", "xyz='0.3 0 0'", "1 1 0.3", turn) +
          "</robot>",
      "two_arms.urdf");
  robot.groups = {robot.model.MakeGroup(
      "arms", {"slide", "left_lift", "left_turn", "right_turn", "right_roll"}, "left2")};
  return robot;
}

class ProvenStretches {
 public:
  ProvenStretches(const Robot& robot, const std::vector<double>& base)
      : space_(robot.groups.front().space),
        base_(base),
        fast_(robot, robot.groups.front(), CollisionModel::kMeshes),
        exact_(robot, robot.groups.front(), CollisionModel::kMeshes) {}

  /// The longest stretches that are proven, about random configurations along random motions.
  void TryIn(const Scene& scene, int num) {
    fast_.SetScene(scene, base_);
    exact_.SetScene(scene, base_);
    for (int i = 0; i < num; ++i) {
      Draw();
      const auto proven = [&](double half_length) {
        const MotionSample sample{0.5, half_length};
        return fast_.CheckSamples(start_, motion_, {&sample, 1}).blocked == 0;
      };
      if (!proven(0)) continue;
      double free = 0;
      double blocked = 0.5;
      if (proven(blocked)) continue;  // nothing is near
      for (int k = 0; k < 20; ++k) {
        const double middle = (free + blocked) / 2;
        (proven(middle) ? free : blocked) = middle;
      }
      ExpectFree(free);
      const double distance = exact_.FindClosest(At(0.5)).distance_m;
      double motion_m = 0;
      for (std::size_t j = 0; j < motion_.size(); ++j) {
        motion_m += std::abs(motion_[j]) * exact_.motion_bound().reach()[j];
      }
      gain_ += free * motion_m / distance;
      ++num_;
    }
  }

  int num() const { return num_; }
  /// How many times as long as the distance and the bound on the whole robot's motion tell, in the
  /// mean.
  double gain() const { return gain_ / num_; }

 private:
  /// A motion of at most 0.4 rad or m a joint, within the limits.
  void Draw() {
    do {
      start_.clear();
      motion_.clear();
      for (int j = 0; j < space_.size(); ++j) {
        start_.push_back(3 * (2 * UniformFraction(&random_) - 1));
        motion_.push_back(0.8 * UniformFraction(&random_) - 0.4);
      }
    } while (!space_.WithinLimits(At(0)) || !space_.WithinLimits(At(1)));
  }

  std::vector<double> At(double fraction) const {
    std::vector<double> q = start_;
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += fraction * motion_[j];
    return q;
  }

  void ExpectFree(double half_length) {
    constexpr int kSamples = 40;
    for (int k = -kSamples; k <= kSamples; ++k) {
      EXPECT_TRUE(exact_.IsFree(At(0.5 + half_length * k / kSamples)));
    }
  }

  const JointSpace& space_;
  std::vector<double> base_;
  SimdChecker fast_;
  FclChecker exact_;
  std::mt19937_64 random_{5};
  std::vector<double> start_, motion_;
  int num_ = 0;
  double gain_ = 0;
};

TEST(ProvenStretchesTest, OfAnArmAmongSolidsAreFree) {
  const TemporaryFolder folder;
  const Robot robot = MakeSolidTestArm(folder.path());
  ProvenStretches stretches(robot, FullPositions(robot.model, {"finger_joint"}, {0.1}, "test"));
  for (const NamedScene& world : MakeTestScenes()) {
    SCOPED_TRACE(world.what);
    stretches.TryIn(world.scene, Trials(60));
  }
  EXPECT_GT(stretches.num(), Trials(200));
  EXPECT_GT(stretches.gain(), 1.5);
}

TEST(ProvenStretchesTest, OfTwoArmsThatMeetAreFree) {
  const Robot robot = MakeTwoArms();
  ProvenStretches stretches(robot, FullPositions(robot.model, {}, {}, "test"));
  stretches.TryIn({}, Trials(800));
  EXPECT_GT(stretches.num(), Trials(150));
  // 2.5 by bounds on motions in any direction alone.
  EXPECT_GT(stretches.gain(), 3.2);
}

}  // namespace
}  // namespace planbench
