// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_TRIANGLES_INL_H_
#undef PLANBENCH_KERNELS_TRIANGLES_INL_H_
#else
#define PLANBENCH_KERNELS_TRIANGLES_INL_H_
#endif

#include <bit>
#include <limits>

#include "collision/simd/kernels/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

// Distances of triangles from points, segments and each other, a triangle a lane. In the frame T of
// a triangle (see TriangleGroup) the height over its plane and the distance within the plane stand
// for themselves: the latter is 0 or that from the nearest edge.

/// Triangles in their frames.
struct InFrame {
  V length[3];
  V apex[2];
  V along[2][2];
};

HWY_INLINE InFrame LoadInFrame(const TriangleGroup& group, int first) {
  const auto load = [first](const float* lanes) { return Load(lanes + first); };
  return {{load(group.length[0]), load(group.length[1]), load(group.length[2])},
          {load(group.apex[0]), load(group.apex[1])},
          {{load(group.along[0][0]), load(group.along[0][1])},
           {load(group.along[1][0]), load(group.along[1][1])}}};
}

/// One triangle in all lanes.
HWY_INLINE InFrame FillInFrame(const TriangleGroup& group, int i) {
  const auto fill = [i](const float* lanes) { return Fill(lanes[i]); };
  return {{fill(group.length[0]), fill(group.length[1]), fill(group.length[2])},
          {fill(group.apex[0]), fill(group.apex[1])},
          {{fill(group.along[0][0]), fill(group.along[0][1])},
           {fill(group.along[1][0]), fill(group.along[1][1])}}};
}

/// Points of the group's frame in those of its triangles.
HWY_INLINE Points ToFrames(const TriangleGroup& group, int first, const Points& p) {
  const auto row = [&](int axis) {
    return hn::MulAdd(Load(group.rotation[3 * axis] + first), p.x,
                      hn::MulAdd(Load(group.rotation[3 * axis + 1] + first), p.y,
                                 hn::MulAdd(Load(group.rotation[3 * axis + 2] + first), p.z,
                                            Load(group.position[axis] + first))));
  };
  return {row(0), row(1), row(2)};
}

/// The pose X_TM of one of the frames.
inline Transform FrameOf(const TriangleGroup& group, int i) {
  Transform X;
  for (int k = 0; k < 9; ++k) X.rotation[k] = group.rotation[k][i];
  for (int k = 0; k < 3; ++k) X.translation[k] = group.position[k][i];
  return X;
}

/// Squared distances of points, given in the frames of the triangles.
HWY_INLINE V SquaredInFrame(const InFrame& t, const Points& p) {
  // What is left of all three edges, and over the longest: where a triangle is so thin that the
  // sides of its edges are lost to rounding, that is still right within its width.
  M inside = hn::And(hn::Gt(p.y, Zero()), hn::And(hn::Gt(p.x, Zero()), hn::Lt(p.x, t.length[0])));
  const V beyond = p.x - hn::Min(Positive(p.x), t.length[0]);
  V least = hn::MulAdd(p.y, p.y, beyond * beyond);
  V from_x = p.x - t.length[0];
  V from_y = p.y;
  for (int edge = 0; edge < 2; ++edge) {
    const V along_x = t.along[edge][0];
    const V along_y = t.along[edge][1];
    const V s = hn::MulAdd(along_x, from_x, along_y * from_y);
    const V side = hn::NegMulAdd(along_y, from_x, along_x * from_y);
    const V off = s - hn::Min(Positive(s), t.length[edge + 1]);
    least = hn::Min(least, hn::MulAdd(side, side, off * off));
    inside = hn::And(inside, hn::Gt(side, Zero()));
    from_x = p.x - t.apex[0];
    from_y = p.y - t.apex[1];
  }
  return hn::MulAdd(p.z, p.z, hn::IfThenZeroElse(inside, least));
}

/// Squared distances of a point from triangles.
HWY_INLINE V SquaredToTriangles(const TriangleGroup& group, int first, const Points& p) {
  return SquaredInFrame(LoadInFrame(group, first), ToFrames(group, first, p));
}

/// Squared distances of segments from triangles as far as they are not those of an end of the one
/// or a corner of the other: through the face, or between edges. Else something not less than that.
HWY_INLINE V SquaredBetweenEdges(const InFrame& t, const Points& a, const Points& b) {
  const Points v = b - a;
  V least = Fill(std::numeric_limits<float>::max());
  {  // Where it goes through the plane.
    const M through = hn::Xor(hn::Lt(a.z, Zero()), hn::Lt(b.z, Zero()));
    const V s = hn::IfThenElseZero(through, a.z / (a.z - b.z));
    const V x = hn::MulAdd(s, v.x, a.x);
    const V y = hn::MulAdd(s, v.y, a.y);
    const V side_1 = hn::NegMulAdd(t.along[0][1], x - t.length[0], t.along[0][0] * y);
    const V side_2 = hn::NegMulAdd(t.along[1][1], x - t.apex[0], t.along[1][0] * (y - t.apex[1]));
    // A triangle that is but a line has no sides, and is all there is on it.
    const M beside = hn::And(hn::And(hn::Ge(x, Zero()), hn::Le(x, t.length[0])),
                             hn::And(hn::Ge(y, Zero()), hn::Le(y, t.apex[1])));
    const M inside = hn::And(beside, hn::And(hn::Ge(side_1, Zero()), hn::Ge(side_2, Zero())));
    least = hn::IfThenZeroElse(hn::And(through, inside), least);
  }
  // Of lines closer to parallel than this ends are as near as anything, up to 3e-6 of a length.
  const V parallel = SquaredNorm(v) * Fill(1e-11f);
  const V zero = Zero();
  for (int edge = 0; edge < 3; ++edge) {
    const V ux = edge == 0 ? Fill(1.0f) : t.along[edge == 0 ? 0 : edge - 1][0];
    const V uy = edge == 0 ? zero : t.along[edge == 0 ? 0 : edge - 1][1];
    const V ox = edge == 0 ? zero : edge == 1 ? t.length[0] : t.apex[0];
    const V oy = edge == 2 ? t.apex[1] : zero;
    const Points u = {ux, uy, zero};
    const Points w = {a.x - ox, a.y - oy, a.z};
    const Points n = Cross(u, v);
    const V nn = SquaredNorm(n);
    const V s = Dot(Cross(w, v), n);  // of the edge, times nn
    const V r = Dot(Cross(w, u), n);  // of the segment, likewise
    const M inner = hn::And(
        hn::And(hn::Gt(nn, parallel), hn::And(hn::Ge(s, zero), hn::Le(s, t.length[edge] * nn))),
        hn::And(hn::Ge(r, zero), hn::Le(r, nn)));
    const V apart = Dot(w, n);
    least = hn::IfThenElse(inner, hn::Min(least, apart * apart / nn), least);
  }
  return least;
}

/// Corners of triangles in a frame A.
struct Triangles {
  Triangles() = default;  // see Points
  Points corner[3];
};

HWY_INLINE Triangles LoadCorners(const TriangleGroup& group, int first) {
  Triangles t;
  for (int k = 0; k < 3; ++k) {
    t.corner[k] = {Load(group.corner[k][0] + first), Load(group.corner[k][1] + first),
                   Load(group.corner[k][2] + first)};
  }
  return t;
}

HWY_INLINE Triangles CornersIn(const Transform& X_AM, const TriangleGroup& group, int first) {
  Triangles t = LoadCorners(group, first);
  for (Points& corner : t.corner) corner = X_AM * corner;
  return t;
}

/// Whether a box along the axes of triangles' frames around three points, given there, comes within
/// `margin` of such a box around the triangles.
HWY_INLINE M BoxesMeet(const InFrame& t, const Points* p, float margin) {
  const auto along = [&](V a, V b, V c, V length) {
    const V low = hn::Min(a, hn::Min(b, c));
    const V high = hn::Max(a, hn::Max(b, c));
    return hn::Le(hn::Max(low - length, hn::Neg(high)), Fill(margin));
  };
  // The apex is over the longest edge, which lies along x.
  return hn::And(along(p[0].z, p[1].z, p[2].z, Zero()),
                 hn::And(along(p[0].x, p[1].x, p[2].x, t.length[0]),
                         along(p[0].y, p[1].y, p[2].y, t.apex[1])));
}

/// Which triangles of a group are within `reach` of a point, by bit.
inline LaneMask TrianglesWithin(const TriangleGroup& group, const float* point, float reach) {
  const int width = static_cast<int>(hn::Lanes(Lanes()));
  const Points p = Fill(point);
  LaneMask near = 0;
  for (int first = 0; first < kWide; first += width) {
    near |= Bits(hn::Le(SquaredToTriangles(group, first, p), Fill(reach * reach))) << first;
  }
  return near & ((LaneMask{1} << group.count) - 1);
}

/// Whether a triangle of group B is within `margin` of one of those of A. `corners_B` are those of
/// A, a vector after another, in B's frame.
inline bool MeetsTriangle(const TriangleGroup& a, const Triangles* corners_B,
                          const TriangleGroup& b, int i, const Transform& X_AB, float margin) {
  const int width = static_cast<int>(hn::Lanes(Lanes()));
  const V reach = Fill(margin * margin);
  float corner[3][3];
  for (int k = 0; k < 3; ++k) {
    const float p_B[3] = {b.corner[k][0][i], b.corner[k][1][i], b.corner[k][2][i]};
    X_AB.Times(p_B, corner[k]);
  }
  const InFrame b_frame = FillInFrame(b, i);
  const Transform X_TB = FrameOf(b, i);
  for (int first = 0; first < kWide; first += width) {
    const InFrame a_frame = LoadInFrame(a, first);
    Points p[3];
    for (int k = 0; k < 3; ++k) p[k] = ToFrames(a, first, Fill(corner[k]));
    // Most are on one side of the plane, or beside it.
    const M open = BoxesMeet(a_frame, p, margin);
    if (None(open)) continue;
    Points t[3];
    for (int k = 0; k < 3; ++k) t[k] = X_TB * corners_B[first / width].corner[k];
    if (None(hn::And(open, BoxesMeet(b_frame, t, margin)))) continue;
    V least = Fill(std::numeric_limits<float>::max());
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      least = hn::Min(least, SquaredInFrame(a_frame, p[k]));
      least = hn::Min(least, SquaredInFrame(b_frame, t[k]));
      least = hn::Min(least, SquaredBetweenEdges(a_frame, p[k], p[next]));
      least = hn::Min(least, SquaredBetweenEdges(b_frame, t[k], t[next]));
    }
    if (!None(hn::Le(least, reach))) return true;
  }
  return false;
}

/// Which triangles of a group come, by their bounding boxes, within `margin` of a box, by bit; all
/// in the frame of the corners, a vector after another.
inline LaneMask TrianglesNear(const Triangles* corners, int count, const CenteredBox& box,
                              float margin) {
  const int width = static_cast<int>(hn::Lanes(Lanes()));
  LaneMask near = 0;
  for (int first = 0; first < kWide; first += width) {
    const Points* c = corners[first / width].corner;
    const auto along = [&](V a, V b, V d, int axis) {
      const float reach = box.half_size[axis] + margin;
      return hn::And(hn::Le(hn::Min(a, hn::Min(b, d)), Fill(box.center[axis] + reach)),
                     hn::Ge(hn::Max(a, hn::Max(b, d)), Fill(box.center[axis] - reach)));
    };
    near |=
        Bits(hn::And(along(c[0].x, c[1].x, c[2].x, 0),
                     hn::And(along(c[0].y, c[1].y, c[2].y, 1), along(c[0].z, c[1].z, c[2].z, 2))))
        << first;
  }
  return near & ((LaneMask{1} << count) - 1);
}

/// A group of triangles and a box around it, in the frame of the triangles.
struct BoxedGroup {
  const TriangleGroup& triangles;
  CenteredBox box;
};

/// Whether triangles of A come within `margin` of those of B, around which no box needs to be
/// known.
inline bool GroupsMeet(const BoxedGroup& a, const TriangleGroup& b, const CenteredBox* box_b,
                       const Transform& X_AB, float margin) {
  const int width = static_cast<int>(hn::Lanes(Lanes()));
  Triangles corners[kWide];
  for (int first = 0; first < kWide; first += width) {
    corners[first / width] = CornersIn(X_AB, b, first);
  }
  LaneMask near_b = TrianglesNear(corners, b.count, a.box, margin);
  if (near_b == 0) return false;
  const Transform X_BA = X_AB.Inverse();
  Triangles corners_B[kWide];
  for (int first = 0; first < kWide; first += width) {
    corners_B[first / width] = CornersIn(X_BA, a.triangles, first);
  }
  if (box_b != nullptr) {
    LaneMask near_a = TrianglesNear(corners_B, a.triangles.count, *box_b, margin);
    if (std::popcount(near_a) < std::popcount(near_b)) {
      for (; near_a != 0; near_a &= near_a - 1) {
        const int i = std::countr_zero(near_a);
        if (MeetsTriangle(b, corners, a.triangles, i, X_BA, margin)) return true;
      }
      return false;
    }
  }
  for (; near_b != 0; near_b &= near_b - 1) {
    if (MeetsTriangle(a.triangles, corners_B, b, std::countr_zero(near_b), X_AB, margin)) {
      return true;
    }
  }
  return false;
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
