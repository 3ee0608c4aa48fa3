// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_SIN_COS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_SIN_COS_INL_H_
#undef PLANBENCH_KERNELS_SIN_COS_INL_H_
#else
#define PLANBENCH_KERNELS_SIN_COS_INL_H_
#endif

#include "collision/simd/kernels/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// Sine and cosine of |x| <= 2 pi, absolute error below 2e-7: the argument is brought into
/// [-pi/4, pi/4] by a multiple of pi/2 in two parts, where minimax polynomials (Remez, errors 2e-9
/// and 1e-10) are taken.
HWY_INLINE void SinCos(V x, V* sine, V* cosine) {
  const Lanes d;
  const hn::RebindToSigned<Lanes> di;
  const V quadrant = hn::Round(x * Fill(0.63661977236758134f));
  V r = hn::NegMulAdd(quadrant, Fill(1.57079601287841796875f), x);
  r = hn::NegMulAdd(quadrant, Fill(3.139164786504813e-7f), r);
  const V r2 = r * r;
  V s = hn::MulAdd(r2, Fill(-1.9494950322661964e-4f), Fill(8.331973266706042e-3f));
  s = hn::MulAdd(r2, s, Fill(-1.666665057348295e-1f));
  s = hn::MulAdd(r2 * r, s, r);
  V c = hn::MulAdd(r2, Fill(2.4437730097569468e-5f), Fill(-1.3887361450182398e-3f));
  c = hn::MulAdd(r2, c, Fill(4.166664674777541e-2f));
  c = hn::MulAdd(r2 * r2, c, hn::NegMulAdd(r2, Fill(0.5f), Fill(1.0f)));

  const auto k = hn::ConvertTo(di, quadrant);
  const auto one = hn::Set(di, 1);
  const auto two = hn::Set(di, 2);
  // Odd quadrants swap the two; the sine is negative in quadrants 2 and 3, the cosine in 1 and 2.
  const M swap = hn::RebindMask(d, hn::TestBit(k, one));
  const V sine_sign = hn::BitCast(d, hn::ShiftLeft<30>(hn::And(k, two)));
  const V cosine_sign = hn::BitCast(d, hn::ShiftLeft<30>(hn::And(k + one, two)));
  *sine = hn::Xor(hn::IfThenElse(swap, c, s), sine_sign);
  *cosine = hn::Xor(hn::IfThenElse(swap, s, c), cosine_sign);
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
