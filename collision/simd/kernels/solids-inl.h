// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_SOLIDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_SOLIDS_INL_H_
#undef PLANBENCH_KERNELS_SOLIDS_INL_H_
#else
#define PLANBENCH_KERNELS_SOLIDS_INL_H_
#endif

#include <hwy/highway.h>

#include "collision/simd/kernels/sphere_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V SquaredBeyond(D d, V x, V y, V z, const float* half_sizes) {
  const V zero = hn::Zero(d);
  const V bx = hn::Max(hn::Sub(hn::Abs(x), hn::Set(d, half_sizes[0])), zero);
  const V by = hn::Max(hn::Sub(hn::Abs(y), hn::Set(d, half_sizes[1])), zero);
  const V bz = hn::Max(hn::Sub(hn::Abs(z), hn::Set(d, half_sizes[2])), zero);
  return hn::MulAdd(bx, bx, hn::MulAdd(by, by, hn::Mul(bz, bz)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Along(D d, V x, V y, V z, const float* axis) {
  return hn::MulAdd(hn::Set(d, axis[0]), x,
                    hn::MulAdd(hn::Set(d, axis[1]), y, hn::Mul(hn::Set(d, axis[2]), z)));
}

/// Distance from the line through the origin along `axis`, of a point `t` along it.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Across(D d, V x, V y, V z, V t, const float* axis) {
  // From the perpendicular itself: the difference of squares would lose half of the digits.
  const V px = hn::NegMulAdd(t, hn::Set(d, axis[0]), x);
  const V py = hn::NegMulAdd(t, hn::Set(d, axis[1]), y);
  const V pz = hn::NegMulAdd(t, hn::Set(d, axis[2]), z);
  return hn::Sqrt(hn::MulAdd(px, px, hn::MulAdd(py, py, hn::Mul(pz, pz))));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V SquaredBeyondCylinder(D d, V rho, V t, float radius, float half_length) {
  const V zero = hn::Zero(d);
  const V side = hn::Max(hn::Sub(rho, hn::Set(d, radius)), zero);
  const V end = hn::Max(hn::Sub(hn::Abs(t), hn::Set(d, half_length)), zero);
  return hn::MulAdd(side, side, hn::Mul(end, end));
}

/// Squared distance from a cone to a point `t` along its axis from the middle, `rho` across.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SquaredBeyondCone(D d, V rho, V t, float radius, float half_length) {
  const V zero = hn::Zero(d);
  const V below = hn::Sub(hn::Set(d, -half_length), t);  // > 0 below the base
  const V side = hn::Max(hn::Sub(rho, hn::Set(d, radius)), zero);
  const V to_base = hn::MulAdd(side, side, hn::Mul(below, below));
  // The slant from the apex (0, h) to the rim (radius, -h).
  const float length = 2 * half_length;
  const float squared = radius * radius + length * length;
  const V from_apex = hn::Sub(t, hn::Set(d, half_length));
  V s = hn::NegMulAdd(hn::Set(d, length), from_apex, hn::Mul(hn::Set(d, radius), rho));
  s = hn::Min(hn::Max(hn::Mul(s, hn::Set(d, 1 / squared)), zero), hn::Set(d, 1.0f));
  const V across = hn::NegMulAdd(s, hn::Set(d, radius), rho);
  const V along = hn::MulAdd(s, hn::Set(d, length), from_apex);
  const V to_slant = hn::MulAdd(across, across, hn::Mul(along, along));
  const V outward = hn::MulAdd(hn::Set(d, length), rho, hn::Mul(hn::Set(d, radius), from_apex));
  const auto inside = hn::And(hn::Le(outward, zero), hn::Le(below, zero));
  return hn::IfThenZeroElse(inside, hn::Min(to_base, to_slant));
}

/// Squared distance from the solid to points in W, 0 inside.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SquaredDistance(D d, const Solid& solid, V px, V py, V pz) {
  const V x = hn::Sub(px, hn::Set(d, solid.center[0]));
  const V y = hn::Sub(py, hn::Set(d, solid.center[1]));
  const V z = hn::Sub(pz, hn::Set(d, solid.center[2]));
  const float* v = solid.v;
  const V zero = hn::Zero(d);
  switch (solid.kind) {
    case Kind::kUprightBox: {
      const V cosine = hn::Set(d, v[0]);
      const V sine = hn::Set(d, v[1]);
      return SquaredBeyond(d, hn::MulAdd(cosine, x, hn::Mul(sine, y)),
                           hn::NegMulAdd(sine, x, hn::Mul(cosine, y)), z, v + 2);
    }
    case Kind::kBox:
      return SquaredBeyond(d, Along(d, x, y, z, v), Along(d, x, y, z, v + 3),
                           Along(d, x, y, z, v + 6), v + 9);
    case Kind::kUprightCylinder:
      return SquaredBeyondCylinder(d, hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y))), z, v[0], v[1]);
    case Kind::kCylinder: {
      const V t = Along(d, x, y, z, v);
      return SquaredBeyondCylinder(d, Across(d, x, y, z, t, v), t, v[3], v[4]);
    }
    case Kind::kSphere: {
      const V distance = hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
      const V beyond = hn::Max(hn::Sub(distance, hn::Set(d, v[0])), zero);
      return hn::Mul(beyond, beyond);
    }
    case Kind::kCapsule: {
      const V half_length = hn::Set(d, v[4]);
      const V t = Along(d, x, y, z, v);
      const V nearest = hn::Min(hn::Max(t, hn::Neg(half_length)), half_length);
      const V beyond = hn::Max(hn::Sub(Across(d, x, y, z, nearest, v), hn::Set(d, v[3])), zero);
      return hn::Mul(beyond, beyond);
    }
    case Kind::kCone: {
      const V t = Along(d, x, y, z, v);
      return SquaredBeyondCone(d, Across(d, x, y, z, t, v), t, v[3], v[4]);
    }
    case Kind::kHalfSpace: {
      const V above = hn::Max(Along(d, x, y, z, v), zero);
      return hn::Mul(above, above);
    }
  }
  return zero;
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
