#include "planner_rrtc/nearest_scan.h"

#include <limits>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planner_rrtc/nearest_scan.cc"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planbench::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <Metric kMetric>
ScanResult ScanBy(const ScanPoints& points, const float* query) {
  const hn::CappedTag<float, kScanBlock> d;
  const hn::RebindToSigned<decltype(d)> di;
  const std::size_t lanes = hn::Lanes(d);
  const auto turn = hn::Set(d, 2 * std::numbers::pi_v<float>);
  const std::size_t n = points.num_bounded + points.num_continuous;

  const auto add = [](auto difference, auto sum) HWY_ATTR {
    if constexpr (kMetric == Metric::kSum) return hn::Add(hn::Abs(difference), sum);
    return hn::MulAdd(difference, difference, sum);
  };

  auto best = hn::Set(d, std::numeric_limits<float>::infinity());
  auto best_point = hn::Zero(di);
  auto point = hn::Iota(di, 0);
  const auto next = hn::Set(di, static_cast<std::int32_t>(lanes));
  for (std::size_t b = 0; b < points.num_blocks; ++b) {
    const float* block = points.blocks + b * n * kScanBlock;
    for (std::size_t lane = 0; lane < kScanBlock; lane += lanes) {
      const float* x = block + lane;
      auto square = hn::Zero(d);
      for (std::size_t j = 0; j < points.num_bounded; ++j, x += kScanBlock) {
        const auto difference = hn::Sub(hn::LoadU(d, x), hn::Set(d, query[j]));
        square = add(difference, square);
      }
      for (std::size_t j = points.num_bounded; j < n; ++j, x += kScanBlock) {
        const auto direct = hn::Abs(hn::Sub(hn::LoadU(d, x), hn::Set(d, query[j])));
        const auto difference = hn::Min(direct, hn::Sub(turn, direct));
        square = add(difference, square);
      }
      const auto closer = hn::Lt(square, best);
      best = hn::IfThenElse(closer, square, best);
      best_point = hn::IfThenElse(hn::RebindMask(di, closer), point, best_point);
      point = hn::Add(point, next);
    }
  }

  float squares[kScanBlock];
  std::int32_t numbers[kScanBlock];
  hn::StoreU(best, d, squares);
  hn::StoreU(best_point, di, numbers);
  ScanResult result{numbers[0], squares[0]};
  for (std::size_t k = 1; k < lanes; ++k) {
    if (squares[k] < result.square || (squares[k] == result.square && numbers[k] < result.point)) {
      result = {numbers[k], squares[k]};
    }
  }
  return result;
}

ScanResult Scan(const ScanPoints& points, const float* query) {
  return points.metric == Metric::kSum ? ScanBy<Metric::kSum>(points, query)
                                       : ScanBy<Metric::kL2>(points, query);
}

}  // namespace planbench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planbench {

HWY_EXPORT(Scan);

ScanResult ScanForNearest(const ScanPoints& points, const float* query) {
  return HWY_DYNAMIC_DISPATCH(Scan)(points, query);
}

}  // namespace planbench
#endif
