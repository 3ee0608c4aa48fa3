#pragma once

#include <cstddef>
#include <cstdint>

#include "planner_rrtc/flat_joints.h"

namespace planbench {

/// Points in blocks of kScanBlock: joint by joint, the coordinates of a block's points side by
/// side; bounded joints first, then continuous ones.
inline constexpr std::size_t kScanBlock = 16;

struct ScanPoints {
  const float* blocks;
  std::size_t num_blocks;
  std::size_t num_bounded;     ///< Joints that do not wrap.
  std::size_t num_continuous;  ///< Joints that wrap, in [-pi, pi].
  Metric metric = Metric::kL2;
};

struct ScanResult {
  std::int32_t point;
  float square;  ///< Squared L2 distance, or the sum.
};

/// The point nearest to `query` (coordinates in the order of the blocks); of several at the same
/// distance, the first. Vectorised for the machine it runs on.
ScanResult ScanForNearest(const ScanPoints& points, const float* query);

}  // namespace planbench
