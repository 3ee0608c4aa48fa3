#pragma once

// What every collision engine must do, as a GoogleTest suite. To put an engine under it:
//
//   INSTANTIATE_TEST_SUITE_P(MyEngine, CollisionCheckerContract, testing::Values(CollisionEngine{
//       "my_engine", [](const Robot& robot, const PlanningGroup& group) { return ...; }}));
//
// in a program with the tests, tests/contract/collision_*.cc. The suite is for engines that check
// the robot's spheres; the oracle checks all of them against everything, in double precision.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <ostream>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "collision/collision_checker.h"
#include "robot_model/full_positions.h"
#include "tests/contract/collision_oracle.h"

namespace planbench {

struct CollisionEngine {
  std::string name;
  std::function<std::unique_ptr<CollisionChecker>(const Robot&, const PlanningGroup&)> make;
  /// Largest error of the engine's distances, m. Configurations nearer to contact than this are not
  /// judged.
  double tolerance_m = 1e-9;

  friend std::ostream& operator<<(std::ostream& stream, const CollisionEngine& engine) {
    return stream << engine.name;
  }
};

class CollisionCheckerContract : public testing::TestWithParam<CollisionEngine> {
 protected:
  std::unique_ptr<CollisionChecker> Make(const Robot& robot) const {
    return GetParam().make(robot, robot.groups.front());
  }
  double tolerance() const { return GetParam().tolerance_m; }
  /// Positions of the test arm's held joint: the finger opened.
  static std::vector<double> ArmBase(const Robot& arm, double finger = 0.1) {
    return FullPositions(arm.model, {"finger_joint"}, {finger}, "test");
  }
  static std::vector<double> Configurations(const JointSpace& space, int num, unsigned seed) {
    std::mt19937_64 generator(seed);
    std::vector<double> qs;
    for (int i = 0; i < num; ++i) {
      const auto q = RandomConfiguration(space, &generator);
      qs.insert(qs.end(), q.begin(), q.end());
    }
    return qs;
  }
  static std::span<const double> Row(const std::vector<double>& qs, int n, int i) {
    return std::span(qs).subspan(static_cast<std::size_t>(i) * static_cast<std::size_t>(n),
                                 static_cast<std::size_t>(n));
  }
  /// A configuration of the rail robot.
  static std::vector<double> Slide(double z) { return {z}; }
};

inline Eigen::Isometry3d Shifted(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

}  // namespace planbench
