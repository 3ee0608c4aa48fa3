// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_MOTION_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_MOTION_BOUNDS_INL_H_
#undef PLANBENCH_KERNELS_MOTION_BOUNDS_INL_H_
#else
#define PLANBENCH_KERNELS_MOTION_BOUNDS_INL_H_
#endif

#include "collision/simd/kernels/points-inl.h"
#include "collision/simd/kernels/scratch.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// Upper bounds of motions over the boxes of configurations that lanes stand for, m, margins
/// included. Not kAround: lanes stand for configurations.
template <bool kAround>
class MotionBounds {
 public:
  MotionBounds(const SphereRobot& robot, SphereScratch::Buffers* buffers, const BlockQuery& query,
               int lane)
      : robot_(robot),
        sums_(buffers->width_sums.get()),
        query_(query),
        lane_(lane),
        margin_(kAround && query.margins != nullptr ? hn::LoadU(Lanes(), query.margins + lane)
                                                    : Zero()) {
    if constexpr (kAround) SumWidths();
  }

  /// Of a tree relative to what it is tested against, or of a part of it, whose weights stand from
  /// `first` on; only joints of `reach` count.
  HWY_INLINE V Of(const Reach& reach, int first) const {
    V sum = margin_;
    if constexpr (kAround) {
      const float* weights = robot_.reaches.data() + first;
      for (int j = reach.begin; j < reach.end; ++j) {
        sum = hn::MulAdd(Fill(weights[j]), HalfWidth(j), sum);
      }
    }
    return sum;
  }

  /// Not less than that of a whole tree, at less cost.
  HWY_INLINE V AtMost(const Reach& reach) const {
    if constexpr (!kAround) return margin_;
    const V widths = Load(sums_ + reach.end * kBlock) - Load(sums_ + reach.begin * kBlock);
    return hn::MulAdd(Fill(reach.most), widths, margin_);
  }

  /// Of two balls or groups relative to each other, by the joints that move their trees so: less,
  /// as a tree's bound is that of its furthest balls.
  HWY_INLINE V Between(const Reach& reach, int reach_a, int reach_b) const {
    V sum = margin_;
    // What turns about its middle stays where it is, but for points of patches.
    const float* moves = robot_.reaches.data() + reach.first + robot_.num_joints;
    const float* weights_a = robot_.reaches.data() + reach_a;
    const float* weights_b = robot_.reaches.data() + reach_b;
    for (int j = reach.begin; j < reach.end; ++j) {
      if (moves[j] != 0) sum = hn::MulAdd(Fill(weights_a[j] + weights_b[j]), HalfWidth(j), sum);
    }
    return sum;
  }

 private:
  HWY_INLINE V HalfWidth(int joint) const {
    return hn::LoadU(Lanes(), query_.half_widths + joint * kBlock + lane_);
  }

  void SumWidths() {
    V sum = Zero();
    for (int j = 0; j < robot_.num_joints; ++j) {
      Store(sum, sums_ + j * kBlock);
      // By more than the sum is rounded: no difference is below what lies between.
      sum = hn::MulAdd(sum, Fill(1 + 0x1p-22f), HalfWidth(j));
    }
    Store(sum, sums_ + robot_.num_joints * kBlock);
  }

  const SphereRobot& robot_;
  float* sums_;  ///< Of half widths, of the joints before each.
  const BlockQuery& query_;
  int lane_;
  V margin_;  ///< Part of every motion.
};

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
