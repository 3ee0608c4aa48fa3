// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_POINTS_INL_H_
#undef PLANBENCH_KERNELS_POINTS_INL_H_
#else
#define PLANBENCH_KERNELS_POINTS_INL_H_
#endif

#include <hwy/highway.h>

#include "collision/simd/kernels/sphere_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// As many lanes of a block as a vector has.
using Lanes = hn::CappedTag<float, kBlock>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;

/// The same number in every lane.
HWY_INLINE V Fill(float value) { return hn::Set(Lanes(), value); }
HWY_INLINE V Zero() { return hn::Zero(Lanes()); }
HWY_INLINE V Load(const float* lanes) { return hn::Load(Lanes(), lanes); }
HWY_INLINE void Store(V v, float* lanes) { hn::Store(v, Lanes(), lanes); }
HWY_INLINE bool None(M mask) { return hn::AllFalse(Lanes(), mask); }
HWY_INLINE LaneMask Bits(M mask) {
  alignas(64) std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Lanes(), mask, bits);
  return static_cast<LaneMask>(bits[0]) | static_cast<LaneMask>(bits[1]) << 8;
}
/// The mask of so many bits.
HWY_INLINE M MaskOf(LaneMask lanes) {
  alignas(64) const std::uint8_t bits[8] = {static_cast<std::uint8_t>(lanes),
                                            static_cast<std::uint8_t>(lanes >> 8)};
  return hn::LoadMaskBits(Lanes(), bits);
}
/// What of v is above 0.
HWY_INLINE V Positive(V v) { return hn::Max(v, Zero()); }
HWY_INLINE V Squared(V v) { return v * v; }

/// A point (or vector) a lane, m.
struct Points {
  // Declared, for what GCC declares by itself is of no instruction set, and NEON's vectors have
  // constructors that are to be inlined into functions of theirs.
  Points() = default;
  HWY_INLINE Points(V x_in, V y_in, V z_in) : x(x_in), y(y_in), z(z_in) {}
  V x, y, z;
};

HWY_INLINE Points Fill(const float* xyz) { return {Fill(xyz[0]), Fill(xyz[1]), Fill(xyz[2])}; }
HWY_INLINE Points LoadPoints(const float* lanes) {
  return {Load(lanes), Load(lanes + kBlock), Load(lanes + 2 * kBlock)};
}
HWY_INLINE void Store(const Points& p, float* lanes) {
  Store(p.x, lanes);
  Store(p.y, lanes + kBlock);
  Store(p.z, lanes + 2 * kBlock);
}

HWY_INLINE Points operator+(const Points& a, const Points& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Points operator-(const Points& a, const Points& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Points Abs(const Points& p) { return {hn::Abs(p.x), hn::Abs(p.y), hn::Abs(p.z)}; }
HWY_INLINE Points Positive(const Points& p) {
  return {Positive(p.x), Positive(p.y), Positive(p.z)};
}
HWY_INLINE V Dot(const Points& a, const Points& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, a.z * b.z));
}
HWY_INLINE V SquaredNorm(const Points& p) { return Dot(p, p); }
HWY_INLINE Points Cross(const Points& a, const Points& b) {
  return {hn::MulSub(a.y, b.z, a.z * b.y), hn::MulSub(a.z, b.x, a.x * b.z),
          hn::MulSub(a.x, b.y, a.y * b.x)};
}
/// p - t v.
HWY_INLINE Points NegMulAdd(V t, const Points& v, const Points& p) {
  return {hn::NegMulAdd(t, v.x, p.x), hn::NegMulAdd(t, v.y, p.y), hn::NegMulAdd(t, v.z, p.z)};
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
