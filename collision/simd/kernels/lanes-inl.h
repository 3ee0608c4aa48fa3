// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_LANES_INL_H_
#undef PLANBENCH_KERNELS_LANES_INL_H_
#else
#define PLANBENCH_KERNELS_LANES_INL_H_
#endif

#include <algorithm>

#include "collision/simd/kernels/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// The first `num` numbers of a vector, the others 0. Where a vector has two, a masked load reads
/// both, and takes them for aligned.
template <typename D>
HWY_INLINE hn::Vec<D> LoadFirst(D d, const double* from, int num) {
  if constexpr (hn::MaxLanes(D()) > 2) {
    return hn::MaskedLoad(hn::FirstN(d, static_cast<std::size_t>(num)), d, from);
  } else {
    alignas(16) const double both[2] = {from[0], num > 1 ? from[1] : 0};
    return hn::Load(d, both);
  }
}

/// See PlaceRows.
LaneMask RowsToLanes(const Joints& joints, const double* rows, int num_rows, float* q) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const int width = static_cast<int>(hn::Lanes(d));
  const auto period = hn::Set(d, 6.283185307179586);
  const auto per_period = hn::Set(d, 0.15915494309189535);
  LaneMask outside = 0;
  const int num_joints = joints.size();
  for (int first = 0; first < num_joints; first += width) {
    const int num = std::min(width, num_joints - first);
    const auto lower = LoadFirst(d, joints.lower.data() + first, num);
    const auto upper = LoadFirst(d, joints.upper.data() + first, num);
    alignas(64) double turning[8];
    for (int j = 0; j < width; ++j) {
      turning[j] = j < num && joints.slides[static_cast<std::size_t>(first + j)] == 0 ? 1 : 0;
    }
    const auto turns_scale = per_period * hn::Load(d, turning);
    for (int row = 0; row < num_rows; ++row) {
      auto value = LoadFirst(d, rows + row * num_joints + first, num);
      const auto inside = hn::And(hn::Ge(value, lower), hn::Le(value, upper));
      outside |= static_cast<LaneMask>(!hn::AllTrue(d, inside)) << row;
      value = hn::NegMulAdd(hn::Round(value * turns_scale), period, value);
      alignas(64) float narrow[8];
      hn::Store(hn::DemoteTo(df, value), df, narrow);
      float* out = q + first * kBlock + row;
      for (int j = 0; j < num; ++j) out[j * kBlock] = narrow[j];
    }
  }
  return outside;
}

/// See PlaceSamples.
void SamplesToLanes(const Joints& joints, const SampleBlock& block, float* q, float* half_widths) {
  const Lanes d;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kBlock; lane += width) {
    const V position = hn::LoadU(d, block.position + lane);
    const V half_length = hn::LoadU(d, block.half_length + lane);
    for (int j = 0; j < joints.size(); ++j) {
      const V motion = Fill(block.motion[j]);
      V value = hn::MulAdd(position, motion, Fill(block.start[j]));
      if (joints.slides[static_cast<std::size_t>(j)] == 0) {
        const V turns = hn::Round(value * Fill(0.15915494f));
        value = hn::NegMulAdd(turns, Fill(6.2831853f), value);
      }
      hn::StoreU(value, d, q + j * kBlock + lane);
      hn::StoreU(half_length * hn::Abs(motion), d, half_widths + j * kBlock + lane);
    }
  }
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
