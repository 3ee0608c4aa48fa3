#pragma once

#include <hwy/aligned_allocator.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/simd/kernels/sphere_kernel.h"

namespace planbench::kernels {

/// A plane that was between the hulls of two nodes when these were last asked for.
struct Plane {
  std::int32_t a = -1, b = -1;  ///< Nodes.
  float direction[3];  ///< Normal to it, from b to a, of any length, in the frame of body a.
  float least_a;       ///< Least direction . p over the hull of a.
};

struct SphereScratch::Buffers {
  std::size_t num_bodies = 0;
  std::size_t num_nodes = 0;
  hwy::AlignedFreeUniquePtr<float[]> poses;      ///< [body][12][kBlock]: R_WC row-major, p_WC.
  hwy::AlignedFreeUniquePtr<float[]> positions;  ///< [node][3][kBlock]: p_W.
  /// By node the placement that its position is of, then by node that of its children's.
  std::vector<std::uint32_t> placed;
  std::uint32_t placement = 0;
  /// [joint][lane]: half widths of the joints before.
  hwy::AlignedFreeUniquePtr<float[]> width_sums;
  /// Tests: indices of world trees, then of pairs behind no gate.
  std::vector<std::int32_t> order;
  /// Tests that left lanes open, by test whether it did, and whether that was looked for; see
  /// Tests.
  std::vector<std::int32_t> open;
  std::vector<unsigned char> is_open;
  bool knows_open = false;
  /// Those found last, by hash.
  std::array<Plane, 1024> planes;
  Plane& PlaneOf(int a, int b) {
    return planes[(static_cast<std::size_t>(a) * 31 + static_cast<std::size_t>(b)) % planes.size()];
  }
  std::vector<std::int32_t> all_solids;  ///< 0, 1, 2, ...
  std::vector<std::int32_t> lists;       ///< Of solids, one for every level of a tree of balls.
};

}  // namespace planbench::kernels
