// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_CHECK_PASS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_CHECK_PASS_INL_H_
#undef PLANBENCH_KERNELS_CHECK_PASS_INL_H_
#else
#define PLANBENCH_KERNELS_CHECK_PASS_INL_H_
#endif

#include <bit>
#include <limits>
#include <utility>

#include "collision/simd/kernels/hull_planes-inl.h"
#include "collision/simd/kernels/motion_bounds-inl.h"
#include "collision/simd/kernels/nearby-inl.h"
#include "collision/simd/kernels/patches-inl.h"
#include "collision/simd/kernels/placement-inl.h"
#include "collision/simd/kernels/solids-inl.h"
#include "collision/simd/kernels/tables-inl.h"
#include "collision/simd/kernels/verdicts-inl.h"

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
        motions_(robot, buffers, query, lane, placement_),
        hulls_(robot, buffers, placement_),
        verdicts_(alive, query.stop_at_first) {}

  void Run() {
    const bool finds_open = kAround && query_.tests == Tests::kFindOpen;
    if (finds_open) buffers_.knows_open = true;
    const bool only_open = kAround && query_.tests == Tests::kOpen && buffers_.knows_open;
    std::vector<std::int32_t>& tests = only_open ? buffers_.open : buffers_.order;
    std::int32_t* order = tests.data();
    const std::size_t num_tests = tests.size();
    const WorldTree* trees = world_.trees.data();
    const int num_trees = static_cast<int>(world_.trees.size());
    for (std::size_t i = 0; i < num_tests; ++i) {
      const int test = order[i];
      if (query_.tests == Tests::kScreen && test >= num_trees) continue;
      const bool found = test < num_trees ? TestWorld(trees[test])
                                          : TestPair(robot_.pairs.data()[test - num_trees]);
      if (finds_open && !None(verdicts_.BeginNext())) Keep(test);
      if (!found) continue;
      // One step to the front at a time: what hits often comes early.
      if (i > 0) std::swap(order[i], order[i - 1]);
      if (verdicts_.Done()) return;
    }
    for (const InsideTest& test : robot_.inside_tests) {
      // What was outside all along the motion's stretches is so in their cuts, as long as no
      // surfaces touch.
      if (only_open && !test.doubtful) continue;
      if (TestPoints(test)) return;
    }
  }

  BlockVerdict verdict() const { return verdicts_.InBits(); }

 private:
  /// Keeps a test that left a lane open.
  void Keep(int test) {
    unsigned char& is_open = buffers_.is_open[static_cast<std::size_t>(test)];
    if (is_open != 0) return;
    is_open = 1;
    buffers_.open.push_back(test);
  }

  /// Whether what is inside of a node's ball tells of a solid.
  static bool IsInner(const Node& node, const Solid& solid) {
    return node.inner > 0 && !solid.doubtful && solid.mesh < 0;
  }

  /// Whose points move no further: of a sphere the centre, as its surface turns into itself.
  int ReachOfPoints(const Node& leaf) const {
    return leaf.patch >= 0 ? leaf.reach + robot_.num_joints : leaf.reach;
  }
  PatchView PatchOf(int leaf) const {
    return {robot_.patches[static_cast<std::size_t>(placement_.node(leaf).patch)], HullOf(leaf),
            robot_};
  }
  const NodeHull& HullOf(int node) const { return robot_.hulls[static_cast<std::size_t>(node)]; }
  const Inside& InsideAt(int index) const {
    return robot_.insides[static_cast<std::size_t>(index)];
  }

  /// Points in W, or boxes of that extent about them, that collide where a closed mesh encloses
  /// them, as nothing touches its surface. Returns true to stop.
  bool TestInside(const Inside& inside, const Points& p_W, float extent, M lanes, bool doubtful) {
    const Points p = placement_.PosesOf(inside.body).InverseTimes(p_W);
    const auto within = [&](V value, int axis) {
      return hn::And(hn::Ge(value, Fill(inside.low[axis] - extent)),
                     hn::Le(value, Fill(inside.high[axis] + extent)));
    };
    lanes = hn::And(hn::And(lanes, within(p.x, 0)), hn::And(within(p.y, 1), within(p.z, 2)));
    if (None(lanes)) return false;
    if (doubtful) {
      verdicts_.Doubt(lanes);
      return false;
    }
    alignas(64) float x[kBlock], y[kBlock], z[kBlock];
    Store(p.x, x);
    Store(p.y, y);
    Store(p.z, z);
    LaneMask certain = 0;
    for (LaneMask open = Bits(lanes); open != 0; open &= open - 1) {
      const int lane = std::countr_zero(open);
      const float point[3] = {x[lane], y[lane], z[lane]};
      if (Encloses(inside, point)) certain |= LaneMask{1} << lane;
    }
    return certain != 0 && verdicts_.Settle(MaskOf(certain));
  }

  /// Returns true to stop.
  bool TestPoints(const InsideTest& test) {
    placement_.PlaceRoot(test.root_in, test.body_in);
    const Node& in = placement_.node(test.root_in);
    const Poses X_WC = placement_.PosesOf(test.body_of);
    const Points middle = placement_.Position(test.root_in);
    const auto near = [&](const Points& p, float radius) {
      return hn::Le(SquaredNorm(p - middle), Squared(Fill(in.radius + radius)));
    };
    if (None(hn::And(verdicts_.alive(), near(X_WC * Fill(test.center), test.radius)))) return false;
    for (const auto& point : test.points) {
      const Points p = X_WC * Fill(point.data());
      const M inside_ball = near(p, 0);
      for (int k = 0; k < in.num_insides; ++k) {
        const M lanes = hn::And(verdicts_.alive(), inside_ball);
        if (None(lanes)) break;
        if (TestInside(InsideAt(in.first_inside + k), p, 0, lanes, test.doubtful)) return true;
      }
    }
    return false;
  }

  /// Parts of a mesh that may be inside of one that the node encloses.
  bool TestMeshInside(int node, const Inside& inside, const WorldMesh& mesh) {
    const auto in_W = [&](const float* p_M) -> Points {
      float p_W[3];
      for (int k = 0; k < 3; ++k) {
        p_W[k] = mesh.position[k] + mesh.rotation[k] * p_M[0] + mesh.rotation[3 + k] * p_M[1] +
                 mesh.rotation[6 + k] * p_M[2];
      }
      return Fill(p_W);
    };
    for (const PointBall& ball : mesh.tree->point_balls) {
      const V reach = Fill(placement_.node(node).radius + ball.radius + kMeshPadding);
      const V squared = SquaredNorm(in_W(ball.center) - placement_.Position(node));
      const M near = hn::Le(squared, Squared(reach));
      for (int i = ball.first; i < ball.first + ball.num; ++i) {
        const M lanes = hn::And(verdicts_.alive(), near);
        if (None(lanes)) break;
        const Points p = in_W(mesh.tree->points[static_cast<std::size_t>(i)].data());
        if (TestInside(inside, p, 0, lanes, false)) return true;
      }
    }
    return false;
  }

  /// Solids of a list that may be inside of the meshes that a node encloses.
  bool TestInsides(int index, const std::int32_t* list, int num) {
    const Node& node = placement_.node(index);
    for (int k = 0; k < node.num_insides; ++k) {
      const Inside& inside = InsideAt(node.first_inside + k);
      for (int i = 0; i < num; ++i) {
        const Solid& solid = world_.solids[static_cast<std::size_t>(list[i])];
        if (solid.mesh >= 0 && !solid.doubtful) {
          const WorldMesh& mesh = world_.meshes[static_cast<std::size_t>(solid.mesh)];
          const bool may_fit = solid.extent <= inside.extent || mesh.tree->points.size() > 1;
          if (may_fit && TestMeshInside(index, inside, mesh)) return true;
          continue;
        }
        if (solid.extent > inside.extent) continue;
        // Of what is in a bounding box no point is known: somewhere within it.
        const float extent = solid.doubtful ? 2 * solid.extent : 0.0f;
        if (TestInside(inside, Fill(solid.center), extent, verdicts_.alive(), solid.doubtful))
          return true;
      }
    }
    return false;
  }

  bool TestWorld(const WorldTree& tree) {
    const bool on_grid = world_.grid && !tree.doubtful;
    if (tree.num_candidates == 0 && !on_grid) return false;
    const M before = verdicts_.certain();
    placement_.PlaceRoot(tree.root, tree.body);
    reach_ = tree.reach;
    const V motion = motions_.Of(reach_, reach_.first);
    doubtful_ = tree.doubtful;
    if (on_grid) VisitGrid(tree.root, tree.body, motion);
    if (tree.num_candidates >= 0) {
      if (tree.num_candidates > 0) {
        VisitWorld(tree.root, tree.body, motion, world_.candidates.data() + tree.first_candidate,
                   tree.num_candidates, buffers_.lists.data());
      }
    } else {
      std::int32_t* list = buffers_.lists.data();
      const V reach = verdicts_.Grown(placement_.node(tree.root).radius, motion);
      const int num =
          ListNear(world_, placement_.Position(tree.root), reach, verdicts_.alive(), list);
      if (num > 0) VisitWorld(tree.root, tree.body, motion, list, num, list + num);
    }
    return !None(hn::AndNot(before, verdicts_.certain()));
  }

  /// Tests a subtree against the solids of a list; `free_list` is memory for further lists. Returns
  /// true to stop.
  bool VisitWorld(int index, int body, V motion, const std::int32_t* list, int num,
                  std::int32_t* free_list) {
    const Node& node = placement_.node(index);
    const Points p = placement_.Position(index);
    if (node.num_children == 0) {
      const bool stops = node.patch >= 0 ? TestPatch(index, body, p, list, num)
                                         : TestLeaf(node, p, motion, list, num);
      return stops || TestInsides(index, list, num);
    }
    const V grown = verdicts_.Grown(node.radius, motion);
    const V reach = Squared(grown);
    int num_near = 0;
    for (int i = 0; i < num; ++i) {
      const Solid& solid = world_.solids[static_cast<std::size_t>(list[i])];
      const V squared = SquaredDistance(solid, p);
      if (IsInner(node, solid) && verdicts_.NoteInner(squared, node.inner)) return true;
      const M near = hn::And(verdicts_.alive(), hn::Le(squared, reach));
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
    return TestInsides(index, free_list, num_near);
  }

  /// A patch, where its ball comes near a solid.
  bool TestPatch(int index, int body, const Points& p, const std::int32_t* list, int num) {
    const Node& node = placement_.node(index);
    const PatchView patch = PatchOf(index);
    const V grown = verdicts_.Grown(node.radius, motions_.Of(reach_, node.reach));
    const V reach = Squared(grown);
    for (int i = 0; i < num; ++i) {
      const Solid& solid = world_.solids[static_cast<std::size_t>(list[i])];
      const V squared = SquaredDistance(solid, p);
      if (IsInner(node, solid) && verdicts_.NoteInner(squared, node.inner)) return true;
      M near = hn::And(verdicts_.alive(), hn::Le(squared, reach));
      if (None(near)) continue;
      const V motion = motions_.Of(reach_, ReachOfPoints(node));
      const MovingPart part = PartOf(index, body);
      near = hulls_.NotApartFrom(solid, index, body, Motion(motion, part.weights, part), near);
      if (None(near)) continue;
      if (solid.doubtful) {
        verdicts_.Doubt(near);
        continue;
      }
      const auto touches = [&](int lane, float margin) {
        return PatchMeetsSolid(patch, placement_.PosesOf(body).InLane(lane), world_, solid, margin);
      };
      if (verdicts_.NoteExact(near, motion, patch.patch.padding, touches)) return true;
    }
    return false;
  }

  MovingPart PartOf(int leaf, int body) const {
    const Node& node = placement_.node(leaf);
    return {leaf, body, node.radius, Weights(ReachOfPoints(node))};
  }
  const float* Weights(int first) const { return robot_.reaches.data() + first; }

  /// What planes are to leave room for: see RelativeMotion.
  HWY_INLINE auto Motion(V most, const float* moves, const MovingPart& part,
                         const MovingPart* other = nullptr) const {
    if constexpr (kAround) {
      return RelativeMotion(motions_, most, moves, hn::Not(verdicts_.hits()), part, other);
    } else {
      return StandingStill();
    }
  }
  HWY_INLINE bool TestLeaf(const Node& node, const Points& p, V motion, const std::int32_t* list,
                           int num) {
    const V grown = verdicts_.Grown(node.radius, motion);
    V reach = Squared(grown);
    V least = Fill(std::numeric_limits<float>::max());
    for (int i = 0; i < num; ++i) {
      const Solid& solid = world_.solids[static_cast<std::size_t>(list[i])];
      V squared = SquaredDistance(solid, p);
      if (HWY_UNLIKELY(solid.mesh >= 0)) {
        squared = SquaredMeshDistance(world_, solid, p, grown,
                                      hn::And(verdicts_.alive(), hn::Le(squared, reach)));
      }
      if (HWY_UNLIKELY(solid.doubtful)) {
        verdicts_.Note(squared, node.radius, hn::Le(squared, reach), true);
      } else {
        least = hn::Min(least, squared);
      }
    }
    if constexpr (kAround) {
      if (None(hn::And(verdicts_.alive(), hn::Le(least, reach)))) return false;
      reach = Squared(verdicts_.Grown(node.radius, motions_.Of(reach_, node.reach)));
    }
    return verdicts_.Note(least, node.radius, hn::Le(least, reach), doubtful_);
  }

  bool VisitGrid(int index, int body, V motion) {
    const Node& node = placement_.node(index);
    const Points p = placement_.Position(index);
    const DistanceGrid& grid = *world_.grid;
    if (node.num_children == 0) {
      if constexpr (kAround) {
        const M open = hn::AndNot(verdicts_.hits(), verdicts_.alive());
        if (!None(open)) {
          verdicts_.Block(
              MeetsGridAround(grid, p, motions_.Of(reach_, node.reach), node.radius, open));
        }
      }
      // Note compares squares; what is certain is compared here.
      const V distance = GridDistance(grid, p, grid.outside);
      M meets = hn::Lt(distance, Fill(node.radius));
      if constexpr (!kAround) {
        if (HWY_UNLIKELY(grid.is_far)) {
          meets = hn::Or(meets, MeetsGridAround(grid, p, Zero(), node.radius, verdicts_.alive()));
        }
      }
      return verdicts_.Note(Zero(), node.radius, meets, false);
    }
    // Nothing is known of what a ball of balls outside of the grid has inside of it.
    const V limit = verdicts_.Grown(node.radius, motion) + Fill(GridSlack(grid));
    if (None(hn::And(verdicts_.alive(), hn::Lt(GridDistance(grid, p, 0.0f), limit)))) return false;
    placement_.PlaceChildren(index, body);
    for (int i = 0; i < node.num_children; ++i) {
      if (VisitGrid(node.first_child + i, body, motion)) return true;
    }
    return false;
  }

  HWY_INLINE bool TestPair(const TreePair& pair) {
    if (pair.table >= 0) return MayMeet(pair) && TestBehind(&pair);
    placement_.PlaceRoot(pair.root_a, pair.body_a);
    placement_.PlaceRoot(pair.root_b, pair.body_b);
    const V squared =
        SquaredNorm(placement_.Position(pair.root_b) - placement_.Position(pair.root_a));
    if (None(Within(squared, verdicts_.Grown(pair.radius, motions_.AtMost(pair.reach)))))
      return false;
    return pair.num_behind > 0 ? TestBehind(&pair) : VisitRoots(pair, squared);
  }

  /// Whether a gate's table leaves open that its trees touch.
  HWY_INLINE bool MayMeet(const TreePair& gate) {
    reach_ = gate.reach;
    const JointTable& table = robot_.tables[static_cast<std::size_t>(gate.table)];
    const V apart = TableBound(table, query_.q + lane_);
    return !None(hn::And(verdicts_.alive(),
                         hn::Le(apart, verdicts_.Grown(0, motions_.Of(reach_, reach_.first)))));
  }

  HWY_NOINLINE bool TestBehind(const TreePair* gate) {
    bool found = false;
    for (int i = 1; i <= gate->num_behind; ++i) {
      found = TestPair(gate[i]) || found;
      if (found && verdicts_.Done()) break;
    }
    return found;
  }

  HWY_NOINLINE bool VisitRoots(const TreePair& pair, V squared) {
    reach_ = pair.reach;
    const V motion = motions_.Of(reach_, reach_.first);
    M touching = Within(squared, verdicts_.Grown(pair.radius, motion));
    if (None(touching)) return false;
    doubtful_ = pair.doubtful;
    hulls_.Begin(pair.body_a, pair.body_b);
    const M before = verdicts_.certain();
    if (placement_.node(pair.root_a).num_children == 0 &&
        placement_.node(pair.root_b).num_children == 0) {
      NotePair(pair.root_a, pair.body_a, pair.root_b, pair.body_b, squared, pair.radius, touching);
    } else {
      touching = NotApartAsWhole(pair.root_a, pair.body_a, pair.root_b, touching);
      if (None(touching)) return false;
      VisitPair(pair.root_a, pair.body_a, pair.root_b, pair.body_b, motion, touching);
    }
    return !None(hn::AndNot(before, verdicts_.certain()));
  }

  /// NotApart of nodes that are not both leaves, if they have hulls, by the bound of their trees.
  M NotApartAsWhole(int a, int body_a, int b, M lanes) {
    if (doubtful_ || HullOf(a).num == 0 || HullOf(b).num == 0) return lanes;
    const int first = reach_.first + robot_.num_joints;
    const auto part = [&](int node, int body) {
      return MovingPart{node, body, placement_.node(node).radius, Weights(first)};
    };
    return NotApart(part(a, body_a), part(b, hulls_.Other(body_a)), motions_.Of(reach_, first),
                    lanes);
  }

  /// Lanes, of those given, in which two nodes are not known to be apart by their hulls; `most`
  /// bounds the motion of all of their points.
  M NotApart(const MovingPart& a, const MovingPart& b, V most, M lanes) {
    return NotApart(a, b, Motion(most, Weights(reach_.first + robot_.num_joints), a, &b), lanes);
  }
  template <typename Motion>
  M NotApart(const MovingPart& a, const MovingPart& b, const Motion& motion, M lanes) {
    return a.body == hulls_.body_a() ? hulls_.NotApart(a.node, b.node, motion, lanes)
                                     : hulls_.NotApart(b.node, a.node, motion, lanes);
  }

  HWY_INLINE M Within(V squared, V grown) const {
    return hn::And(verdicts_.alive(), hn::Le(squared, Squared(grown)));
  }

  /// Two leaves that touch by the bound of their trees.
  HWY_INLINE bool NotePair(int index_a, int body_a, int index_b, int body_b, V squared,
                           float radius, M touching) {
    const Node& a = placement_.node(index_a);
    const Node& b = placement_.node(index_b);
    if constexpr (kAround) {
      touching =
          Within(squared, verdicts_.Grown(radius, motions_.Between(reach_, a.reach, b.reach)));
    }
    if (doubtful_ || (a.patch < 0 && b.patch < 0)) {
      return verdicts_.Note(squared, radius, touching, doubtful_);
    }
    return a.patch >= 0 ? NotePatch(index_a, body_a, index_b, body_b, touching)
                        : NotePatch(index_b, body_b, index_a, body_a, touching);
  }

  /// A patch and another leaf, whose balls touch.
  bool NotePatch(int index, int body_a, int other_index, int other_body, M touching) {
    if (None(touching)) return false;
    if (body_a != hulls_.body_a() && placement_.node(other_index).patch >= 0) {
      std::swap(index, other_index);
      std::swap(body_a, other_body);
    }
    const Node& node = placement_.node(index);
    const Node& other = placement_.node(other_index);
    const V motion =
        kAround ? motions_.Between(reach_, ReachOfPoints(node), ReachOfPoints(other)) : Zero();
    const PatchView patch = PatchOf(index);
    if (other.patch < 0) {
      return verdicts_.NoteExact(
          touching, motion, patch.patch.padding, [&](int lane, float margin) {
            float center_W[3], center[3];
            placement_.Position(other_index, lane, center_W);
            placement_.PosesOf(body_a).InLane(lane).InverseTimes(center_W, center);
            return PatchWithin(patch, center, other.radius + margin);
          });
    }
    const MovingPart part = PartOf(index, body_a);
    const MovingPart other_part = PartOf(other_index, hulls_.Other(body_a));
    touching = NotApart(part, other_part, motion, touching);
    if (None(touching)) return false;
    if constexpr (kAround) {
      // Hulls that are apart at q itself tell how near the patches are, well enough not to ask
      // their triangles.
      const M overlapping = NotApart(part, other_part, StandingStill(), touching);
      verdicts_.Block(hn::AndNot(overlapping, touching));
      touching = overlapping;
      if (None(touching)) return false;
    }
    const PatchView other_patch = PatchOf(other_index);
    return verdicts_.NoteExact(touching, motion, patch.patch.padding, [&](int lane, float margin) {
      return PatchesMeet(patch, other_patch, hulls_.Relation(lane),
                         margin + other_patch.patch.padding);
    });
  }

  /// Two balls that touch in some lanes, not both of them leaves. Returns true to stop.
  bool VisitPair(int a, int body_a, int b, int body_b, V motion, M lanes) {
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
      const M touching = hn::And(lanes, Within(squared, verdicts_.Grown(radius, motion)));
      if (None(touching)) continue;
      if (node.inner > 0 && small.inner > 0 && !doubtful_ &&
          verdicts_.NoteInner(squared, node.inner + small.inner)) {
        return true;
      }
      if (node.num_children == 0 && small.num_children == 0) {
        if (NotePair(child, body_a, b, body_b, squared, radius, touching)) return true;
      } else {
        const M open = NotApartAsWhole(child, body_a, b, touching);
        if (None(open)) continue;
        if (VisitPair(child, body_a, b, body_b, motion, open)) return true;
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
  MotionBounds<kAround> motions_;
  HullPlanes hulls_;
  Verdicts<kAround> verdicts_;
  // Of the test at hand.
  Reach reach_;
  bool doubtful_ = false;
};

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
