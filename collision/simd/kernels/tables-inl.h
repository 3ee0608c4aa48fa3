// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_TABLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_TABLES_INL_H_
#undef PLANBENCH_KERNELS_TABLES_INL_H_
#else
#define PLANBENCH_KERNELS_TABLES_INL_H_
#endif

#include "collision/simd/kernels/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

using Indices = hn::Vec<hn::RebindToSigned<Lanes>>;

/// Of the cell of a value, by cells, the nearest there is.
HWY_INLINE Indices CellOf(V cells, float size) {
  return hn::ConvertTo(hn::RebindToSigned<Lanes>(),
                       hn::Min(hn::Max(cells, Zero()), Fill(size - 1)));
}

/// Bytes of words, as numbers.
HWY_INLINE V Numbers(const std::uint32_t* words, Indices index) {
  const hn::RebindToSigned<Lanes> di;
  const hn::RebindToUnsigned<Lanes> du;
  const auto bits = hn::ShiftLeft<3>(hn::And(hn::BitCast(du, index), hn::Set(du, 3u)));
  const auto word = hn::GatherIndex(du, words, hn::ShiftRight<2>(index));
  return hn::ConvertTo(Lanes(), hn::BitCast(di, hn::And(word >> bits, hn::Set(du, 255u))));
}

/// Lower bounds of how far a table's bodies are apart, m; q: [joint][kBlock].
HWY_INLINE V TableBound(const JointTable& table, const float* q) {
  const auto cell = [&](int k) {
    const V position = hn::LoadU(Lanes(), q + table.joints[k] * kBlock);
    return CellOf((position - Fill(table.low[k])) * Fill(table.cells_per[k]), table.size[k]);
  };
  const hn::RebindToSigned<Lanes> di;
  const auto row = hn::Set(di, static_cast<std::int32_t>(table.size[0]));
  return Numbers(table.values.data(), cell(0) + row * cell(1)) * Fill(table.step);
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
