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

/// Planes between the hulls of nodes, and between these and solids, in all lanes. Margins: what is
/// to be left between them, m.
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
  M NotApart(int a, int b, V margin, M lanes) {
    const NodeHull& hull_a = HullOf(a);
    const NodeHull& hull_b = HullOf(b);
    const V wide = margin + Fill(hull_a.slack + hull_b.slack);
    Plane& last = buffers_.PlaneOf(a, b);
    Plane plane = last;
    const bool known = plane.a == a && plane.b == b;
    if (known) {
      lanes = hn::AndNot(IsBetween(plane, hull_b, wide), lanes);
    } else {  // In each lane, one across the line between the middles.
      const Points d = placement_.Position(a) - placement_.Position(b);
      const V gap = LeastAlong(robot_.points + hull_a.first, hull_a.num,
                               placement_.PosesOf(body_a_).InverseRotate(d)) +
                    LeastBeyond(hull_b, d);
      lanes = hn::AndNot(Exceeds(gap, wide, SquaredNorm(d)), lanes);
    }
    if (None(lanes)) return lanes;
    if (!known) {
      plane.a = a;
      plane.b = b;
      Difference(placement_.node(a).center, placement_.node(b).center,
                 Relation(std::countr_zero(Bits(lanes))), plane.direction);
    }
    alignas(64) float margins[kBlock];
    Store(margin, margins);
    // Configurations of a block are alike, and so are those of the next: a plane found in one lane
    // is the first that is tried in others, and where one lane has none these are not asked.
    while (!None(lanes)) {
      const int lane = std::countr_zero(Bits(lanes));
      if (!HullsApart(robot_, hull_a, hull_b, Relation(lane), margins[lane], plane.direction)) {
        break;
      }
      plane.least_a = Extreme(robot_.points + hull_a.first, hull_a.num, plane.direction).value();
      last = plane;
      const M apart = hn::Or(IsBetween(plane, hull_b, wide), MaskOf(LaneMask{1} << lane));
      lanes = hn::AndNot(apart, lanes);
    }
    return lanes;
  }

  /// Lanes, of those given, in which the plane through the point of a solid that is nearest to the
  /// middle of a node is not between the solid and the node's hull.
  M NotApartFrom(const Solid& solid, int node, int body, V margin, M lanes) const {
    const NodeHull& hull = HullOf(node);
    const Poses X_WC = placement_.PosesOf(body);
    const Points p = placement_.Position(node);
    const Points d = FromSolid(solid, p);
    const V squared = SquaredNorm(d);
    const V gap = LeastAlong(robot_.points + hull.first, hull.num, X_WC.InverseRotate(d)) +
                  Dot(d, X_WC.translation() - p) + squared;
    return hn::AndNot(Exceeds(gap, margin + Fill(hull.slack), squared), lanes);
  }

 private:
  const NodeHull& HullOf(int node) const { return robot_.hulls[static_cast<std::size_t>(node)]; }

  /// Lanes in which a plane found before is between its hulls, of which b is given.
  HWY_INLINE M IsBetween(const Plane& plane, const NodeHull& hull_b, V margin) const {
    const Points d = placement_.PosesOf(body_a_).Rotate(Fill(plane.direction));
    const V gap = Fill(plane.least_a) + LeastBeyond(hull_b, d);
    return Exceeds(gap, margin, Fill(Dot(plane.direction, plane.direction)));
  }

  /// Least d . (p - b) over the points b of a hull, p being the origin of body a; d in W.
  HWY_INLINE V LeastBeyond(const NodeHull& hull_b, const Points& d) const {
    const Poses X_WB = placement_.PosesOf(body_b_);
    const Points d_B = X_WB.InverseRotate(d);
    return LeastAlong(robot_.points + hull_b.first, hull_b.num,
                      {hn::Neg(d_B.x), hn::Neg(d_B.y), hn::Neg(d_B.z)}) +
           Dot(d, placement_.PosesOf(body_a_).translation() - X_WB.translation());
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
