#include "collision/simd/kernels/sphere_kernel.h"

#include <algorithm>
#include <limits>

// Vectors are members of a struct here, which instruction sets of unknown vector length refuse.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/simd/kernels/sphere_kernel.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "collision/simd/kernels/math-inl.h"
#include "collision/simd/kernels/scratch.h"
#include "collision/simd/kernels/solids-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, kBlock>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;

/// What the passes over one part of a block (as many lanes as a vector has) share: where bodies and
/// balls are.
class Placement {
 public:
  Placement(const SphereRobot& robot, SphereScratch::Buffers* buffers, const float* q, int lane)
      : robot_(robot), buffers_(*buffers), q_(q + lane), lane_(lane) {
    if (++buffers_.placement == 0) {  // stamps of four billion placements ago look new
      std::fill(buffers_.placed.begin(), buffers_.placed.end(), 0);
      buffers_.placement = 1;
    }
    PlaceBodies();
  }

  const Node& node(int index) const { return robot_.nodes[static_cast<std::size_t>(index)]; }

  void Position(int node, V* x, V* y, V* z) const {
    const float* p = buffers_.positions.get() + node * 3 * kBlock + lane_;
    *x = hn::Load(d_, p);
    *y = hn::Load(d_, p + kBlock);
    *z = hn::Load(d_, p + 2 * kBlock);
  }

  /// Positions the root of a tree.
  HWY_INLINE void PlaceRoot(int node, int body) {
    std::uint32_t& stamp = buffers_.placed[static_cast<std::size_t>(node)];
    if (stamp == buffers_.placement) return;
    stamp = buffers_.placement;
    PlaceNode(node, body);
  }

  /// Positions the children of a node.
  HWY_INLINE void PlaceChildren(int parent, int body) {
    const Node& p = node(parent);
    std::uint32_t& stamp = buffers_.placed[robot_.nodes.size() + static_cast<std::size_t>(parent)];
    if (stamp == buffers_.placement) return;
    stamp = buffers_.placement;
    for (int i = 0; i < p.num_children; ++i) PlaceNode(p.first_child + i, body);
  }

 private:
  float* Pose(int body) const { return buffers_.poses.get() + body * 12 * kBlock + lane_; }

  HWY_INLINE void PlaceNode(int index, int body) {
    float* p = buffers_.positions.get() + index * 3 * kBlock + lane_;
    const Node& n = node(index);
    const V x = hn::Set(d_, n.x);
    const V y = hn::Set(d_, n.y);
    const V z = hn::Set(d_, n.z);
    const float* pose = Pose(body);
    if (!robot_.bodies[static_cast<std::size_t>(body)].turns) {
      hn::Store(hn::Add(hn::Load(d_, pose + 9 * kBlock), x), d_, p);
      hn::Store(hn::Add(hn::Load(d_, pose + 10 * kBlock), y), d_, p + kBlock);
      hn::Store(hn::Add(hn::Load(d_, pose + 11 * kBlock), z), d_, p + 2 * kBlock);
      return;
    }
    for (int row = 0; row < 3; ++row) {
      V sum = hn::Load(d_, pose + (9 + row) * kBlock);
      sum = hn::MulAdd(hn::Load(d_, pose + (3 * row) * kBlock), x, sum);
      sum = hn::MulAdd(hn::Load(d_, pose + (3 * row + 1) * kBlock), y, sum);
      sum = hn::MulAdd(hn::Load(d_, pose + (3 * row + 2) * kBlock), z, sum);
      hn::Store(sum, d_, p + row * kBlock);
    }
  }

  HWY_INLINE void PlaceBodies() {
    // Body 0 stands in W; its pose has been written for good.
    for (std::size_t i = 1; i < robot_.bodies.size(); ++i) {
      const Body& body = robot_.bodies[i];
      const float* parent = Pose(body.parent);
      float* pose = Pose(static_cast<int>(i));
      const V q = hn::LoadU(d_, q_ + body.joint * kBlock);
      const bool parent_turns = robot_.bodies[static_cast<std::size_t>(body.parent)].turns;
      V p[3];
      V position[3];
      for (int k = 0; k < 3; ++k) {
        p[k] = hn::Set(d_, body.position[k]);
        if (body.prismatic) p[k] = hn::MulAdd(q, hn::Set(d_, body.axis[k]), p[k]);
      }
      for (int row = 0; row < 3; ++row) {
        V sum = hn::Load(d_, parent + (9 + row) * kBlock);
        if (parent_turns) {
          for (int k = 0; k < 3; ++k) {
            sum = hn::MulAdd(hn::Load(d_, parent + (3 * row + k) * kBlock), p[k], sum);
          }
        } else {
          sum = hn::Add(sum, p[row]);
        }
        position[row] = sum;
        hn::Store(sum, d_, pose + (9 + row) * kBlock);
      }
      if (body.prismatic) {
        for (int k = 0; k < 9; ++k) {
          hn::Store(hn::Load(d_, parent + k * kBlock), d_, pose + k * kBlock);
        }
        continue;
      }
      V sine, cosine;
      SinCos(d_, q, &sine, &cosine);
      for (int row = 0; row < 3; ++row) {
        V m[3];
        for (int column = 0; column < 3; ++column) {
          if (parent_turns) {
            const float* r = parent + 3 * row * kBlock;
            m[column] = hn::Mul(hn::Load(d_, r), hn::Set(d_, body.rotation[column]));
            m[column] = hn::MulAdd(hn::Load(d_, r + kBlock), hn::Set(d_, body.rotation[3 + column]),
                                   m[column]);
            m[column] = hn::MulAdd(hn::Load(d_, r + 2 * kBlock),
                                   hn::Set(d_, body.rotation[6 + column]), m[column]);
          } else {
            m[column] = hn::Set(d_, body.rotation[3 * row + column]);
          }
        }
        hn::Store(hn::MulAdd(cosine, m[0], hn::Mul(sine, m[1])), d_, pose + (3 * row) * kBlock);
        hn::Store(hn::NegMulAdd(sine, m[0], hn::Mul(cosine, m[1])), d_,
                  pose + (3 * row + 1) * kBlock);
        hn::Store(m[2], d_, pose + (3 * row + 2) * kBlock);
      }
    }
  }

  const Lanes d_;
  const SphereRobot& robot_;
  SphereScratch::Buffers& buffers_;
  const float* q_;
  int lane_;
};

/// Lists the solids that the hierarchy has near balls; returns their number.
HWY_INLINE int ListNear(Lanes d, const SphereWorld& world, V x, V y, V z, V reach, M alive,
                        std::int32_t* list) {
  const V zero = hn::Zero(d);
  const V squared_reach = hn::Mul(reach, reach);
  int num = 0;
  const int end = static_cast<int>(world.bvh.size());
  for (int i = 0; i < end;) {
    const BvhNode& node = world.bvh[static_cast<std::size_t>(i)];
    const auto beyond = [&](V p, int axis) {
      return hn::Max(
          hn::Max(hn::Sub(hn::Set(d, node.low[axis]), p), hn::Sub(p, hn::Set(d, node.high[axis]))),
          zero);
    };
    const V bx = beyond(x, 0);
    const V by = beyond(y, 1);
    const V bz = beyond(z, 2);
    const V squared = hn::MulAdd(bx, bx, hn::MulAdd(by, by, hn::Mul(bz, bz)));
    if (hn::AllFalse(d, hn::And(alive, hn::Le(squared, squared_reach)))) {
      i = node.next;
      continue;
    }
    for (int k = 0; k < node.count; ++k) {
      list[num++] = world.bvh_solids[static_cast<std::size_t>(node.first + k)];
    }
    ++i;
  }
  return num;
}

/// Grid values at points.
HWY_INLINE V GridDistance(Lanes d, const DistanceGrid& grid, V x, V y, V z, float outside) {
  const hn::RebindToSigned<Lanes> di;
  const V scale = hn::Set(d, 1 / grid.resolution);
  const auto cell = [&](V p, int axis) {
    return hn::Floor(hn::Mul(hn::Sub(p, hn::Set(d, grid.origin[axis])), scale));
  };
  const V cx = cell(x, 0);
  const V cy = cell(y, 1);
  const V cz = cell(z, 2);
  const V zero = hn::Zero(d);
  const auto within = [&](V c, int axis) {
    return hn::And(hn::Ge(c, zero), hn::Lt(c, hn::Set(d, static_cast<float>(grid.size[axis]))));
  };
  const M inside = hn::And(within(cx, 0), hn::And(within(cy, 1), within(cz, 2)));
  // Converted one by one: as floats, indices beyond 2^24 would be rounded.
  const auto index =
      hn::Add(hn::ConvertTo(di, cx),
              hn::Mul(hn::Set(di, grid.size[0]),
                      hn::Add(hn::ConvertTo(di, cy),
                              hn::Mul(hn::Set(di, grid.size[1]), hn::ConvertTo(di, cz)))));
  const auto safe = hn::IfThenElseZero(hn::RebindMask(di, inside), index);
  return hn::IfThenElse(inside, hn::GatherIndex(d, grid.values, safe), hn::Set(d, outside));
}

/// How far grid values at two points may differ beyond the distance of the points: each is that of
/// the middle of its cell.
HWY_INLINE float GridSlack(const DistanceGrid& grid) { return 1.7321f * grid.resolution; }

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
        hits_(hn::FirstN(d_, 0)),
        certain_(hn::FirstN(d_, 0)),
        doubts_(hn::FirstN(d_, 0)) {}

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
      if ((query_.stop_at_first && !hn::AllFalse(d_, certain_)) || hn::AllFalse(d_, alive_)) {
        return;
      }
    }
  }

  static LaneMask Bits(M mask) {
    alignas(64) std::uint8_t bits[8] = {};
    hn::StoreMaskBits(Lanes(), mask, bits);
    return static_cast<LaneMask>(bits[0]) | static_cast<LaneMask>(bits[1]) << 8;
  }
  LaneMask hits() const { return Bits(hits_); }
  LaneMask certain() const { return Bits(certain_); }
  LaneMask doubts() const { return Bits(hn::AndNot(certain_, doubts_)); }

 private:
  /// Upper bound of the motion of a tree relative to what it is tested against, over the box.
  HWY_INLINE V Motion(int reach) const {
    V sum = hn::Zero(d_);
    if constexpr (kAround) {
      const float* weights = robot_.reaches.data() + reach;
      for (int j = 0; j < robot_.num_joints; ++j) {
        if (weights[j] == 0) continue;
        sum = hn::MulAdd(hn::Set(d_, weights[j]),
                         hn::LoadU(d_, query_.half_widths + j * kBlock + lane_), sum);
      }
    }
    return sum;
  }

  /// Radius grown by the motion; lanes not proven free already matter no more but for certainty.
  HWY_INLINE V Grown(float radius, V motion) const {
    const V r = hn::Set(d_, radius);
    if constexpr (kAround) {
      return hn::Add(r, hn::IfThenZeroElse(hits_, motion));
    } else {
      return r;
    }
  }

  /// Takes note of balls (of one node, or the sum of a pair) of a radius that come within `grown`.
  /// Returns true to stop.
  HWY_INLINE bool Note(V squared, float radius, M touching, bool doubtful) {
    touching = hn::And(touching, alive_);
    if (hn::AllFalse(d_, touching)) return false;
    if (doubtful) {
      doubts_ = hn::Or(doubts_, touching);
      return false;
    }
    hits_ = hn::Or(hits_, touching);
    M certain = touching;
    if constexpr (kAround) {
      certain = hn::And(certain, hn::Le(squared, hn::Set(d_, radius * radius)));
      if (hn::AllFalse(d_, certain)) return false;
    }
    certain_ = hn::Or(certain_, certain);
    alive_ = hn::AndNot(certain, alive_);
    return query_.stop_at_first || hn::AllFalse(d_, alive_);
  }

  bool TestWorld(const WorldTree& tree) {
    if (tree.num_candidates == 0 && world_.grid == nullptr) return false;
    const M before = certain_;
    placement_.PlaceRoot(tree.root, tree.body);
    const V motion = Motion(tree.reach);
    doubtful_ = tree.doubtful;
    if (world_.grid != nullptr) VisitGrid(tree.root, tree.body, motion);
    if (tree.num_candidates >= 0) {
      if (tree.num_candidates > 0) {
        VisitWorld(tree.root, tree.body, motion, world_.candidates.data() + tree.first_candidate,
                   tree.num_candidates, buffers_.lists.data());
      }
    } else {
      V x, y, z;
      placement_.Position(tree.root, &x, &y, &z);
      std::int32_t* list = buffers_.lists.data();
      const int num = ListNear(d_, world_, x, y, z,
                               Grown(placement_.node(tree.root).radius, motion), alive_, list);
      if (num > 0) VisitWorld(tree.root, tree.body, motion, list, num, list + num);
    }
    return !hn::AllFalse(d_, hn::AndNot(before, certain_));
  }

  /// Tests a subtree against the solids of a list; `free_list` is memory for further lists. Returns
  /// true to stop.
  bool VisitWorld(int index, int body, V motion, const std::int32_t* list, int num,
                  std::int32_t* free_list) {
    const Node& node = placement_.node(index);
    V x, y, z;
    placement_.Position(index, &x, &y, &z);
    if (node.num_children == 0) return TestLeaf(node, x, y, z, motion, list, num);
    const V grown = Grown(node.radius, motion);
    const V reach = hn::Mul(grown, grown);
    int num_near = 0;
    for (int i = 0; i < num; ++i) {
      const V squared =
          SquaredDistance(d_, world_.solids[static_cast<std::size_t>(list[i])], x, y, z);
      free_list[num_near] = list[i];
      num_near += hn::AllFalse(d_, hn::And(alive_, hn::Le(squared, reach))) ? 0 : 1;
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

  HWY_INLINE bool TestLeaf(const Node& node, V x, V y, V z, V motion, const std::int32_t* list,
                           int num) {
    const V grown = Grown(node.radius, motion);
    const V reach = hn::Mul(grown, grown);
    V least = hn::Set(d_, std::numeric_limits<float>::max());
    for (int i = 0; i < num; ++i) {
      const Solid& solid = world_.solids[static_cast<std::size_t>(list[i])];
      const V squared = SquaredDistance(d_, solid, x, y, z);
      if (HWY_UNLIKELY(solid.doubtful)) {
        Note(squared, node.radius, hn::Le(squared, reach), true);
      } else {
        least = hn::Min(least, squared);
      }
    }
    return Note(least, node.radius, hn::Le(least, reach), doubtful_);
  }

  bool VisitGrid(int index, int body, V motion) {
    const Node& node = placement_.node(index);
    V x, y, z;
    placement_.Position(index, &x, &y, &z);
    // Nothing is known of what a ball of balls outside of the grid has inside of it.
    const bool exact = node.num_children == 0 && !kAround;
    const V distance = GridDistance(d_, *world_.grid, x, y, z, exact ? world_.grid->outside : 0.0f);
    const V grown = Grown(node.radius, motion);
    if (node.num_children == 0) {
      // The value of another cell may be less by the slack: boxes of configurations allow for it.
      const V limit =
          kAround ? hn::Add(grown, hn::IfThenZeroElse(hits_, hn::Set(d_, GridSlack(*world_.grid))))
                  : grown;
      const M touching = hn::Lt(distance, limit);
      // Note compares squares; what is certain is compared here.
      if constexpr (kAround) {
        const V at_center = GridDistance(d_, *world_.grid, x, y, z, world_.grid->outside);
        const M certain = hn::Lt(at_center, hn::Set(d_, node.radius));
        hits_ = hn::Or(hits_, hn::And(alive_, touching));
        return Note(hn::Zero(d_), node.radius, certain, doubtful_);
      }
      return Note(hn::Zero(d_), node.radius, touching, doubtful_);
    }
    const V limit = hn::Add(grown, hn::Set(d_, GridSlack(*world_.grid)));
    if (hn::AllFalse(d_, hn::And(alive_, hn::Lt(distance, limit)))) return false;
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
    const V motion = Motion(pair.reach);
    const M before = certain_;
    const Node& node_a = placement_.node(pair.root_a);
    const Node& node_b = placement_.node(pair.root_b);
    V x, y, z;
    placement_.Position(pair.root_a, &x, &y, &z);
    const float radius = node_a.radius + node_b.radius;
    const V squared = SquaredTo(pair.root_b, x, y, z);
    const M touching = Within(squared, Grown(radius, motion));
    if (hn::AllFalse(d_, touching)) return false;
    if (node_a.num_children == 0 && node_b.num_children == 0) {
      Note(squared, radius, touching, doubtful_);
    } else {
      VisitPair(pair.root_a, pair.body_a, pair.root_b, pair.body_b, motion);
    }
    return !hn::AllFalse(d_, hn::AndNot(before, certain_));
  }

  HWY_INLINE V SquaredTo(int node, V x, V y, V z) const {
    V px, py, pz;
    placement_.Position(node, &px, &py, &pz);
    const V dx = hn::Sub(px, x);
    const V dy = hn::Sub(py, y);
    const V dz = hn::Sub(pz, z);
    return hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
  }

  HWY_INLINE M Within(V squared, V grown) const {
    return hn::And(alive_, hn::Le(squared, hn::Mul(grown, grown)));
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
    V x, y, z;
    placement_.Position(b, &x, &y, &z);
    for (int i = 0; i < large.num_children; ++i) {
      const int child = large.first_child + i;
      const Node& node = placement_.node(child);
      const float radius = node.radius + small.radius;
      const V squared = SquaredTo(child, x, y, z);
      const M touching = Within(squared, Grown(radius, motion));
      if (hn::AllFalse(d_, touching)) continue;
      if (node.num_children == 0 && small.num_children == 0) {
        if (Note(squared, radius, touching, doubtful_)) return true;
      } else if (VisitPair(child, body_a, b, body_b, motion)) {
        return true;
      }
    }
    return false;
  }

  const Lanes d_;
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
  bool doubtful_ = false;  ///< Of the test at hand.
};

/// The distance pass: branch and bound over the same trees.
class DistancePass {
 public:
  DistancePass(const SphereRobot& robot, const SphereWorld& world, SphereScratch::Buffers* buffers,
               const float* q, int lane, float at_most)
      : world_(world),
        buffers_(*buffers),
        placement_(robot, buffers, q, lane),
        best_(hn::Set(d_, at_most)) {
    const int num_trees = static_cast<int>(world.trees.size());
    for (const int test : buffers_.order) {
      if (test < num_trees) {
        TestWorld(world.trees[static_cast<std::size_t>(test)]);
        continue;
      }
      const TreePair& pair = robot.pairs[static_cast<std::size_t>(test - num_trees)];
      placement_.PlaceRoot(pair.root_a, pair.body_a);
      placement_.PlaceRoot(pair.root_b, pair.body_b);
      VisitPair(pair.root_a, pair.body_a, pair.root_b, pair.body_b);
    }
  }
  V best() const { return best_; }

 private:
  /// True if some lane's squared distance between centres leaves room to improve, by balls of that
  /// radius.
  HWY_INLINE bool Improves(V squared, V radius) const {
    const V reach = hn::Max(hn::Add(best_, radius), hn::Zero(d_));
    return !hn::AllFalse(d_, hn::Lt(squared, hn::Mul(reach, reach)));
  }

  void TestWorld(const WorldTree& tree) {
    placement_.PlaceRoot(tree.root, tree.body);
    if (world_.grid != nullptr) VisitGrid(tree.root, tree.body);
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
    V x, y, z;
    placement_.Position(tree.root, &x, &y, &z);
    std::int32_t* list = buffers_.lists.data();
    const V radius = hn::Set(d_, placement_.node(tree.root).radius);
    const int num = ListNear(d_, world_, x, y, z, hn::Max(hn::Add(best_, radius), hn::Zero(d_)),
                             hn::Eq(best_, best_), list);
    if (num > 0) Visit(tree.root, tree.body, list, num, list + num);
  }

  void Visit(int index, int body, const std::int32_t* list, int num, std::int32_t* free_list) {
    const Node& node = placement_.node(index);
    V x, y, z;
    placement_.Position(index, &x, &y, &z);
    const V radius = hn::Set(d_, node.radius);
    if (node.num_children == 0) {
      V least = hn::Set(d_, std::numeric_limits<float>::max());
      for (int i = 0; i < num; ++i) {
        least = hn::Min(
            least, SquaredDistance(d_, world_.solids[static_cast<std::size_t>(list[i])], x, y, z));
      }
      best_ = hn::Min(best_, hn::Sub(hn::Sqrt(least), radius));
      return;
    }
    int num_near = 0;
    for (int i = 0; i < num; ++i) {
      const V squared =
          SquaredDistance(d_, world_.solids[static_cast<std::size_t>(list[i])], x, y, z);
      free_list[num_near] = list[i];
      num_near += Improves(squared, radius) ? 1 : 0;
    }
    if (num_near == 0) return;
    placement_.PlaceChildren(index, body);
    for (int i = 0; i < node.num_children; ++i) {
      Visit(node.first_child + i, body, free_list, num_near, free_list + num_near);
    }
  }

  void VisitGrid(int index, int body) {
    const Node& node = placement_.node(index);
    V x, y, z;
    placement_.Position(index, &x, &y, &z);
    const V distance = hn::Sub(GridDistance(d_, *world_.grid, x, y, z,
                                            node.num_children == 0 ? world_.grid->outside : 0.0f),
                               hn::Set(d_, node.radius));
    if (node.num_children == 0) {
      best_ = hn::Min(best_, distance);
      return;
    }
    const V bound = hn::Sub(distance, hn::Set(d_, GridSlack(*world_.grid)));
    if (hn::AllFalse(d_, hn::Lt(bound, best_))) return;
    placement_.PlaceChildren(index, body);
    for (int i = 0; i < node.num_children; ++i) VisitGrid(node.first_child + i, body);
  }

  void VisitPair(int a, int body_a, int b, int body_b) {
    const Node& node_a = placement_.node(a);
    const Node& node_b = placement_.node(b);
    V ax, ay, az, bx, by, bz;
    placement_.Position(a, &ax, &ay, &az);
    placement_.Position(b, &bx, &by, &bz);
    const V dx = hn::Sub(ax, bx);
    const V dy = hn::Sub(ay, by);
    const V dz = hn::Sub(az, bz);
    const V squared = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    const V radius = hn::Set(d_, node_a.radius + node_b.radius);
    if (!Improves(squared, radius)) return;
    const bool a_is_leaf = node_a.num_children == 0;
    const bool b_is_leaf = node_b.num_children == 0;
    if (a_is_leaf && b_is_leaf) {
      best_ = hn::Min(best_, hn::Sub(hn::Sqrt(squared), radius));
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

  const Lanes d_;
  const SphereWorld& world_;
  SphereScratch::Buffers& buffers_;
  Placement placement_;
  V best_;
};

template <bool kAround>
void RunCheck(const SphereRobot& robot, const SphereWorld& world, SphereScratch::Buffers* buffers,
              const BlockQuery& query, BlockVerdict* verdict) {
  const Lanes d;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kBlock; lane += width) {
    const LaneMask lanes = (query.lanes >> lane) & ((LaneMask{1} << width) - 1);
    if (lanes == 0) continue;
    alignas(64) std::uint8_t bits[8] = {static_cast<std::uint8_t>(lanes),
                                        static_cast<std::uint8_t>(lanes >> 8)};
    CheckPass<kAround> pass(robot, world, buffers, query, lane, hn::LoadMaskBits(d, bits));
    pass.Run();
    verdict->hits |= pass.hits() << lane;
    verdict->certain |= pass.certain() << lane;
    verdict->doubts |= pass.doubts() << lane;
    if (query.stop_at_first && verdict->certain != 0) return;
  }
}

BlockVerdict CheckBlockImpl(const SphereRobot& robot, const SphereWorld& world,
                            SphereScratch::Buffers* buffers, const BlockQuery& query) {
  BlockVerdict verdict;
  if (query.half_widths != nullptr) {
    RunCheck<true>(robot, world, buffers, query, &verdict);
  } else {
    RunCheck<false>(robot, world, buffers, query, &verdict);
  }
  return verdict;
}

void BlockDistancesImpl(const SphereRobot& robot, const SphereWorld& world,
                        SphereScratch::Buffers* buffers, const float* q, float at_most,
                        float* distances) {
  const Lanes d;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kBlock; lane += width) {
    const DistancePass pass(robot, world, buffers, q, lane, at_most);
    hn::StoreU(pass.best(), d, distances + lane);
  }
}

LaneMask PlaceRowsImpl(const RowBlock& block, float* q) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const int width = static_cast<int>(hn::Lanes(d));
  const auto period = hn::Set(d, 6.283185307179586);
  const auto per_period = hn::Set(d, 0.15915494309189535);
  LaneMask outside = 0;
  for (int first = 0; first < block.num_joints; first += width) {
    const int num = std::min(width, block.num_joints - first);
    const auto some = hn::FirstN(d, static_cast<std::size_t>(num));
    const auto lower = hn::MaskedLoad(some, d, block.lower + first);
    const auto upper = hn::MaskedLoad(some, d, block.upper + first);
    alignas(64) double turning[8];
    for (int j = 0; j < width; ++j) turning[j] = j < num && block.slides[first + j] == 0 ? 1 : 0;
    const auto turns_scale = hn::Mul(per_period, hn::Load(d, turning));
    for (int row = 0; row < block.num_rows; ++row) {
      auto value = hn::MaskedLoad(some, d, block.rows + row * block.num_joints + first);
      const auto inside = hn::And(hn::Ge(value, lower), hn::Le(value, upper));
      outside |= static_cast<LaneMask>(!hn::AllTrue(d, inside)) << row;
      value = hn::NegMulAdd(hn::Round(hn::Mul(value, turns_scale)), period, value);
      alignas(64) float narrow[8];
      hn::Store(hn::DemoteTo(df, value), df, narrow);
      float* out = q + first * kBlock + row;
      for (int j = 0; j < num; ++j) out[j * kBlock] = narrow[j];
    }
  }
  return outside;
}

void PlaceSamplesImpl(const SampleBlock& block, float* q, float* half_widths) {
  const Lanes d;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kBlock; lane += width) {
    const V position = hn::LoadU(d, block.position + lane);
    const V half_length = hn::LoadU(d, block.half_length + lane);
    for (int j = 0; j < block.num_joints; ++j) {
      const V motion = hn::Set(d, block.motion[j]);
      V value = hn::MulAdd(position, motion, hn::Set(d, block.start[j]));
      if (block.slides[j] == 0) {
        const V turns = hn::Round(hn::Mul(value, hn::Set(d, 0.15915494f)));
        value = hn::NegMulAdd(turns, hn::Set(d, 6.2831853f), value);
      }
      hn::StoreU(value, d, q + j * kBlock + lane);
      hn::StoreU(hn::Mul(half_length, hn::Abs(motion)), d, half_widths + j * kBlock + lane);
    }
  }
}

void BlockSinCosImpl(const float* angles, float* sines, float* cosines) {
  const Lanes d;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kBlock; lane += width) {
    V sine, cosine;
    SinCos(d, hn::LoadU(d, angles + lane), &sine, &cosine);
    hn::StoreU(sine, d, sines + lane);
    hn::StoreU(cosine, d, cosines + lane);
  }
}

const char* InstructionSetImpl() { return hwy::TargetName(HWY_TARGET); }

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planbench::kernels {

HWY_EXPORT(CheckBlockImpl);
HWY_EXPORT(BlockDistancesImpl);
HWY_EXPORT(PlaceRowsImpl);
HWY_EXPORT(PlaceSamplesImpl);
HWY_EXPORT(BlockSinCosImpl);
HWY_EXPORT(InstructionSetImpl);

BlockVerdict CheckBlock(const SphereRobot& robot, const SphereWorld& world, SphereScratch* scratch,
                        const BlockQuery& query) {
  return HWY_DYNAMIC_DISPATCH(CheckBlockImpl)(robot, world, &scratch->buffers(), query);
}

void BlockDistances(const SphereRobot& robot, const SphereWorld& world, SphereScratch* scratch,
                    const float* q, float at_most, float* distances) {
  HWY_DYNAMIC_DISPATCH(BlockDistancesImpl)
  (robot, world, &scratch->buffers(), q, at_most, distances);
}

LaneMask PlaceRows(const RowBlock& block, float* q) {
  return HWY_DYNAMIC_DISPATCH(PlaceRowsImpl)(block, q);
}

void PlaceSamples(const SampleBlock& block, float* q, float* half_widths) {
  HWY_DYNAMIC_DISPATCH(PlaceSamplesImpl)(block, q, half_widths);
}

void BlockSinCos(const float* angles, float* sines, float* cosines) {
  HWY_DYNAMIC_DISPATCH(BlockSinCosImpl)(angles, sines, cosines);
}

const char* InstructionSet() { return HWY_DYNAMIC_DISPATCH(InstructionSetImpl)(); }

SphereScratch::SphereScratch() : buffers_(std::make_unique<Buffers>()) {}
SphereScratch::~SphereScratch() = default;
SphereScratch::SphereScratch(SphereScratch&&) noexcept = default;
SphereScratch& SphereScratch::operator=(SphereScratch&&) noexcept = default;

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
  b.placed.assign(2 * robot.nodes.size(), 0);
  b.placement = 0;
  b.order.resize(world.trees.size() + robot.pairs.size());
  for (std::size_t i = 0; i < b.order.size(); ++i) b.order[i] = static_cast<std::int32_t>(i);
  b.all_solids.resize(world.solids.size());
  for (std::size_t i = 0; i < b.all_solids.size(); ++i) {
    b.all_solids[i] = static_cast<std::int32_t>(i);
  }
  b.lists.resize(world.solids.size() * static_cast<std::size_t>(kMaxDepth));
}

}  // namespace planbench::kernels
#endif
