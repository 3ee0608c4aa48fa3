// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_BOXES_INL_H_
#undef PLANBENCH_KERNELS_BOXES_INL_H_
#else
#define PLANBENCH_KERNELS_BOXES_INL_H_
#endif

#include <cmath>

#include "collision/simd/kernels/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

// One thing against the boxes of a group, a box a lane.

/// Squared distances of a point from the boxes of a group, from `first` on.
HWY_INLINE V SquaredToBoxes(const BoxGroup& group, int first, const Points& p) {
  const auto beyond = [&](int axis, V value) {
    return Positive(
        hn::Max(Load(group.low[axis] + first) - value, value - Load(group.high[axis] + first)));
  };
  return SquaredNorm({beyond(0, p.x), beyond(1, p.y), beyond(2, p.z)});
}

/// Boxes of a group within `reach` of a point, by bit.
inline LaneMask BoxesWithin(const BoxGroup& group, const float* point, float reach) {
  const int width = static_cast<int>(hn::Lanes(Lanes()));
  const Points p = Fill(point);
  LaneMask near = 0;
  for (int first = 0; first < kWide; first += width) {
    near |= Bits(hn::Le(SquaredToBoxes(group, first, p), Fill(reach * reach))) << first;
  }
  return near;
}

/// Boxes of a group, by bit, that no plane along a face of theirs or of another box separates from
/// that by more than `margin`. It is given in a frame B, of which the pose in the group's is given.
inline LaneMask BoxesNear(const BoxGroup& group, const CenteredBox& box_B, const Transform& X_AB,
                          float margin) {
  const int width = static_cast<int>(hn::Lanes(Lanes()));
  const float* R = X_AB.rotation;
  float size[9];
  for (int i = 0; i < 9; ++i) size[i] = std::abs(R[i]);
  float center[3];
  X_AB.Times(box_B.center, center);
  const float* half = box_B.half_size;
  LaneMask near = 0;
  for (int first = 0; first < kWide; first += width) {
    V low[3], high[3];
    M apart = hn::FirstN(Lanes(), 0);
    for (int axis = 0; axis < 3; ++axis) {
      const float* s = size + 3 * axis;
      const float reach = s[0] * half[0] + s[1] * half[1] + s[2] * half[2] + margin;
      low[axis] = Load(group.low[axis] + first);
      high[axis] = Load(group.high[axis] + first);
      apart = hn::Or(apart, hn::Or(hn::Gt(low[axis], Fill(center[axis] + reach)),
                                   hn::Lt(high[axis], Fill(center[axis] - reach))));
    }
    if (hn::AllTrue(Lanes(), apart)) continue;
    V from[3], extent[3];
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = hn::MulSub(low[axis] + high[axis], Fill(0.5f), Fill(center[axis]));
      extent[axis] = (high[axis] - low[axis]) * Fill(0.5f);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const V along =
          hn::MulAdd(Fill(R[axis]), from[0],
                     hn::MulAdd(Fill(R[3 + axis]), from[1], Fill(R[6 + axis]) * from[2]));
      const V reach = hn::MulAdd(
          Fill(size[axis]), extent[0],
          hn::MulAdd(Fill(size[3 + axis]), extent[1],
                     hn::MulAdd(Fill(size[6 + axis]), extent[2], Fill(half[axis] + margin))));
      apart = hn::Or(apart, hn::Gt(hn::Abs(along), reach));
    }
    near |= Bits(hn::Not(apart)) << first;
  }
  return near;
}

/// One of the boxes.
inline CenteredBox BoxOf(const BoxGroup& group, int i) {
  CenteredBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.center[axis] = (group.low[axis][i] + group.high[axis][i]) / 2;
    // The rounding of the center, too.
    box.half_size[axis] = (group.high[axis][i] - group.low[axis][i]) / 2 + 1e-6f;
  }
  return box;
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
