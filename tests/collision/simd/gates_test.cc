#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "collision/simd/compiled_scene.h"
#include "collision/simd/kernels/sphere_kernel.h"
#include "common/random.h"
#include "robot_model/full_positions.h"
#include "robot_model/robot_folder.h"

namespace planbench {
namespace {

using kernels::kBlock;

/// The same robot, all of whose pairs are tested.
kernels::SphereRobot WithoutGates(kernels::SphereRobot robot) {
  std::erase_if(robot.pairs, [](const kernels::TreePair& pair) { return pair.num_behind > 0; });
  return robot;
}

/// By [joint][kBlock].
class Lanes {
 public:
  explicit Lanes(const JointSpace& space)
      : space_(space),
        q_(static_cast<std::size_t>(space.size() * kBlock)),
        half_widths_(q_.size()) {}

  /// Everywhere within the limits, one in eight at one of them; boxes of up to so much (rad or m).
  void Draw(double widest, std::mt19937_64* generator) {
    for (std::size_t i = 0; i < q_.size(); ++i) {
      const JointSpace::Joint& joint = space_.joint(static_cast<int>(i) / kBlock);
      const double place = UniformFraction(generator) * 1.25 - 0.125;
      const double q = std::lerp(joint.lower, joint.upper, std::clamp(place, 0.0, 1.0));
      q_[i] = static_cast<float>(joint.prismatic ? q : std::remainder(q, 2 * std::numbers::pi));
      half_widths_[i] = static_cast<float>(widest * UniformFraction(generator));
    }
  }
  /// The same with every lane's configuration anywhere in its box.
  std::vector<float> WithinBoxes(std::mt19937_64* generator) const {
    std::vector<float> q = q_;
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] += half_widths_[i] * static_cast<float>(2 * UniformFraction(generator) - 1);
    }
    return q;
  }
  const float* q() const { return q_.data(); }
  const float* half_widths() const { return half_widths_.data(); }

 private:
  const JointSpace& space_;
  std::vector<float> q_, half_widths_;
};

kernels::LaneMask Hits(const kernels::SphereRobot& robot, const float* q,
                       const float* half_widths) {
  const kernels::SphereWorld nothing;
  kernels::SphereScratch scratch;
  scratch.Reset(robot, nothing);
  kernels::BlockQuery query;
  query.q = q;
  query.half_widths = half_widths;
  query.lanes = (1u << kBlock) - 1;
  return kernels::CheckBlock(robot, nothing, &scratch, query).hits;
}

/// `num_tables`: at least so many gates with tables.
void ExpectGatesHideNothing(const std::string& robot_name, CollisionModel model,
                            std::size_t num_tables) {
  SCOPED_TRACE(robot_name + ", " + std::string(EnumName(model)));
  const Robot robot = LoadRobot(PLANBENCH_SOURCE_DIR "/robots/" + robot_name);
  const PlanningGroup& group = robot.groups.front();
  CompiledScene compiled(robot, group, model);
  compiled.Set(Scene(), FullPositions(robot.model, {}, {}, "test"), nullptr);
  const kernels::SphereRobot& gated = compiled.robot();
  const kernels::SphereRobot all = WithoutGates(gated);
  EXPECT_LT(all.pairs.size(), gated.pairs.size());
  EXPECT_GE(gated.tables.size(), num_tables);

  std::mt19937_64 generator(1);
  Lanes lanes(group.space);
  int num_hits = 0;
  for (int block = 0; block < 1'000; ++block) {
    lanes.Draw(block % 2 == 0 ? 0.02 : 0.2, &generator);
    const kernels::LaneMask hits = Hits(all, lanes.q(), nullptr);
    EXPECT_EQ(Hits(gated, lanes.q(), nullptr), hits);
    num_hits += hits != 0 ? 1 : 0;
    // Gates may prove of a box what its pairs cannot, but nothing that is not so.
    const kernels::LaneMask around = Hits(gated, lanes.q(), lanes.half_widths());
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(Hits(all, lanes.WithinBoxes(&generator).data(), nullptr) & ~around, 0u);
    }
  }
  EXPECT_GT(num_hits, 100);
}

TEST(GatesTest, HideNothing) {
  ExpectGatesHideNothing("fetch", CollisionModel::kSpheres, 1);
  ExpectGatesHideNothing("fetch", CollisionModel::kEnclosing, 2);
  ExpectGatesHideNothing("panda", CollisionModel::kSpheres, 1);
  ExpectGatesHideNothing("panda", CollisionModel::kMeshes, 1);
  ExpectGatesHideNothing("ur5e", CollisionModel::kMeshes, 1);
}

}  // namespace
}  // namespace planbench
