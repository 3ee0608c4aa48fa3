// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_HULL_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_HULL_PLANES_INL_H_
#undef PLANBENCH_KERNELS_HULL_PLANES_INL_H_
#else
#define PLANBENCH_KERNELS_HULL_PLANES_INL_H_
#endif

#include <bit>
#include <utility>

#include "collision/simd/kernels/patches-inl.h"
#include "collision/simd/kernels/placement-inl.h"
#include "collision/simd/kernels/solids-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// No motion, of configurations.
struct StandingStill {
  static constexpr bool kMoves = false;
  static V most() { return Zero(); }
};

/// Planes between the hulls of nodes, and between these and solids, in all lanes. They leave what
/// `motion`, a RelativeMotion or StandingStill, and the rounding ask for.
class HullPlanes {
 public:
  HullPlanes(const SphereRobot& robot, SphereScratch::Buffers* buffers, const Placement& placement)
      : robot_(robot), buffers_(*buffers), placement_(placement) {}

  /// The bodies of the nodes that are asked for from now on.
  void Begin(int body_a, int body_b) {
    body_a_ = body_a;
    body_b_ = body_b;
    related_ = 0;
  }
  int body_a() const { return body_a_; }
  int Other(int body) const { return body == body_a_ ? body_b_ : body_a_; }

  /// In one lane, from the frame of body b to that of body a.
  const Transform& Relation(int lane) {
    if ((related_ >> lane & 1) == 0) {
      related_ |= LaneMask{1} << lane;
      relations_[lane] = Between(placement_.PosesOf(body_a_).InLane(lane),
                                 placement_.PosesOf(body_b_).InLane(lane));
    }
    return relations_[lane];
  }

  /// Lanes, of those given, in which no plane is found between two nodes' hulls.
  template <typename Motion>
  M NotApart(int a, int b, const Motion& motion, M lanes) {
    const NodeHull& hull_a = HullOf(a);
    const NodeHull& hull_b = HullOf(b);
    const float least = hull_a.padding + hull_b.padding + hull_a.slack + hull_b.slack;
    Plane& last = buffers_.PlaneOf(a, b);
    Plane plane = last;
    const bool known = plane.a == a && plane.b == b;
    if (known) lanes = NotBetween(plane, hull_b, least, motion, lanes);
    // Stretches of a motion are alike, and so are the planes between what moves; configurations
    // need not be.
    if (!known || !Motion::kMoves) lanes = NotAcrossMiddles(a, b, least, motion, lanes);
    if (None(lanes)) return lanes;
    plane.a = a;
    plane.b = b;
    alignas(64) float margins[kBlock];
    Store(Fill(least) + motion.most(), margins);
    // A plane found in one lane is tried in the others at once, and is the first that is tried when
    // the same two are asked for again; where one lane has none these are not asked.
    for (bool guessed = known && Motion::kMoves; !None(lanes); guessed = Motion::kMoves) {
      const int lane = std::countr_zero(Bits(lanes));
      if (!guessed) {
        Difference(placement_.node(a).center, placement_.node(b).center, Relation(lane),
                   plane.direction);
      }
      if (HullGap(robot_, hull_a, hull_b, Relation(lane), margins[lane], plane.direction) == 0) {
        break;
      }
      plane.least_a = Extreme(robot_.points + hull_a.first, hull_a.num, plane.direction).value();
      last = plane;
      lanes = NotBetween(plane, hull_b, least, motion, lanes);
      if ((Bits(lanes) >> lane & 1) != 0) break;
    }
    return lanes;
  }

  /// Lanes, of those given, in which the plane through the point of a solid that is nearest to the
  /// middle of a node is not between the solid and the node's hull.
  template <typename Motion>
  M NotApartFrom(const Solid& solid, int node, int body, const Motion& motion, M lanes) const {
    const NodeHull& hull = HullOf(node);
    const Poses X_WC = placement_.PosesOf(body);
    const Points p = placement_.Position(node);
    const Points d = FromSolid(solid, p);
    const V squared = SquaredNorm(d);
    const V gap = LeastAlong(robot_.points + hull.first, hull.num, X_WC.InverseRotate(d)) +
                  Dot(d, X_WC.translation() - p) + squared;
    return Within(gap, d, squared, 2 * hull.padding + hull.slack, motion, lanes);
  }

 private:
  const NodeHull& HullOf(int node) const { return robot_.hulls[static_cast<std::size_t>(node)]; }

  /// Lanes, of those given, in which no plane across the line between the middles of two nodes is
  /// between their hulls.
  template <typename Motion>
  HWY_INLINE M NotAcrossMiddles(int a, int b, float least, const Motion& motion, M lanes) const {
    if (None(lanes)) return lanes;
    const NodeHull& hull_a = HullOf(a);
    const Points d = placement_.Position(a) - placement_.Position(b);
    const V gap = LeastAlong(robot_.points + hull_a.first, hull_a.num,
                             placement_.PosesOf(body_a_).InverseRotate(d)) +
                  LeastBeyond(HullOf(b), d);
    return Within(gap, d, SquaredNorm(d), least, motion, lanes);
  }

  /// Lanes, of those given, in which a plane found before is not between its hulls, of which b is
  /// given.
  template <typename Motion>
  HWY_INLINE M NotBetween(const Plane& plane, const NodeHull& hull_b, float least,
                          const Motion& motion, M lanes) const {
    const Points d = placement_.PosesOf(body_a_).Rotate(Fill(plane.direction));
    const V gap = Fill(plane.least_a) + LeastBeyond(hull_b, d);
    return Within(gap, d, Fill(Dot(plane.direction, plane.direction)), least, motion, lanes);
  }

  /// Least d . (p - b) over the points b of a hull, p being the origin of body a; d in W.
  HWY_INLINE V LeastBeyond(const NodeHull& hull_b, const Points& d) const {
    const Poses X_WB = placement_.PosesOf(body_b_);
    const Points d_B = X_WB.InverseRotate(d);
    return LeastAlong(robot_.points + hull_b.first, hull_b.num,
                      {hn::Neg(d_B.x), hn::Neg(d_B.y), hn::Neg(d_B.z)}) +
           Dot(d, placement_.PosesOf(body_a_).translation() - X_WB.translation());
  }

  /// Lanes, of those given, in which a gap along d (in W), of that squared length, is not wider
  /// than `least` and the motion.
  template <typename Motion>
  static HWY_INLINE M Within(V gap, const Points& d, V squared, float least, const Motion& motion,
                             M lanes) {
    lanes = hn::AndNot(Exceeds(gap, Fill(least) + motion.most(), squared), lanes);
    if constexpr (Motion::kMoves) {
      const M open = hn::And(lanes, Exceeds(gap, Fill(least), squared));
      if (None(open)) return lanes;
      const V unit = Fill(1) / hn::Sqrt(squared);
      const V along = motion.Along({d.x * unit, d.y * unit, d.z * unit});
      lanes = hn::AndNot(hn::And(open, hn::Gt(gap * unit, Fill(least) + along)), lanes);
    }
    return lanes;
  }

  /// Whether a gap along a direction of that squared length is wider than a margin.
  static HWY_INLINE M Exceeds(V gap, V margin, V squared) {
    return hn::And(hn::Gt(gap, Zero()), hn::Gt(gap * gap, margin * margin * squared));
  }

  const SphereRobot& robot_;
  SphereScratch::Buffers& buffers_;
  const Placement& placement_;
  int body_a_ = 0;
  int body_b_ = 0;
  LaneMask related_ = 0;  ///< Lanes whose relations are known.
  Transform relations_[kBlock];
};

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
