#include "collision/simd/kernels/sphere_kernel.h"

// Vectors are members of a struct here, which instruction sets of unknown vector length refuse.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/simd/kernels/sphere_kernel.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "collision/simd/kernels/check_pass-inl.h"
#include "collision/simd/kernels/distance_pass-inl.h"
#include "collision/simd/kernels/lanes-inl.h"
#include "collision/simd/kernels/sin_cos-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

template <bool kAround>
void RunCheck(const SphereRobot& robot, const SphereWorld& world, SphereScratch::Buffers* buffers,
              const BlockQuery& query, BlockVerdict* verdict) {
  const Lanes d;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kBlock; lane += width) {
    const LaneMask lanes = (query.lanes >> lane) & ((LaneMask{1} << width) - 1);
    if (lanes == 0) continue;
    CheckPass<kAround> pass(robot, world, buffers, query, lane, MaskOf(lanes));
    pass.Run();
    const BlockVerdict part = pass.verdict();
    verdict->hits |= part.hits << lane;
    verdict->certain |= part.certain << lane;
    verdict->doubts |= part.doubts << lane;
    if (query.stop_at_first && verdict->certain != 0) return;
  }
}

BlockVerdict CheckBlockImpl(const SphereRobot& robot, const SphereWorld& world,
                            SphereScratch::Buffers* buffers, const BlockQuery& query) {
  BlockVerdict verdict;
  if (query.half_widths != nullptr) {
    RunCheck<true>(robot, world, buffers, query, &verdict);
  } else {
    RunCheck<false>(robot, world, buffers, query, &verdict);
  }
  return verdict;
}

void BlockDistancesImpl(const SphereRobot& robot, const SphereWorld& world,
                        SphereScratch::Buffers* buffers, const float* q, float at_most,
                        float* distances) {
  const Lanes d;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kBlock; lane += width) {
    const DistancePass pass(robot, world, buffers, q, lane, at_most);
    hn::StoreU(pass.best(), d, distances + lane);
  }
}

void BlockSinCosImpl(const float* angles, float* sines, float* cosines) {
  const Lanes d;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kBlock; lane += width) {
    V sine, cosine;
    SinCos(hn::LoadU(d, angles + lane), &sine, &cosine);
    hn::StoreU(sine, d, sines + lane);
    hn::StoreU(cosine, d, cosines + lane);
  }
}

const char* InstructionSetImpl() { return hwy::TargetName(HWY_TARGET); }

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planbench::kernels {

HWY_EXPORT(CheckBlockImpl);
HWY_EXPORT(BlockDistancesImpl);
HWY_EXPORT(RowsToLanes);
HWY_EXPORT(SamplesToLanes);
HWY_EXPORT(BlockSinCosImpl);
HWY_EXPORT(InstructionSetImpl);

BlockVerdict CheckBlock(const SphereRobot& robot, const SphereWorld& world, SphereScratch* scratch,
                        const BlockQuery& query) {
  return HWY_DYNAMIC_DISPATCH(CheckBlockImpl)(robot, world, &scratch->buffers(), query);
}

void BlockDistances(const SphereRobot& robot, const SphereWorld& world, SphereScratch* scratch,
                    const float* q, float at_most, float* distances) {
  HWY_DYNAMIC_DISPATCH(BlockDistancesImpl)
  (robot, world, &scratch->buffers(), q, at_most, distances);
}

LaneMask PlaceRows(const Joints& joints, const double* rows, int num_rows, float* q) {
  return HWY_DYNAMIC_DISPATCH(RowsToLanes)(joints, rows, num_rows, q);
}

void PlaceSamples(const Joints& joints, const SampleBlock& block, float* q, float* half_widths) {
  HWY_DYNAMIC_DISPATCH(SamplesToLanes)(joints, block, q, half_widths);
}

void BlockSinCos(const float* angles, float* sines, float* cosines) {
  HWY_DYNAMIC_DISPATCH(BlockSinCosImpl)(angles, sines, cosines);
}

const char* InstructionSet() { return HWY_DYNAMIC_DISPATCH(InstructionSetImpl)(); }

}  // namespace planbench::kernels
#endif
