// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_CHECK_PASS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_CHECK_PASS_INL_H_
#undef PLANBENCH_KERNELS_CHECK_PASS_INL_H_
#else
#define PLANBENCH_KERNELS_CHECK_PASS_INL_H_
#endif

#include <limits>
#include <utility>

#include "collision/simd/kernels/meshes-inl.h"
#include "collision/simd/kernels/nearby-inl.h"
#include "collision/simd/kernels/placement-inl.h"
#include "collision/simd/kernels/solids-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// The verdict pass. kAround: with half widths.
template <bool kAround>
class CheckPass {
 public:
  CheckPass(const SphereRobot& robot, const SphereWorld& world, SphereScratch::Buffers* buffers,
            const BlockQuery& query, int lane, M alive)
      : robot_(robot),
        world_(world),
        buffers_(*buffers),
        query_(query),
        lane_(lane),
        placement_(robot, buffers, query.q, lane),
        alive_(alive),
        hits_(hn::FirstN(Lanes(), 0)),
        certain_(hn::FirstN(Lanes(), 0)),
        doubts_(hn::FirstN(Lanes(), 0)) {}

  void Run() {
    auto& order = buffers_.order;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const int test = order[i];
      const int num_trees = static_cast<int>(world_.trees.size());
      const bool found = test < num_trees
                             ? TestWorld(world_.trees[static_cast<std::size_t>(test)])
                             : TestPair(robot_.pairs[static_cast<std::size_t>(test - num_trees)]);
      if (!found) continue;
      // One step to the front at a time: what hits often comes early.
      if (i > 0) std::swap(order[i], order[i - 1]);
      if ((query_.stop_at_first && !None(certain_)) || None(alive_)) return;
    }
  }

  LaneMask hits() const { return Bits(hits_); }
  LaneMask certain() const { return Bits(certain_); }
  LaneMask doubts() const { return Bits(hn::AndNot(certain_, doubts_)); }

 private:
  HWY_INLINE V HalfWidth(int joint) const {
    return hn::LoadU(Lanes(), query_.half_widths + joint * kBlock + lane_);
  }

  /// Upper bound of the motion of a tree relative to what it is tested against, over the box.
  HWY_INLINE V Motion(int reach) const {
    V sum = Zero();
    if constexpr (kAround) {
      const float* weights = robot_.reaches.data() + reach;
      for (int j = 0; j < robot_.num_joints; ++j) {
        if (weights[j] != 0) sum = hn::MulAdd(Fill(weights[j]), HalfWidth(j), sum);
      }
    }
    return sum;
  }

  /// The same of two balls relative to each other, by the joints that move their trees so: less, as
  /// a tree's bound is that of its furthest balls.
  HWY_INLINE V MotionBetween(const Node& a, const Node& b, int tree_reach) const {
    V sum = Zero();
    const float* moves = robot_.reaches.data() + tree_reach;
    const float* weights_a = robot_.reaches.data() + a.reach;
    const float* weights_b = robot_.reaches.data() + b.reach;
    for (int j = 0; j < robot_.num_joints; ++j) {
      if (moves[j] != 0) sum = hn::MulAdd(Fill(weights_a[j] + weights_b[j]), HalfWidth(j), sum);
    }
    return sum;
  }

  /// Radius grown by the motion; lanes not proven free already matter no more but for certainty.
  HWY_INLINE V Grown(float radius, V motion) const {
    if constexpr (kAround) return Fill(radius) + hn::IfThenZeroElse(hits_, motion);
    return Fill(radius);
  }

  /// Takes note of balls (of one node, or the sum of a pair) of a radius that come within `grown`.
  /// Returns true to stop.
  HWY_INLINE bool Note(V squared, float radius, M touching, bool doubtful) {
    touching = hn::And(touching, alive_);
    if (None(touching)) return false;
    if (doubtful) {
      doubts_ = hn::Or(doubts_, touching);
      return false;
    }
    hits_ = hn::Or(hits_, touching);
    M certain = touching;
    if constexpr (kAround) {
      certain = hn::And(certain, hn::Le(squared, Fill(radius * radius)));
      if (None(certain)) return false;
    }
    certain_ = hn::Or(certain_, certain);
    alive_ = hn::AndNot(certain, alive_);
    return query_.stop_at_first || None(alive_);
  }

  bool TestWorld(const WorldTree& tree) {
    const bool on_grid = world_.grid && !tree.doubtful;
    if (tree.num_candidates == 0 && !on_grid) return false;
    const M before = certain_;
    placement_.PlaceRoot(tree.root, tree.body);
    const V motion = Motion(tree.reach);
    doubtful_ = tree.doubtful;
    if (on_grid) VisitGrid(tree.root, tree.body, motion);
    if (tree.num_candidates >= 0) {
      if (tree.num_candidates > 0) {
        VisitWorld(tree.root, tree.body, motion, world_.candidates.data() + tree.first_candidate,
                   tree.num_candidates, buffers_.lists.data());
      }
    } else {
      std::int32_t* list = buffers_.lists.data();
      const V reach = Grown(placement_.node(tree.root).radius, motion);
      const int num = ListNear(world_, placement_.Position(tree.root), reach, alive_, list);
      if (num > 0) VisitWorld(tree.root, tree.body, motion, list, num, list + num);
    }
    return !None(hn::AndNot(before, certain_));
  }

  /// Tests a subtree against the solids of a list; `free_list` is memory for further lists. Returns
  /// true to stop.
  bool VisitWorld(int index, int body, V motion, const std::int32_t* list, int num,
                  std::int32_t* free_list) {
    const Node& node = placement_.node(index);
    const Points p = placement_.Position(index);
    if (node.num_children == 0) return TestLeaf(node, p, motion, list, num);
    const V grown = Grown(node.radius, motion);
    const V reach = Squared(grown);
    int num_near = 0;
    for (int i = 0; i < num; ++i) {
      const Solid& solid = world_.solids[static_cast<std::size_t>(list[i])];
      const M near = hn::And(alive_, hn::Le(SquaredDistance(solid, p), reach));
      free_list[num_near] = list[i];
      num_near += !None(near) && MayBeNear(world_, solid, p, grown, near) ? 1 : 0;
    }
    if (num_near == 0) return false;
    placement_.PlaceChildren(index, body);
    for (int i = 0; i < node.num_children; ++i) {
      if (VisitWorld(node.first_child + i, body, motion, free_list, num_near,
                     free_list + num_near)) {
        return true;
      }
    }
    return false;
  }

  HWY_INLINE bool TestLeaf(const Node& node, const Points& p, V motion, const std::int32_t* list,
                           int num) {
    const V grown = Grown(node.radius, motion);
    V reach = Squared(grown);
    V least = Fill(std::numeric_limits<float>::max());
    for (int i = 0; i < num; ++i) {
      const Solid& solid = world_.solids[static_cast<std::size_t>(list[i])];
      V squared = SquaredDistance(solid, p);
      if (HWY_UNLIKELY(solid.mesh >= 0)) {
        squared =
            SquaredMeshDistance(world_, solid, p, grown, hn::And(alive_, hn::Le(squared, reach)));
      }
      if (HWY_UNLIKELY(solid.doubtful)) {
        Note(squared, node.radius, hn::Le(squared, reach), true);
      } else {
        least = hn::Min(least, squared);
      }
    }
    if constexpr (kAround) {
      if (None(hn::And(alive_, hn::Le(least, reach)))) return false;
      reach = Squared(Grown(node.radius, Motion(node.reach)));
    }
    return Note(least, node.radius, hn::Le(least, reach), doubtful_);
  }

  bool VisitGrid(int index, int body, V motion) {
    const Node& node = placement_.node(index);
    const Points p = placement_.Position(index);
    const DistanceGrid& grid = *world_.grid;
    if (node.num_children == 0) {
      if constexpr (kAround) {
        const M open = hn::AndNot(hits_, alive_);
        if (!None(open)) {
          hits_ = hn::Or(hits_, MeetsGridAround(grid, p, Motion(node.reach), node.radius, open));
        }
      }
      // Note compares squares; what is certain is compared here.
      const V distance = GridDistance(grid, p, grid.outside);
      return Note(Zero(), node.radius, hn::Lt(distance, Fill(node.radius)), false);
    }
    // Nothing is known of what a ball of balls outside of the grid has inside of it.
    const V limit = Grown(node.radius, motion) + Fill(GridSlack(grid));
    if (None(hn::And(alive_, hn::Lt(GridDistance(grid, p, 0.0f), limit)))) return false;
    placement_.PlaceChildren(index, body);
    for (int i = 0; i < node.num_children; ++i) {
      if (VisitGrid(node.first_child + i, body, motion)) return true;
    }
    return false;
  }

  bool TestPair(const TreePair& pair) {
    placement_.PlaceRoot(pair.root_a, pair.body_a);
    placement_.PlaceRoot(pair.root_b, pair.body_b);
    doubtful_ = pair.doubtful;
    pair_reach_ = pair.reach;
    const V motion = Motion(pair.reach);
    const M before = certain_;
    const Node& node_a = placement_.node(pair.root_a);
    const Node& node_b = placement_.node(pair.root_b);
    const float radius = node_a.radius + node_b.radius;
    const V squared =
        SquaredNorm(placement_.Position(pair.root_b) - placement_.Position(pair.root_a));
    const M touching = Within(squared, Grown(radius, motion));
    if (None(touching)) return false;
    if (node_a.num_children == 0 && node_b.num_children == 0) {
      NotePair(node_a, node_b, squared, radius, touching);
    } else {
      VisitPair(pair.root_a, pair.body_a, pair.root_b, pair.body_b, motion);
    }
    return !None(hn::AndNot(before, certain_));
  }

  HWY_INLINE M Within(V squared, V grown) const {
    return hn::And(alive_, hn::Le(squared, Squared(grown)));
  }

  /// Two leaves that touch by the bound of their trees.
  HWY_INLINE bool NotePair(const Node& a, const Node& b, V squared, float radius, M touching) {
    if constexpr (kAround) {
      touching = Within(squared, Grown(radius, MotionBetween(a, b, pair_reach_)));
    }
    return Note(squared, radius, touching, doubtful_);
  }

  /// Two balls that touch, not both of them leaves. Returns true to stop.
  bool VisitPair(int a, int body_a, int b, int body_b, V motion) {
    {
      // The larger one is replaced by its children.
      const Node& node_a = placement_.node(a);
      const Node& node_b = placement_.node(b);
      if (node_a.num_children == 0 || (node_b.num_children != 0 && node_a.radius < node_b.radius)) {
        std::swap(a, b);
        std::swap(body_a, body_b);
      }
    }
    const Node& large = placement_.node(a);
    const Node& small = placement_.node(b);
    placement_.PlaceChildren(a, body_a);
    const Points p = placement_.Position(b);
    for (int i = 0; i < large.num_children; ++i) {
      const int child = large.first_child + i;
      const Node& node = placement_.node(child);
      const float radius = node.radius + small.radius;
      const V squared = SquaredNorm(placement_.Position(child) - p);
      const M touching = Within(squared, Grown(radius, motion));
      if (None(touching)) continue;
      if (node.num_children == 0 && small.num_children == 0) {
        if (NotePair(node, small, squared, radius, touching)) return true;
      } else if (VisitPair(child, body_a, b, body_b, motion)) {
        return true;
      }
    }
    return false;
  }

  const SphereRobot& robot_;
  const SphereWorld& world_;
  SphereScratch::Buffers& buffers_;
  const BlockQuery& query_;
  int lane_;
  Placement placement_;
  M alive_;  ///< Lanes whose verdict is not certain yet.
  M hits_;   ///< See BlockVerdict.
  M certain_;
  M doubts_;
  // Of the test at hand.
  bool doubtful_ = false;
  int pair_reach_ = 0;
};

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
