// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_TRIANGLES_SOLIDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_TRIANGLES_SOLIDS_INL_H_
#undef PLANBENCH_KERNELS_TRIANGLES_SOLIDS_INL_H_
#else
#define PLANBENCH_KERNELS_TRIANGLES_SOLIDS_INL_H_
#endif

#include <cmath>

#include "collision/simd/kernels/triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

// Triangles of what moves, one a lane, against solids. With a margin all that is nearer touches;
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
    // Of a triangle that is but a line the normal is rounding, and its corners differ along it.
    const V at[3] = {Dot(n, c[0]), Dot(n, c[1]), Dot(n, c[2])};
    const V beyond = hn::Max(hn::Min(at[0], hn::Min(at[1], at[2])),
                             hn::Neg(hn::Max(at[0], hn::Max(at[1], at[2]))));
    apart = hn::Or(apart, gap(beyond - reach, SquaredNorm(n)));
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
  // Where the edges cross its ends.
  V x[2][3], y[2][3];
  M there[2][3];
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
    const V crossings[2] = {at_low, at_high};
    for (int end = 0; end < 2; ++end) {
      const V within = hn::Min(Positive(crossings[end]), one);
      x[end][k] = hn::MulAdd(within, v.x, a.x);
      y[end][k] = hn::MulAdd(within, v.y, a.y);
      there[end][k] = hn::Le(hn::Abs(crossings[end] - within), rounding);
    }
  }
  for (int end = 0; end < 2; ++end) {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const V distance = squared(x[end][k], y[end][k], x[end][next] - x[end][k],
                                 y[end][next] - y[end][k], zero, one);
      const M both = hn::And(there[end][k], there[end][next]);
      meets = hn::Or(meets, hn::And(both, hn::Le(distance, reach)));
    }
  }
  // Where the axis goes through the triangle; if that is seen edge-on, its edges pass as near.
  const auto wedge = [](const Points& a, const Points& b) {
    return hn::MulSub(a.x, b.y, a.y * b.x);
  };
  const V w0 = wedge(c[1], c[2]);
  const V w1 = wedge(c[2], c[0]);
  const V w2 = wedge(c[0], c[1]);
  const M same_side = hn::Or(hn::Ge(hn::Min(w0, hn::Min(w1, w2)), zero),
                             hn::Le(hn::Max(w0, hn::Max(w1, w2)), zero));
  const auto from_axis = [](const Points& p) { return hn::MulAdd(p.x, p.x, p.y * p.y); };
  const V farthest = hn::Max(from_axis(c[0]), hn::Max(from_axis(c[1]), from_axis(c[2])));
  const V area = hn::Abs(w0 + w1 + w2);
  const V height = hn::MulAdd(w0, c[0].z, hn::MulAdd(w1, c[1].z, w2 * c[2].z));
  const M at_height =
      hn::And(hn::Gt(area, farthest * Fill(1e-5f)), hn::Le(hn::Abs(height), high * area));
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

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
