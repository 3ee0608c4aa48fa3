// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_SOLIDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_SOLIDS_INL_H_
#undef PLANBENCH_KERNELS_SOLIDS_INL_H_
#else
#define PLANBENCH_KERNELS_SOLIDS_INL_H_
#endif

#include "collision/simd/kernels/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

// Squared distances of points p, given in frames that suit the solids; 0 inside.

HWY_INLINE V SquaredBeyondBox(const Points& p, const float* half_size) {
  return SquaredNorm(Positive(Abs(p) - Fill(half_size)));
}

/// Of points `t` along the axis from the middle, `rho` across.
HWY_INLINE V SquaredBeyondCylinder(V rho, V t, float radius, float half_length) {
  const V side = Positive(rho - Fill(radius));
  const V end = Positive(hn::Abs(t) - Fill(half_length));
  return hn::MulAdd(side, side, end * end);
}

/// Likewise; the apex is at t = half_length.
HWY_INLINE V SquaredBeyondCone(V rho, V t, float radius, float half_length) {
  const V below = Fill(-half_length) - t;  // > 0 below the base
  const V side = Positive(rho - Fill(radius));
  const V to_base = hn::MulAdd(side, side, below * below);
  // The slant from the apex (0, h) to the rim (radius, -h).
  const float length = 2 * half_length;
  const float squared = radius * radius + length * length;
  const V from_apex = t - Fill(half_length);
  V s = hn::NegMulAdd(Fill(length), from_apex, Fill(radius) * rho);
  s = hn::Min(Positive(s * Fill(1 / squared)), Fill(1.0f));
  const V across = hn::NegMulAdd(s, Fill(radius), rho);
  const V along = hn::MulAdd(s, Fill(length), from_apex);
  const V to_slant = hn::MulAdd(across, across, along * along);
  const V outward = hn::MulAdd(Fill(length), rho, Fill(radius) * from_apex);
  const M inside = hn::And(hn::Le(outward, Zero()), hn::Le(below, Zero()));
  return hn::IfThenZeroElse(inside, hn::Min(to_base, to_slant));
}

/// Distance from the line through the origin along `axis`, of a point `t` along it.
HWY_INLINE V Across(const Points& p, V t, const Points& axis) {
  // From the perpendicular itself: the difference of squares would lose half of the digits.
  return hn::Sqrt(SquaredNorm(NegMulAdd(t, axis, p)));
}

/// Squared distance from the solid to points in W, 0 inside.
HWY_INLINE V SquaredDistance(const Solid& solid, const Points& p_W) {
  const Points p = p_W - Fill(solid.center);
  const float* v = solid.v;
  switch (solid.kind) {
    case Kind::kUprightBox: {
      const V cosine = Fill(v[0]);
      const V sine = Fill(v[1]);
      return SquaredBeyondBox(
          {hn::MulAdd(cosine, p.x, sine * p.y), hn::NegMulAdd(sine, p.x, cosine * p.y), p.z},
          v + 2);
    }
    case Kind::kBox:
      return SquaredBeyondBox({Dot(Fill(v), p), Dot(Fill(v + 3), p), Dot(Fill(v + 6), p)}, v + 9);
    case Kind::kUprightCylinder:
      return SquaredBeyondCylinder(hn::Sqrt(hn::MulAdd(p.x, p.x, p.y * p.y)), p.z, v[0], v[1]);
    case Kind::kCylinder: {
      const Points axis = Fill(v);
      const V t = Dot(axis, p);
      return SquaredBeyondCylinder(Across(p, t, axis), t, v[3], v[4]);
    }
    case Kind::kSphere:
      return Squared(Positive(hn::Sqrt(SquaredNorm(p)) - Fill(v[0])));
    case Kind::kCapsule: {
      const Points axis = Fill(v);
      const V half_length = Fill(v[4]);
      const V nearest = hn::Min(hn::Max(Dot(axis, p), hn::Neg(half_length)), half_length);
      return Squared(Positive(Across(p, nearest, axis) - Fill(v[3])));
    }
    case Kind::kCone: {
      const Points axis = Fill(v);
      const V t = Dot(axis, p);
      return SquaredBeyondCone(Across(p, t, axis), t, v[3], v[4]);
    }
    case Kind::kHalfSpace:
      return Squared(Positive(Dot(Fill(v), p)));
  }
  return Zero();
}

/// From the nearest points of the solid to points in W; 0 inside, and of solids of rarer kinds.
HWY_INLINE Points FromSolid(const Solid& solid, const Points& p_W) {
  const Points p = p_W - Fill(solid.center);
  const float* v = solid.v;
  const auto beyond = [](V value, float half) {
    return value - hn::Min(hn::Max(value, Fill(-half)), Fill(half));
  };
  switch (solid.kind) {
    case Kind::kUprightBox: {
      const V cosine = Fill(v[0]);
      const V sine = Fill(v[1]);
      const V x = beyond(hn::MulAdd(cosine, p.x, sine * p.y), v[2]);
      const V y = beyond(hn::NegMulAdd(sine, p.x, cosine * p.y), v[3]);
      return {hn::NegMulAdd(sine, y, cosine * x), hn::MulAdd(sine, x, cosine * y),
              beyond(p.z, v[4])};
    }
    case Kind::kBox: {
      const Points along[3] = {Fill(v), Fill(v + 3), Fill(v + 6)};
      Points sum = {Zero(), Zero(), Zero()};
      for (int k = 0; k < 3; ++k) {
        sum = NegMulAdd(hn::Neg(beyond(Dot(along[k], p), v[9 + k])), along[k], sum);
      }
      return sum;
    }
    case Kind::kUprightCylinder: {
      const V rho = hn::Sqrt(hn::MulAdd(p.x, p.x, p.y * p.y));
      const V part = Positive(rho - Fill(v[0])) / hn::Max(rho, Fill(1e-9f));
      return {p.x * part, p.y * part, beyond(p.z, v[1])};
    }
    case Kind::kSphere: {
      const V distance = hn::Sqrt(SquaredNorm(p));
      const V part = Positive(distance - Fill(v[0])) / hn::Max(distance, Fill(1e-9f));
      return {p.x * part, p.y * part, p.z * part};
    }
    case Kind::kCylinder:
    case Kind::kCapsule:
    case Kind::kCone:
    case Kind::kHalfSpace:
      break;
  }
  return {Zero(), Zero(), Zero()};
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
