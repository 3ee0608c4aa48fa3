// Tables of how far bodies are apart that few joints move relative to each other. Links that stand
// beside each other whatever these joints do touch by their balls nearly always.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "collision/at.h"
#include "collision/simd/compiled_robot.h"

namespace planbench {
namespace {

using kernels::Node;

/// How far the moving body gets over half a cell, m, along each axis of a table.
constexpr double kCellMotion = 0.005;
constexpr int kMostCells = 64;          ///< Along an axis.
constexpr double kNearHalfTurn = 3.14;  ///< rad
/// Between bounds that a table can tell, m; it has 256.
constexpr double kStep = 0.00025;
/// A table that knows no bound above zero in more of its cells does not serve.
constexpr double kMostZeros = 0.5;

/// A ball in a frame whose z axis a joint turns about, wherever that is.
Ball TurnedAboutZ(const Ball& ball) {
  return {{0, 0, ball.center.z()}, ball.radius + ball.center.head<2>().norm()};
}

}  // namespace

double CompiledRobot::Apart(const CompiledTree& link, const Ball& ball_G, double at_most) const {
  const Eigen::Vector3d center_C = At(R_CG_, link.body) * ball_G.center;
  const auto apart_from = [&](const Node& node) {
    const Eigen::Vector3d other_C = Eigen::Map<const Eigen::Vector3f>(node.center).cast<double>();
    return (other_C - center_C).norm() - node.radius - ball_G.radius;
  };
  if (apart_from(At(kernel.nodes, link.root)) >= at_most) return at_most;
  bool is_near_patch = false;
  std::vector<int> open = {link.root};
  while (!open.empty()) {
    const Node& node = At(kernel.nodes, open.back());
    open.pop_back();
    const double apart = apart_from(node);
    if (apart >= at_most || (is_near_patch && node.patch >= 0)) continue;
    if (node.num_children == 0) {
      is_near_patch = is_near_patch || node.patch >= 0;
      if (node.patch < 0) at_most = apart;
    }
    for (int k = 0; k < node.num_children; ++k) open.push_back(node.first_child + k);
  }
  if (!is_near_patch || at_most + ball_G.radius <= 0) return at_most;
  const Eigen::Vector3d center_L = rigid_bodies_.X_GL(link.link).InverseTimes(ball_G.center);
  return link.meshes->surface.Distance(center_L, at_most + ball_G.radius) - ball_G.radius;
}

int CompiledRobot::TableOf(const CompiledTree& carrier, const CompiledTree& moving,
                           const kernels::Reach& reach) {
  const auto [entry, is_new] = tables_.try_emplace({carrier.body, moving.body}, -1);
  if (is_new) {
    if (std::optional<kernels::JointTable> table = MakeTable(carrier, moving, reach)) {
      entry->second = static_cast<int>(kernel.tables.size());
      kernel.tables.push_back(*std::move(table));
    }
  }
  return entry->second;
}

std::optional<kernels::JointTable> CompiledRobot::MakeTable(const CompiledTree& carrier,
                                                            const CompiledTree& moving,
                                                            const kernels::Reach& reach) const {
  // The joint nearest to the carrier comes last.
  const std::vector<int> joints = rigid_bodies_.JointsBelowCommon(moving.body, carrier.body);
  const bool turns_last = !At(kernel.bodies, moving.body).prismatic;
  if (!rigid_bodies_.Descends(moving.body, carrier.body) || joints.size() < 2 ||
      joints.size() > (turns_last ? 3 : 2)) {
    return std::nullopt;
  }
  // Where a third joint takes a ball, it is in another one about that joint's axis.
  const Eigen::Matrix3d& R_CG = At(R_CG_, moving.body);
  std::vector<Ball> balls = BallsOf(moving);
  for (Ball& ball : balls) {
    if (joints.size() < 3) break;
    ball = TurnedAboutZ({R_CG * ball.center, ball.radius});
    ball.center = R_CG.transpose() * ball.center;
  }

  kernels::JointTable table{};
  table.step = static_cast<float>(kStep);
  std::array<int, 2> size{};
  std::array<double, 2> lower{}, cell{};
  double motion = kRadiusPadding;  // from the middle of a cell
  for (std::size_t k = 0; k < 2; ++k) {
    const int joint_index = *(joints.rbegin() + static_cast<std::ptrdiff_t>(k));
    const JointSpace::Joint& joint = group_->space.joint(joint_index);
    const double weight = At(kernel.reaches, reach.first + joint_index);
    // The kernels bring angles within half a turn.
    const bool wraps =
        !joint.prismatic && (joint.lower < -kNearHalfTurn || joint.upper > kNearHalfTurn);
    lower[k] = wraps ? -std::numbers::pi : joint.lower;
    const double range = (wraps ? std::numbers::pi : joint.upper) - lower[k];
    const double num_cells = std::ceil(range * weight / (2 * kCellMotion));
    size[k] = static_cast<int>(std::clamp(num_cells, 1.0, 1.0 * kMostCells));
    cell[k] = range / size[k];
    // Single precision may take a position for one in the next cell.
    motion += weight * (0.501 * cell[k] + JointSpace::kLimitTolerance);
    table.joints[k] = joint_index;
    table.low[k] = static_cast<float>(lower[k]);
    table.cells_per[k] = size[k] > 1 ? static_cast<float>(1 / cell[k]) : 0.0f;
    table.size[k] = static_cast<float>(size[k]);
  }

  const auto num_cells = static_cast<std::size_t>(size[0] * size[1]);
  table.values.resize((num_cells + 3) / 4);
  std::vector<double> q(static_cast<std::size_t>(group_->space.size()), 0.0);
  std::vector<Pose> X_WG(static_cast<std::size_t>(rigid_bodies_.size()));
  std::size_t num_zeros = 0;
  for (std::size_t index = 0; index < num_cells; ++index) {
    const std::array<int, 2> at = {static_cast<int>(index) % size[0],
                                   static_cast<int>(index) / size[0]};
    for (std::size_t k = 0; k < 2; ++k) {
      At(q, table.joints[k]) = lower[k] + (at[k] + 0.5) * cell[k];
    }
    rigid_bodies_.ComputePoses(q, X_WG);
    const Pose X_AB = At(X_WG, carrier.body).Inverse() * At(X_WG, moving.body);
    double apart = motion + 255 * kStep;
    for (std::size_t i = 0; i < balls.size() && apart > motion; ++i) {
      const Ball ball{X_AB * balls[i].center, balls[i].radius};
      for (const CompiledTree& link : links) {
        if (link.body == carrier.body) apart = Apart(link, ball, apart);
      }
      // What is near in this cell is so in the next: it is asked first.
      if (apart <= motion) std::swap(balls[i], balls.front());
    }
    const auto number = static_cast<std::uint32_t>(std::max(0.0, apart - motion) / kStep);
    table.values[index / 4] |= number << (8 * (index % 4));
    num_zeros += number == 0 ? 1 : 0;
  }
  if (static_cast<double>(num_zeros) > kMostZeros * static_cast<double>(num_cells)) {
    return std::nullopt;
  }
  return table;
}

}  // namespace planbench
