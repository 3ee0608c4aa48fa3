// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_DISTANCE_PASS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_DISTANCE_PASS_INL_H_
#undef PLANBENCH_KERNELS_DISTANCE_PASS_INL_H_
#else
#define PLANBENCH_KERNELS_DISTANCE_PASS_INL_H_
#endif

#include <limits>

#include "collision/simd/kernels/meshes-inl.h"
#include "collision/simd/kernels/nearby-inl.h"
#include "collision/simd/kernels/placement-inl.h"
#include "collision/simd/kernels/solids-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// The distance pass: branch and bound over the same trees.
class DistancePass {
 public:
  DistancePass(const SphereRobot& robot, const SphereWorld& world, SphereScratch::Buffers* buffers,
               const float* q, int lane, float at_most)
      : world_(world),
        buffers_(*buffers),
        placement_(robot, buffers, q, lane),
        best_(Fill(at_most)) {
    const int num_trees = static_cast<int>(world.trees.size());
    for (const int test : buffers_.order) {
      if (test < num_trees) {
        TestWorld(world.trees[static_cast<std::size_t>(test)]);
        continue;
      }
      TestPair(&robot.pairs[static_cast<std::size_t>(test - num_trees)]);
    }
  }
  V best() const { return best_; }

 private:
  /// True if some lane's squared distance between centres leaves room to improve, by balls of that
  /// radius.
  HWY_INLINE bool Improves(V squared, V radius) const {
    return !None(hn::Lt(squared, Squared(Positive(best_ + radius))));
  }
  HWY_INLINE bool Improves(const Solid& solid, const Points& p, V radius) const {
    const V reach = Positive(best_ + radius);
    const M near = hn::Lt(SquaredDistance(solid, p), Squared(reach));
    return !None(near) && MayBeNear(world_, solid, p, reach, near);
  }

  void TestWorld(const WorldTree& tree) {
    placement_.PlaceRoot(tree.root, tree.body);
    if (world_.grid && !tree.doubtful) VisitGrid(tree.root, tree.body);
    if (tree.num_checked >= 0) {
      Visit(tree.root, tree.body, world_.candidates.data() + tree.first_checked, tree.num_checked,
            buffers_.lists.data());
      return;
    }
    if (world_.bvh.empty()) {
      // Its candidates are no bound: solids out of its reach may still be near.
      Visit(tree.root, tree.body, buffers_.all_solids.data(),
            static_cast<int>(buffers_.all_solids.size()), buffers_.lists.data());
      return;
    }
    std::int32_t* list = buffers_.lists.data();
    const V reach = Positive(best_ + Fill(placement_.node(tree.root).radius));
    const int num =
        ListNear(world_, placement_.Position(tree.root), reach, hn::Eq(best_, best_), list);
    if (num > 0) Visit(tree.root, tree.body, list, num, list + num);
  }

  void Visit(int index, int body, const std::int32_t* list, int num, std::int32_t* free_list) {
    const Node& node = placement_.node(index);
    const Points p = placement_.Position(index);
    const V radius = Fill(node.radius);
    if (node.num_children == 0) {
      V least = Fill(std::numeric_limits<float>::max());
      for (int i = 0; i < num; ++i) {
        const Solid& solid = world_.solids[static_cast<std::size_t>(list[i])];
        V squared = SquaredDistance(solid, p);
        if (HWY_UNLIKELY(solid.mesh >= 0)) {
          const V reach = Positive(best_ + radius);
          squared = SquaredMeshDistance(world_, solid, p, reach, hn::Lt(squared, Squared(reach)));
        }
        least = hn::Min(least, squared);
      }
      best_ = hn::Min(best_, hn::Sqrt(least) - radius);
      return;
    }
    int num_near = 0;
    for (int i = 0; i < num; ++i) {
      free_list[num_near] = list[i];
      num_near += Improves(world_.solids[static_cast<std::size_t>(list[i])], p, radius) ? 1 : 0;
    }
    if (num_near == 0) return;
    placement_.PlaceChildren(index, body);
    for (int i = 0; i < node.num_children; ++i) {
      Visit(node.first_child + i, body, free_list, num_near, free_list + num_near);
    }
  }

  void VisitGrid(int index, int body) {
    const Node& node = placement_.node(index);
    const DistanceGrid& grid = *world_.grid;
    const float outside = node.num_children == 0 ? grid.outside : 0.0f;
    const V distance = GridDistance(grid, placement_.Position(index), outside) - Fill(node.radius);
    if (node.num_children == 0) {
      best_ = hn::Min(best_, distance);
      return;
    }
    if (None(hn::Lt(distance - Fill(GridSlack(grid)), best_))) return;
    placement_.PlaceChildren(index, body);
    for (int i = 0; i < node.num_children; ++i) VisitGrid(node.first_child + i, body);
  }

  /// `pair`: followed by those behind it.
  void TestPair(const TreePair* pair) {
    placement_.PlaceRoot(pair->root_a, pair->body_a);
    placement_.PlaceRoot(pair->root_b, pair->body_b);
    if (pair->num_behind == 0) {
      VisitPair(pair->root_a, pair->body_a, pair->root_b, pair->body_b);
      return;
    }
    const V squared =
        SquaredNorm(placement_.Position(pair->root_a) - placement_.Position(pair->root_b));
    if (!Improves(squared, Fill(pair->radius))) return;
    for (int i = 1; i <= pair->num_behind; ++i) TestPair(pair + i);
  }

  void VisitPair(int a, int body_a, int b, int body_b) {
    const Node& node_a = placement_.node(a);
    const Node& node_b = placement_.node(b);
    const V squared = SquaredNorm(placement_.Position(a) - placement_.Position(b));
    const V radius = Fill(node_a.radius + node_b.radius);
    if (!Improves(squared, radius)) return;
    const bool a_is_leaf = node_a.num_children == 0;
    const bool b_is_leaf = node_b.num_children == 0;
    if (a_is_leaf && b_is_leaf) {
      best_ = hn::Min(best_, hn::Sqrt(squared) - radius);
    } else if (b_is_leaf || (!a_is_leaf && node_a.radius > node_b.radius)) {
      placement_.PlaceChildren(a, body_a);
      for (int i = 0; i < node_a.num_children; ++i) {
        VisitPair(node_a.first_child + i, body_a, b, body_b);
      }
    } else {
      placement_.PlaceChildren(b, body_b);
      for (int i = 0; i < node_b.num_children; ++i) {
        VisitPair(a, body_a, node_b.first_child + i, body_b);
      }
    }
  }

  const SphereWorld& world_;
  SphereScratch::Buffers& buffers_;
  Placement placement_;
  V best_;
};

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
