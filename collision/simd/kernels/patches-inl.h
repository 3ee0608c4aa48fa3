// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_PATCHES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_PATCHES_INL_H_
#undef PLANBENCH_KERNELS_PATCHES_INL_H_
#else
#define PLANBENCH_KERNELS_PATCHES_INL_H_
#endif

#include <bit>
#include <cmath>

#include "collision/simd/kernels/boxes-inl.h"
#include "collision/simd/kernels/hulls-inl.h"
#include "collision/simd/kernels/meshes-inl.h"
#include "collision/simd/kernels/triangles_solids-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

// Patches of the robot's surface in one configuration. With a margin all that is nearer touches,
// and some that is not, see triangles_solids-inl.h.

/// A patch, in its body's frame C.
struct PatchView {
  const Patch& patch;
  const NodeHull& hull;
  const SphereRobot& robot;

  const TriangleGroup& triangles(int i) const { return robot.triangles[patch.boxes.child[i]]; }
  BoxedGroup group(int i) const { return {triangles(i), BoxOf(patch.boxes, i)}; }
};

/// A point of A less one of B, in A.
HWY_INLINE void Difference(const float* point_A, const float* point_B, const Transform& X_AB,
                           float* difference) {
  X_AB.Times(point_B, difference);
  for (int k = 0; k < 3; ++k) difference[k] = point_A[k] - difference[k];
}

/// Of two hulls: see GapBetween, `direction` being in A.
inline float HullGap(const SphereRobot& robot, const NodeHull& a, const NodeHull& b,
                     const Transform& X_AB, float margin, float* direction) {
  const auto gap = [&](const float* v, float* w, auto suffices) {
    float v_B[3];
    for (int k = 0; k < 3; ++k) {
      v_B[k] =
          -(X_AB.rotation[k] * v[0] + X_AB.rotation[3 + k] * v[1] + X_AB.rotation[6 + k] * v[2]);
    }
    const Extreme in_a(robot.points + a.first, a.num, v);
    const Extreme in_b(robot.points + b.first, b.num, v_B);
    if (suffices(in_a.value() + in_b.value() - Dot(v, X_AB.translation))) return true;
    float point_A[3], point_B[3];
    in_a.Find(point_A);
    in_b.Find(point_B);
    Difference(point_A, point_B, X_AB, w);
    return false;
  };
  return GapBetween(direction, margin, gap);
}

/// Calls visit(index) of each bit until it returns true; whether it did.
template <typename Visit>
HWY_INLINE bool AnyOf(LaneMask bits, Visit visit) {
  for (; bits != 0; bits &= bits - 1) {
    if (visit(std::countr_zero(bits))) return true;
  }
  return false;
}

/// Whether triangles of two patches come within `margin` of each other.
inline bool PatchesMeet(const PatchView& a, const PatchView& b, const Transform& X_AB,
                        float margin) {
  const LaneMask near_a = BoxesNear(a.patch.boxes, b.patch.box, X_AB, margin);
  if (near_a == 0) return false;
  const LaneMask near_b = BoxesNear(b.patch.boxes, a.patch.box, X_AB.Inverse(), margin);
  return AnyOf(near_b, [&](int j) {
    const BoxedGroup other = b.group(j);
    return AnyOf(near_a & BoxesNear(a.patch.boxes, other.box, X_AB, margin), [&](int i) {
      const BoxedGroup group = a.group(i);
      const NodeHull& hull_a = a.patch.hulls[i];
      const NodeHull& hull_b = b.patch.hulls[j];
      const float wide = margin + hull_a.slack + hull_b.slack;
      float direction[3];
      Difference(group.box.center, other.box.center, X_AB, direction);
      return !(HullGap(a.robot, hull_a, hull_b, X_AB, wide, direction) > wide) &&
             GroupsMeet(group, other.triangles, &other.box, X_AB, margin);
    });
  });
}

/// Whether triangles of a patch come within `reach` of a point (C).
inline bool PatchWithin(const PatchView& view, const float* point, float reach) {
  return AnyOf(BoxesWithin(view.patch.boxes, point, reach),
               [&](int i) { return TrianglesWithin(view.triangles(i), point, reach) != 0; });
}

/// Whether a patch comes within `margin` of a mesh, or is inside.
inline bool PatchMeetsMesh(const PatchView& view, const Transform& X_WC, const WorldMesh& mesh,
                           float margin) {
  constexpr int kMostOpen = kWide * 8;
  const TriangleTree& tree = *mesh.tree;
  const Transform X_MC = FromFrame(mesh.rotation, mesh.position, X_WC);
  const Transform X_CM = X_MC.Inverse();
  std::int32_t open[kMostOpen];
  int size = 0;
  open[size++] = 0;
  while (size > 0) {
    const BoxGroup& boxes = tree.boxes[static_cast<std::size_t>(open[--size])];
    if (AnyOf(BoxesNear(boxes, view.patch.box, X_MC, margin), [&](int k) {
          const std::int32_t child = boxes.child[k];
          if (child >= 0) {
            open[size++] = child;
            return false;
          }
          const TriangleGroup& other = tree.triangles[static_cast<std::size_t>(~child)];
          return AnyOf(BoxesNear(view.patch.boxes, BoxOf(boxes, k), X_CM, margin), [&](int i) {
            return GroupsMeet(view.group(i), other, nullptr, X_CM, margin);
          });
        })) {
      return true;
    }
  }
  for (const auto& point : view.patch.points) {
    float p_M[3];
    X_MC.Times(point.data(), p_M);
    if (Encloses(tree, p_M)) return true;
  }
  return false;
}

/// A box around a solid that is no half-space, in a frame O in its middle: R_OW row-major, m. The
/// axes of round solids are O's z.
struct SolidFrame {
  float rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  float half_size[3];
};

inline SolidFrame FrameOf(const Solid& solid) {
  SolidFrame frame;
  const float* v = solid.v;
  const auto set_half_size = [&](float x, float y, float z) {
    frame.half_size[0] = x;
    frame.half_size[1] = y;
    frame.half_size[2] = z;
  };
  switch (solid.kind) {
    case Kind::kUprightBox:
      frame.rotation[0] = frame.rotation[4] = v[0];
      frame.rotation[1] = v[1];
      frame.rotation[3] = -v[1];
      set_half_size(v[2], v[3], v[4]);
      break;
    case Kind::kBox:
      std::copy_n(v, 9, frame.rotation);
      set_half_size(v[9], v[10], v[11]);
      break;
    case Kind::kUprightCylinder:
      set_half_size(v[0], v[0], v[1]);
      break;
    case Kind::kCylinder:
      RotationToZ(v, frame.rotation);
      set_half_size(v[3], v[3], v[4]);
      break;
    case Kind::kCapsule:
      RotationToZ(v, frame.rotation);
      set_half_size(v[3], v[3], v[3] + v[4]);
      break;
    case Kind::kSphere:
      set_half_size(v[0], v[0], v[0]);
      break;
    case Kind::kCone:
    case Kind::kHalfSpace:
      break;
  }
  return frame;
}

/// Whether triangles of a patch come within `margin` of a solid. X_WC: of their body.
inline bool PatchMeetsSolid(const PatchView& view, const Transform& X_WC, const SphereWorld& world,
                            const Solid& solid, float margin) {
  if (solid.mesh >= 0) {
    return PatchMeetsMesh(view, X_WC, world.meshes[static_cast<std::size_t>(solid.mesh)], margin);
  }
  const int width = static_cast<int>(hn::Lanes(Lanes()));
  const auto any = [&](LaneMask groups, auto meets) {
    return AnyOf(groups, [&](int i) {
      const TriangleGroup& group = view.triangles(i);
      for (int first = 0; first < kWide; first += width) {
        if (!None(meets(group, first))) return true;
      }
      return false;
    });
  };
  const float* v = solid.v;
  if (solid.kind == Kind::kHalfSpace) {
    float normal[3];
    for (int k = 0; k < 3; ++k) {
      normal[k] =
          v[0] * X_WC.rotation[k] + v[1] * X_WC.rotation[3 + k] + v[2] * X_WC.rotation[6 + k];
    }
    float height = 0;
    for (int k = 0; k < 3; ++k) height += v[k] * (X_WC.translation[k] - solid.center[k]);
    const Points n = Fill(normal);
    const V depth = Fill(margin - height);
    return any((LaneMask{1} << view.patch.num_groups) - 1, [&](const TriangleGroup& group,
                                                               int first) {
      const Triangles t = LoadCorners(group, first);
      return hn::Le(hn::Min(Dot(n, t.corner[0]), hn::Min(Dot(n, t.corner[1]), Dot(n, t.corner[2]))),
                    depth);
    });
  }

  const SolidFrame frame = FrameOf(solid);
  const Transform X_OC = FromFrame(frame.rotation, solid.center, X_WC);
  const Transform X_CO = X_OC.Inverse();
  CenteredBox box = {};
  std::copy_n(frame.half_size, 3, box.half_size);
  const LaneMask near = BoxesNear(view.patch.boxes, box, X_CO, margin);
  switch (solid.kind) {
    case Kind::kUprightBox:
    case Kind::kBox:
      return any(near, [&](const TriangleGroup& group, int first) {
        return MeetsBox(CornersIn(X_OC, group, first), frame.half_size, margin);
      });
    case Kind::kUprightCylinder:
    case Kind::kCylinder:
      return any(near, [&](const TriangleGroup& group, int first) {
        return MeetsCylinder(CornersIn(X_OC, group, first), frame.half_size[0] + margin,
                             frame.half_size[2] + margin);
      });
    case Kind::kSphere:
      return AnyOf(near, [&](int i) {
        return TrianglesWithin(view.triangles(i), X_CO.translation, v[0] + margin) != 0;
      });
    case Kind::kCapsule: {
      Points ends[2];
      for (int k = 0; k < 2; ++k) {
        const float end_O[3] = {0, 0, k == 0 ? -v[4] : v[4]};
        float end[3];
        X_CO.Times(end_O, end);
        ends[k] = Fill(end);
      }
      const V reach = Fill((v[3] + margin) * (v[3] + margin));
      return any(near, [&](const TriangleGroup& group, int first) {
        return hn::Le(SquaredToSegment(group, first, ends[0], ends[1]), reach);
      });
    }
    case Kind::kCone:
    case Kind::kHalfSpace:
      break;  // cones are doubtful: see CompiledWorld
  }
  return true;
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
