// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_MATH_INL_H_
#undef PLANBENCH_KERNELS_MATH_INL_H_
#else
#define PLANBENCH_KERNELS_MATH_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sine and cosine of |x| <= 2 pi, absolute error below 2e-7: the argument is brought into
/// [-pi/4, pi/4] by a multiple of pi/2 in two parts, where minimax polynomials (Remez, errors 2e-9
/// and 1e-10) are taken.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void SinCos(D d, V x, V* sine, V* cosine) {
  const hn::RebindToSigned<D> di;
  const V quadrant = hn::Round(hn::Mul(x, hn::Set(d, 0.63661977236758134f)));
  V r = hn::NegMulAdd(quadrant, hn::Set(d, 1.57079601287841796875f), x);
  r = hn::NegMulAdd(quadrant, hn::Set(d, 3.139164786504813e-7f), r);
  const V r2 = hn::Mul(r, r);
  V s = hn::MulAdd(r2, hn::Set(d, -1.9494950322661964e-4f), hn::Set(d, 8.331973266706042e-3f));
  s = hn::MulAdd(r2, s, hn::Set(d, -1.666665057348295e-1f));
  s = hn::MulAdd(hn::Mul(r2, r), s, r);
  V c = hn::MulAdd(r2, hn::Set(d, 2.4437730097569468e-5f), hn::Set(d, -1.3887361450182398e-3f));
  c = hn::MulAdd(r2, c, hn::Set(d, 4.166664674777541e-2f));
  c = hn::MulAdd(hn::Mul(r2, r2), c, hn::NegMulAdd(r2, hn::Set(d, 0.5f), hn::Set(d, 1.0f)));

  const auto k = hn::ConvertTo(di, quadrant);
  const auto one = hn::Set(di, 1);
  const auto two = hn::Set(di, 2);
  // Odd quadrants swap the two; the sine is negative in quadrants 2 and 3, the cosine in 1 and 2.
  const auto swap = hn::RebindMask(d, hn::TestBit(k, one));
  const V sine_sign = hn::BitCast(d, hn::ShiftLeft<30>(hn::And(k, two)));
  const V cosine_sign = hn::BitCast(d, hn::ShiftLeft<30>(hn::And(hn::Add(k, one), two)));
  *sine = hn::Xor(hn::IfThenElse(swap, c, s), sine_sign);
  *cosine = hn::Xor(hn::IfThenElse(swap, s, c), cosine_sign);
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
