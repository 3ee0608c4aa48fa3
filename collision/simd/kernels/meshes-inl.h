// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_MESHES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_MESHES_INL_H_
#undef PLANBENCH_KERNELS_MESHES_INL_H_
#else
#define PLANBENCH_KERNELS_MESHES_INL_H_
#endif

#include <bit>
#include <cmath>
#include <limits>

#include "collision/simd/kernels/boxes-inl.h"
#include "collision/simd/kernels/triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// Enlargement of meshes, m: the rounding of their numbers and of points in their frames.
inline constexpr float kMeshPadding = 2e-5f;

/// Squared distance of a point (M) from the mesh's surface where it is at most `limit`, else
/// something greater. With `any` some triangle within the limit will do.
inline float SquaredToSurface(const TriangleTree& tree, const float* point, float limit, bool any) {
  const Lanes d;
  const int width = static_cast<int>(hn::Lanes(d));
  const Points p = Fill(point);
  struct Entry {
    float squared;
    std::int32_t child;
  };
  Entry stack[kWide * 8];  // 16^8 triangles
  int size = 0;
  stack[size++] = {0, 0};
  float best = std::numeric_limits<float>::max();
  float bound = limit;
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.squared > bound) continue;
    if (entry.child < 0) {
      const TriangleGroup& group = tree.triangles[static_cast<std::size_t>(~entry.child)];
      V least = SquaredToTriangles(group, 0, p);
      for (int first = width; first < kWide; first += width) {
        least = hn::Min(least, SquaredToTriangles(group, first, p));
      }
      const float squared = hn::GetLane(hn::MinOfLanes(d, least));
      if (squared > bound) continue;
      best = bound = squared;
      if (any) return best;
      continue;
    }
    const BoxGroup& group = tree.boxes[static_cast<std::size_t>(entry.child)];
    const int first_entry = size;
    for (int first = 0; first < kWide; first += width) {
      const V squared = SquaredToBoxes(group, first, p);
      alignas(64) float values[kWide];
      Store(squared, values);
      for (LaneMask near = Bits(hn::Le(squared, Fill(bound))); near != 0; near &= near - 1) {
        const int lane = std::countr_zero(near);
        // The nearest comes last, to be taken first.
        int at = size++;
        for (; at > first_entry && stack[at - 1].squared < values[lane]; --at) {
          stack[at] = stack[at - 1];
        }
        stack[at] = {values[lane], group.child[first + lane]};
      }
    }
  }
  return best;
}

/// Squared distance of a point (M) from a mesh, 0 inside; see SquaredToSurface.
inline float SquaredToMesh(const TriangleTree& tree, const float* point, float reach, bool any) {
  constexpr float kBeyond = std::numeric_limits<float>::max();
  const float limit = reach + kMeshPadding;
  const float squared = SquaredToSurface(tree, point, limit * limit, any);
  if (squared < kBeyond && any) return 0;
  // What touches it need not be told from what is inside.
  if (squared > kMeshPadding * kMeshPadding && Encloses(tree, point)) return 0;
  if (squared == kBeyond) return kBeyond;
  const float distance = std::sqrt(squared) - kMeshPadding;
  return distance > 0 ? distance * distance : 0;
}

/// Calls visit(lane, point in M) for the lanes of a mask until it returns false.
template <typename Visit>
HWY_INLINE void VisitInMesh(const WorldMesh& mesh, const Points& p_W, M lanes, Visit visit) {
  const Points p = p_W - Fill(mesh.position);
  alignas(64) float x[kBlock], y[kBlock], z[kBlock];
  Store(Dot(Fill(mesh.rotation), p), x);
  Store(Dot(Fill(mesh.rotation + 3), p), y);
  Store(Dot(Fill(mesh.rotation + 6), p), z);
  for (LaneMask open = Bits(lanes); open != 0; open &= open - 1) {
    const int lane = std::countr_zero(open);
    const float point[3] = {x[lane], y[lane], z[lane]};
    if (!visit(lane, point)) return;
  }
}

/// Whether what is in a solid comes within `reach` of the points in some of the lanes, which are
/// those in which the solid itself does.
HWY_INLINE bool MayBeNear(const SphereWorld& world, const Solid& solid, const Points& p, V reach,
                          M lanes) {
  if (HWY_LIKELY(solid.mesh < 0)) return true;
  const WorldMesh& mesh = world.meshes[static_cast<std::size_t>(solid.mesh)];
  alignas(64) float reaches[kBlock];
  Store(reach, reaches);
  bool near = false;
  VisitInMesh(mesh, p, lanes, [&](int lane, const float* point) {
    near = SquaredToMesh(*mesh.tree, point, reaches[lane], true) == 0;
    return !near;
  });
  return near;
}

/// Squared distance of points from the mesh in a solid, 0 inside, in the lanes given and where it
/// is at most `reach`; else something greater.
HWY_INLINE V SquaredMeshDistance(const SphereWorld& world, const Solid& solid, const Points& p,
                                 V reach, M lanes) {
  const WorldMesh& mesh = world.meshes[static_cast<std::size_t>(solid.mesh)];
  alignas(64) float reaches[kBlock];
  alignas(64) float squared[kBlock];
  Store(reach, reaches);
  Store(Fill(std::numeric_limits<float>::max()), squared);
  VisitInMesh(mesh, p, lanes, [&](int lane, const float* point) {
    squared[lane] = SquaredToMesh(*mesh.tree, point, reaches[lane], false);
    return true;
  });
  return Load(squared);
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
