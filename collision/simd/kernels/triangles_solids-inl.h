// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_TRIANGLES_SOLIDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_TRIANGLES_SOLIDS_INL_H_
#undef PLANBENCH_KERNELS_TRIANGLES_SOLIDS_INL_H_
#else
#define PLANBENCH_KERNELS_TRIANGLES_SOLIDS_INL_H_
#endif

#include <cmath>

#include "collision/simd/kernels/meshes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

// Triangles of the robot, one a lane, against solids. With a margin all that is nearer touches;
// of boxes and cylinders also some that is not, by up to sqrt(3) of the margin.

/// Of a box centred at the origin, along the axes: no plane along a face of the one or the other,
/// or along an edge of both, has a gap between them of more than the margin.
HWY_INLINE M MeetsBox(const Triangles& t, const float* half_size, float margin) {
  const auto& c = t.corner;
  const V half_x = Fill(half_size[0]);
  const V half_y = Fill(half_size[1]);
  const V half_z = Fill(half_size[2]);
  const V least_gap = Fill(margin);
  const V squared_gap = Fill(margin * margin);
  const auto along = [&](V a, V b, V d, V half) {
    const V low = hn::Min(a, hn::Min(b, d));
    const V high = hn::Max(a, hn::Max(b, d));
    return hn::Gt(hn::Max(low, hn::Neg(high)) - half, least_gap);
  };
  M apart =
      hn::Or(along(c[0].x, c[1].x, c[2].x, half_x),
             hn::Or(along(c[0].y, c[1].y, c[2].y, half_y), along(c[0].z, c[1].z, c[2].z, half_z)));
  if (hn::AllTrue(Lanes(), apart)) return hn::Not(apart);
  // Along an axis that is not a unit vector, of that squared length.
  const auto gap = [&](V beyond, V squared) {
    return hn::And(hn::Gt(beyond, Zero()), hn::Gt(beyond * beyond, squared_gap * squared));
  };
  const Points edges[3] = {c[1] - c[0], c[2] - c[1], c[0] - c[2]};
  {
    const Points n = Cross(edges[0], edges[1]);
    const Points size = Abs(n);
    const V reach = hn::MulAdd(size.x, half_x, hn::MulAdd(size.y, half_y, size.z * half_z));
    apart = hn::Or(apart, gap(hn::Abs(Dot(n, c[0])) - reach, SquaredNorm(n)));
  }
  for (int k = 0; k < 3; ++k) {
    // The ends of an edge have one place along an axis across it.
    const Points& e = edges[k];
    const Points size = Abs(e);
    const Points& p = c[k];
    const Points& other = c[(k + 2) % 3];
    const auto across = [&](V a, V b, V pa, V pb, V qa, V qb, V reach) {
      const V at_p = hn::MulSub(a, pb, b * pa);
      const V at_q = hn::MulSub(a, qb, b * qa);
      const V beyond = hn::Max(hn::Min(at_p, at_q), hn::Neg(hn::Max(at_p, at_q))) - reach;
      return gap(beyond, hn::MulAdd(a, a, b * b));
    };
    apart = hn::Or(apart, across(e.y, e.z, p.y, p.z, other.y, other.z,
                                 hn::MulAdd(half_y, size.z, half_z * size.y)));
    apart = hn::Or(apart, across(e.z, e.x, p.z, p.x, other.z, other.x,
                                 hn::MulAdd(half_z, size.x, half_x * size.z)));
    apart = hn::Or(apart, across(e.x, e.y, p.x, p.y, other.x, other.y,
                                 hn::MulAdd(half_x, size.y, half_y * size.x)));
  }
  return hn::Not(apart);
}

/// Of an upright cylinder about the origin: what of a triangle is between its ends comes, seen
/// along the axis, as near to it as the radius. Its outline there is parts of edges, and where the
/// planes of the ends cut it.
HWY_INLINE M MeetsCylinder(const Triangles& t, float radius, float half_length) {
  const auto& c = t.corner;
  const V low = Fill(-half_length);
  const V high = Fill(half_length);
  const V zero = Zero();
  const V one = Fill(1.0f);
  const V reach = Fill(radius * radius);
  const M between = hn::And(hn::Le(hn::Min(c[0].z, hn::Min(c[1].z, c[2].z)), high),
                            hn::Ge(hn::Max(c[0].z, hn::Max(c[1].z, c[2].z)), low));
  if (None(between)) return between;
  const auto squared = [&](V x, V y, V dx, V dy, V from, V to) {
    const V length = hn::Max(hn::MulAdd(dx, dx, dy * dy), Fill(1e-24f));
    const V s = hn::Neg(hn::MulAdd(x, dx, y * dy)) / length;
    const V at = hn::Min(hn::Max(s, from), to);
    x = hn::MulAdd(at, dx, x);
    y = hn::MulAdd(at, dy, y);
    return hn::MulAdd(x, x, y * y);
  };
  M meets = hn::FirstN(Lanes(), 0);
  struct Cut {
    V x, y;
    M there;
  };
  Cut cuts[2][3];
  for (int k = 0; k < 3; ++k) {
    const Points& a = c[k];
    const Points v = c[(k + 1) % 3] - a;
    const V steep = hn::IfThenElse(hn::Lt(hn::Abs(v.z), Fill(1e-12f)), Fill(1e-12f), v.z);
    const V at_low = (low - a.z) / steep;
    const V at_high = (high - a.z) / steep;
    const V from = hn::Max(hn::Min(at_low, at_high), zero);
    const V to = hn::Min(hn::Max(at_low, at_high), one);
    meets = hn::Or(meets,
                   hn::And(hn::Le(from, to), hn::Le(squared(a.x, a.y, v.x, v.y, from, to), reach)));
    const V rounding = Fill(1e-5f);
    const auto cut = [&](V s) {
      const V within = hn::Min(Positive(s), one);
      return Cut{hn::MulAdd(within, v.x, a.x), hn::MulAdd(within, v.y, a.y),
                 hn::Le(hn::Abs(s - within), rounding)};
    };
    cuts[0][k] = cut(at_low);
    cuts[1][k] = cut(at_high);
  }
  for (const auto& end : cuts) {
    for (int k = 0; k < 3; ++k) {
      const Cut& a = end[k];
      const Cut& b = end[(k + 1) % 3];
      const V distance = squared(a.x, a.y, b.x - a.x, b.y - a.y, zero, one);
      meets = hn::Or(meets, hn::And(hn::And(a.there, b.there), hn::Le(distance, reach)));
    }
  }
  // Where the axis goes through the triangle.
  const auto wedge = [](const Points& a, const Points& b) {
    return hn::MulSub(a.x, b.y, a.y * b.x);
  };
  const V w0 = wedge(c[1], c[2]);
  const V w1 = wedge(c[2], c[0]);
  const V w2 = wedge(c[0], c[1]);
  const M same_side = hn::Or(hn::Ge(hn::Min(w0, hn::Min(w1, w2)), zero),
                             hn::Le(hn::Max(w0, hn::Max(w1, w2)), zero));
  const V height = hn::MulAdd(w0, c[0].z, hn::MulAdd(w1, c[1].z, w2 * c[2].z));
  const M at_height = hn::Le(hn::Abs(height), high * hn::Abs(w0 + w1 + w2));
  return hn::And(between, hn::Or(meets, hn::And(same_side, at_height)));
}

/// Of a segment: squared distances.
HWY_INLINE V SquaredToSegment(const TriangleGroup& group, int first, const Points& a,
                              const Points& b) {
  const InFrame frame = LoadInFrame(group, first);
  const Points a_T = ToFrames(group, first, a);
  const Points b_T = ToFrames(group, first, b);
  V least = hn::Min(hn::Min(SquaredInFrame(frame, a_T), SquaredInFrame(frame, b_T)),
                    SquaredBetweenEdges(frame, a_T, b_T));
  const Points v = b - a;
  const V scale = Fill(1.0f) / hn::Max(SquaredNorm(v), Fill(1e-24f));
  for (const Points& corner : LoadCorners(group, first).corner) {
    const Points p = corner - a;
    const V s = hn::Min(Positive(Dot(p, v) * scale), Fill(1.0f));
    least = hn::Min(least, SquaredNorm(NegMulAdd(s, v, p)));
  }
  return least;
}

/// Rows of a rotation that takes `axis` (unit) to z.
inline void RotationToZ(const float* axis, float* rows) {
  // Across the axis' smallest component.
  int k = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(axis[i]) < std::abs(axis[k])) k = i;
  }
  const int i = (k + 1) % 3;
  const int j = (k + 2) % 3;
  const float length = std::sqrt(axis[i] * axis[i] + axis[j] * axis[j]);
  float* x = rows;
  x[k] = 0;
  x[i] = axis[j] / length;
  x[j] = -axis[i] / length;
  float* y = rows + 3;
  for (int m = 0; m < 3; ++m) {
    y[m] = axis[(m + 1) % 3] * x[(m + 2) % 3] - axis[(m + 2) % 3] * x[(m + 1) % 3];
    rows[6 + m] = axis[m];
  }
}

/// Whether triangles of the robot come within `margin` of a mesh.
inline bool MeetsMesh(const BoxedGroup& group, const Transform& X_WC, const WorldMesh& mesh,
                      float margin) {
  constexpr int kMostOpen = kWide * 8;
  const TriangleTree& tree = *mesh.tree;
  const int width = static_cast<int>(hn::Lanes(Lanes()));
  const Transform X_MC = FromFrame(mesh.rotation, mesh.position, X_WC);
  const Transform X_CM = X_MC.Inverse();
  // The group's box in M, along the axes there.
  float center[3];
  X_MC.Times(group.box.center, center);
  float reach[3];
  for (int row = 0; row < 3; ++row) {
    reach[row] = margin;
    for (int c = 0; c < 3; ++c) {
      reach[row] += std::abs(X_MC.rotation[3 * row + c]) * group.box.half_size[c];
    }
  }
  std::int32_t open[kMostOpen];
  int size = 0;
  open[size++] = 0;
  while (size > 0) {
    const std::int32_t child = open[--size];
    if (child < 0) {
      const TriangleGroup& other = tree.triangles[static_cast<std::size_t>(~child)];
      if (GroupsMeet(group, other, nullptr, X_CM, margin)) return true;
      continue;
    }
    const BoxGroup& boxes = tree.boxes[static_cast<std::size_t>(child)];
    for (int first = 0; first < kWide; first += width) {
      const auto along = [&](int axis) {
        return hn::And(hn::Le(Load(boxes.low[axis] + first), Fill(center[axis] + reach[axis])),
                       hn::Ge(Load(boxes.high[axis] + first), Fill(center[axis] - reach[axis])));
      };
      for (LaneMask near = Bits(hn::And(along(0), hn::And(along(1), along(2)))); near != 0;
           near &= near - 1) {
        open[size++] = boxes.child[first + std::countr_zero(near)];
      }
    }
  }
  const auto& first_corner = group.triangles.corner[0];
  const float corner_C[3] = {first_corner[0][0], first_corner[1][0], first_corner[2][0]};
  float corner[3];
  X_MC.Times(corner_C, corner);
  return Encloses(tree, corner);
}

/// Whether triangles of the robot come within `margin` of a solid. X_WC: of their body.
inline bool MeetsSolid(const BoxedGroup& boxed, const Transform& X_WC, const SphereWorld& world,
                       const Solid& solid, float margin) {
  if (solid.mesh >= 0) {
    return MeetsMesh(boxed, X_WC, world.meshes[static_cast<std::size_t>(solid.mesh)], margin);
  }
  const TriangleGroup& group = boxed.triangles;
  const int width = static_cast<int>(hn::Lanes(Lanes()));
  const float* v = solid.v;
  const auto any = [&](auto meets) {
    for (int first = 0; first < kWide; first += width) {
      if (!None(meets(first))) return true;
    }
    return false;
  };
  const auto meets_box = [&](const float* R_OW, const float* half_size) {
    const Transform X_OC = FromFrame(R_OW, solid.center, X_WC);
    return any(
        [&](int first) { return MeetsBox(CornersIn(X_OC, group, first), half_size, margin); });
  };
  const auto meets_cylinder = [&](const float* R_OW, float radius, float half_length) {
    const Transform X_OC = FromFrame(R_OW, solid.center, X_WC);
    return any([&](int first) {
      return MeetsCylinder(CornersIn(X_OC, group, first), radius + margin, half_length + margin);
    });
  };
  switch (solid.kind) {
    case Kind::kUprightBox: {
      const float R_OW[9] = {v[0], v[1], 0, -v[1], v[0], 0, 0, 0, 1};
      return meets_box(R_OW, v + 2);
    }
    case Kind::kBox:
      return meets_box(v, v + 9);
    case Kind::kUprightCylinder: {
      const float R_OW[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
      return meets_cylinder(R_OW, v[0], v[1]);
    }
    case Kind::kCylinder: {
      float R_OW[9];
      RotationToZ(v, R_OW);
      return meets_cylinder(R_OW, v[3], v[4]);
    }
    case Kind::kSphere: {
      float center[3];
      X_WC.InverseTimes(solid.center, center);
      return TrianglesWithin(group, center, v[0] + margin) != 0;
    }
    case Kind::kCapsule: {
      float ends[2][3];
      for (int k = 0; k < 2; ++k) {
        const float along = k == 0 ? -v[4] : v[4];
        const float end[3] = {solid.center[0] + along * v[0], solid.center[1] + along * v[1],
                              solid.center[2] + along * v[2]};
        X_WC.InverseTimes(end, ends[k]);
      }
      const Points a = Fill(ends[0]);
      const Points b = Fill(ends[1]);
      const V reach = Fill((v[3] + margin) * (v[3] + margin));
      return any([&](int first) { return hn::Le(SquaredToSegment(group, first, a, b), reach); });
    }
    case Kind::kHalfSpace: {
      float normal[3];
      for (int k = 0; k < 3; ++k) {
        normal[k] =
            v[0] * X_WC.rotation[k] + v[1] * X_WC.rotation[3 + k] + v[2] * X_WC.rotation[6 + k];
      }
      float height = 0;
      for (int k = 0; k < 3; ++k) height += v[k] * (X_WC.translation[k] - solid.center[k]);
      const Points n = Fill(normal);
      const V depth = Fill(margin - height);
      return any([&](int first) {
        const Triangles t = LoadCorners(group, first);
        return hn::Le(
            hn::Min(Dot(n, t.corner[0]), hn::Min(Dot(n, t.corner[1]), Dot(n, t.corner[2]))), depth);
      });
    }
    case Kind::kCone:
      break;  // doubtful: see CompiledWorld
  }
  return true;
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
