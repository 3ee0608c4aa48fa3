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

/// Cells by their numbers along the axes, whole numbers; they may be outside of the grid.
HWY_INLINE M WithinGrid(const DistanceGrid& grid, const Points& cell) {
  const auto within = [&](V c, int axis) {
    return hn::And(hn::Ge(c, Zero()), hn::Lt(c, Fill(static_cast<float>(grid.size[axis]))));
  };
  return hn::And(within(cell.x, 0), hn::And(within(cell.y, 1), within(cell.z, 2)));
}

HWY_INLINE V CellValue(const DistanceGrid& grid, const Points& cell, float outside) {
  const hn::RebindToSigned<Lanes> di;
  const M inside = WithinGrid(grid, cell);
  // Converted one by one: as floats, indices beyond 2^24 would be rounded.
  const auto index =
      hn::ConvertTo(di, cell.x) +
      hn::Set(di, grid.size[0]) *
          (hn::ConvertTo(di, cell.y) + hn::Set(di, grid.size[1]) * hn::ConvertTo(di, cell.z));
  const auto safe = hn::IfThenElseZero(hn::RebindMask(di, inside), index);
  return hn::IfThenElse(inside, hn::GatherIndex(Lanes(), grid.values, safe), Fill(outside));
}

/// Points in cells: p = origin + resolution * scaled.
HWY_INLINE Points ScaledToGrid(const DistanceGrid& grid, const Points& p) {
  const V scale = Fill(1 / grid.resolution);
  const Points from_origin = p - Fill(grid.origin);
  return {from_origin.x * scale, from_origin.y * scale, from_origin.z * scale};
}

HWY_INLINE Points Floor(const Points& p) {
  return {hn::Floor(p.x), hn::Floor(p.y), hn::Floor(p.z)};
}

/// Grid values at points.
HWY_INLINE V GridDistance(const DistanceGrid& grid, const Points& p, float outside) {
  return CellValue(grid, Floor(ScaledToGrid(grid, p)), outside);
}

/// Of the lanes `open`, those in which a point within `motion` of p may have a value below `radius`
/// (the value at p itself included).
HWY_INLINE M MeetsGridAround(const DistanceGrid& grid, const Points& p, V motion, float radius,
                             M open) {
  const Points scaled = ScaledToGrid(grid, p);
  const Points cell = Floor(scaled);
  const V half = Fill(0.5f);
  const Points middle = {cell.x + half, cell.y + half, cell.z + half};
  const Points off = scaled - middle;
  const V reach = (motion + Fill(grid.rounding)) * Fill(1 / grid.resolution);  // cells

  // Values differ by no more than the middles of their cells are apart, and the middle of a cell
  // that is reached is within half a diagonal of a point that is. The cell of the grid that is
  // nearest to one outside is nearer than that to all others.
  const auto clamped = [&](V c, int axis) {
    return hn::Min(hn::Max(c, Zero()), Fill(static_cast<float>(grid.size[axis] - 1)));
  };
  const Points known = {clamped(cell.x, 0), clamped(cell.y, 1), clamped(cell.z, 2)};
  const V apart = reach + hn::Sqrt(SquaredNorm(off)) + Fill(0.86604f);
  const V least = hn::NegMulAdd(apart, Fill(grid.resolution), CellValue(grid, known, 0.0f));
  const M walls = hn::AndNot(WithinGrid(grid, cell), hn::Lt(Fill(grid.outside), Fill(radius)));
  open = hn::And(open, hn::Or(walls, hn::Lt(least, Fill(radius))));
  if (None(open)) return open;

  // Where a point moves less than to the far faces of its cell, what it can reach is its cell and
  // the neighbours on its near sides: their values decide.
  const Points far = Abs(off);
  const V nearest_far = hn::Min(far.x, hn::Min(far.y, far.z)) + half;
  const M few = hn::And(open, hn::Lt(reach, nearest_far));
  if (None(few)) return open;
  M meets = hn::And(few, hn::Lt(CellValue(grid, cell, grid.outside), Fill(radius)));
  const V squared_reach = Squared(reach);
  const V one = Fill(1.0f);
  for (int sides = 1; sides < 8; ++sides) {
    Points neighbour = cell;
    V squared = Zero();
    const auto step = [&](V* c, V offset) {
      *c = *c + hn::CopySign(one, offset);
      squared = squared + Squared(half - hn::Abs(offset));
    };
    if ((sides & 1) != 0) step(&neighbour.x, off.x);
    if ((sides & 2) != 0) step(&neighbour.y, off.y);
    if ((sides & 4) != 0) step(&neighbour.z, off.z);
    const M reached = hn::And(few, hn::Le(squared, squared_reach));
    if (None(reached)) continue;
    meets = hn::Or(
        meets, hn::And(reached, hn::Lt(CellValue(grid, neighbour, grid.outside), Fill(radius))));
  }
  return hn::Or(meets, hn::AndNot(few, open));
}

/// How far grid values at two points may differ beyond the distance of the points: each is that of
/// the middle of its cell.
HWY_INLINE float GridSlack(const DistanceGrid& grid) {
  return 1.7321f * grid.resolution + 2 * grid.rounding;
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
