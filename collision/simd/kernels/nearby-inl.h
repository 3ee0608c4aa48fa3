// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_NEARBY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_NEARBY_INL_H_
#undef PLANBENCH_KERNELS_NEARBY_INL_H_
#else
#define PLANBENCH_KERNELS_NEARBY_INL_H_
#endif

#include "collision/simd/kernels/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// Lists the solids that the hierarchy has near balls (of radius `reach`, in the lanes `alive`);
/// returns their number.
HWY_INLINE int ListNear(const SphereWorld& world, const Points& p, V reach, M alive,
                        std::int32_t* list) {
  const V squared_reach = Squared(reach);
  int num = 0;
  const int end = static_cast<int>(world.bvh.size());
  for (int i = 0; i < end;) {
    const BvhNode& node = world.bvh[static_cast<std::size_t>(i)];
    const Points below = Fill(node.low) - p;
    const Points above = p - Fill(node.high);
    const Points beyond =
        Positive({hn::Max(below.x, above.x), hn::Max(below.y, above.y), hn::Max(below.z, above.z)});
    if (None(hn::And(alive, hn::Le(SquaredNorm(beyond), squared_reach)))) {
      i = node.next;
      continue;
    }
    for (int k = 0; k < node.count; ++k) {
      list[num++] = world.bvh_solids[static_cast<std::size_t>(node.first + k)];
    }
    ++i;
  }
  return num;
}

/// Grid values at points.
HWY_INLINE V GridDistance(const DistanceGrid& grid, const Points& p, float outside) {
  const hn::RebindToSigned<Lanes> di;
  const V scale = Fill(1 / grid.resolution);
  const Points from_origin = p - Fill(grid.origin);
  const Points cell = {hn::Floor(from_origin.x * scale), hn::Floor(from_origin.y * scale),
                       hn::Floor(from_origin.z * scale)};
  const auto within = [&](V c, int axis) {
    return hn::And(hn::Ge(c, Zero()), hn::Lt(c, Fill(static_cast<float>(grid.size[axis]))));
  };
  const M inside = hn::And(within(cell.x, 0), hn::And(within(cell.y, 1), within(cell.z, 2)));
  // Converted one by one: as floats, indices beyond 2^24 would be rounded.
  const auto index =
      hn::ConvertTo(di, cell.x) +
      hn::Set(di, grid.size[0]) *
          (hn::ConvertTo(di, cell.y) + hn::Set(di, grid.size[1]) * hn::ConvertTo(di, cell.z));
  const auto safe = hn::IfThenElseZero(hn::RebindMask(di, inside), index);
  return hn::IfThenElse(inside, hn::GatherIndex(Lanes(), grid.values, safe), Fill(outside));
}

/// How far grid values at two points may differ beyond the distance of the points: each is that of
/// the middle of its cell.
HWY_INLINE float GridSlack(const DistanceGrid& grid) { return 1.7321f * grid.resolution; }

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
