#include "collision/simd/kernels/scratch.h"

#include <algorithm>
#include <numeric>

namespace planbench::kernels {
namespace {

/// Levels of the deepest tree of balls.
std::size_t DepthOf(const std::vector<Node>& nodes) {
  std::vector<std::size_t> depths(nodes.size(), 1);
  std::size_t deepest = 0;
  for (std::size_t i = nodes.size(); i-- > 0;) {
    for (std::int32_t k = 0; k < nodes[i].num_children; ++k) {
      depths[i] =
          std::max(depths[i], 1 + depths[static_cast<std::size_t>(nodes[i].first_child + k)]);
    }
    deepest = std::max(deepest, depths[i]);
  }
  return deepest;
}

}  // namespace

SphereScratch::SphereScratch() : buffers_(std::make_unique<Buffers>()) {}
SphereScratch::~SphereScratch() = default;
SphereScratch::SphereScratch(SphereScratch&&) noexcept = default;
SphereScratch& SphereScratch::operator=(SphereScratch&&) noexcept = default;

void SphereScratch::ForgetOpen() {
  Buffers& b = *buffers_;
  for (const std::int32_t test : b.open) b.is_open[static_cast<std::size_t>(test)] = 0;
  b.open.clear();
  b.knows_open = false;
}

void SphereScratch::Reset(const SphereRobot& robot, const SphereWorld& world) {
  Buffers& b = *buffers_;
  if (b.num_bodies < robot.bodies.size()) {
    b.num_bodies = robot.bodies.size();
    b.poses = hwy::AllocateAligned<float>(b.num_bodies * 12 * kBlock);
    std::fill_n(b.poses.get(), 12 * kBlock, 0.0f);
    for (int k : {0, 4, 8}) std::fill_n(b.poses.get() + k * kBlock, kBlock, 1.0f);
  }
  if (b.num_nodes < robot.nodes.size()) {
    b.num_nodes = robot.nodes.size();
    b.positions = hwy::AllocateAligned<float>(b.num_nodes * 3 * kBlock);
  }
  b.width_sums =
      hwy::AllocateAligned<float>(static_cast<std::size_t>(robot.num_joints + 1) * kBlock);
  b.placed.assign(2 * robot.nodes.size(), 0);
  b.placement = 0;
  b.order.resize(world.trees.size());
  std::iota(b.order.begin(), b.order.end(), 0);
  for (std::size_t i = 0; i < robot.pairs.size(); ++i) {
    b.order.push_back(static_cast<std::int32_t>(world.trees.size() + i));
    i += static_cast<std::size_t>(robot.pairs[i].num_behind);
  }
  b.planes.fill({});
  b.open.clear();
  b.open.reserve(b.order.size());
  b.is_open.assign(world.trees.size() + robot.pairs.size(), 0);
  b.knows_open = false;
  b.all_solids.resize(world.solids.size());
  std::iota(b.all_solids.begin(), b.all_solids.end(), 0);
  b.lists.resize(world.solids.size() * DepthOf(robot.nodes));
}

}  // namespace planbench::kernels
