// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_HULLS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_HULLS_INL_H_
#undef PLANBENCH_KERNELS_HULLS_INL_H_
#else
#define PLANBENCH_KERNELS_HULLS_INL_H_
#endif

#include <bit>
#include <cmath>
#include <limits>

#include "collision/simd/kernels/transform-inl.h"
#include "collision/simd/simplex.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

// Planes between convex hulls, by the algorithm of Gilbert, Johnson and Keerthi (see Simplex):
// along a direction the two are apart by what the extremes of their points are; the extremes are
// where a better direction is looked for. It stops early, since what it does not tell apart the
// triangles decide, and nothing that it rounds makes a plane of what is none.

/// Directions that are tried.
inline constexpr int kMostDirections = 12;

/// Least d . p over a hull's points p, a direction a lane.
HWY_INLINE V LeastAlong(const PointGroup* points, int num, const Points& d) {
  constexpr int kSums = 4;
  const V most = Fill(std::numeric_limits<float>::max());
  V least[kSums] = {most, most, most, most};
  for (int g = 0; g < num; ++g) {
    const auto& p = points[g].p;
    for (int first = 0; first < kWide; first += kSums) {
      for (int k = 0; k < kSums; ++k) {
        const int i = first + k;
        const V value =
            hn::MulAdd(d.x, Fill(p[0][i]), hn::MulAdd(d.y, Fill(p[1][i]), d.z * Fill(p[2][i])));
        least[k] = hn::Min(least[k], value);
      }
    }
  }
  return hn::Min(hn::Min(least[0], least[1]), hn::Min(least[2], least[3]));
}

/// The extreme of a hull's points in one direction.
class Extreme {
 public:
  HWY_INLINE Extreme(const PointGroup* points, int num, const float* d) : points_(points) {
    const int width = static_cast<int>(hn::Lanes(Lanes()));
    const Points direction = Fill(d);
    V least = Fill(std::numeric_limits<float>::max());
    for (int g = 0; g < num; ++g) {
      for (int first = 0; first < kWide; first += width) {
        const auto& p = points[g].p;
        const V value =
            Dot(direction, {Load(p[0] + first), Load(p[1] + first), Load(p[2] + first)});
        Store(value, values_ + g * kWide + first);
        least = hn::Min(least, value);
      }
    }
    least_ = hn::MinOfLanes(Lanes(), least);
  }

  /// The least d . p.
  float value() const { return hn::GetLane(least_); }
  /// Where it is.
  void Find(float* point) const {
    const int width = static_cast<int>(hn::Lanes(Lanes()));
    for (int first = 0;; first += width) {
      const LaneMask at = Bits(hn::Eq(Load(values_ + first), least_));
      if (at == 0) continue;
      const int i = first + std::countr_zero(at);
      for (int k = 0; k < 3; ++k) point[k] = points_[i / kWide].p[k][i % kWide];
      return;
    }
  }

 private:
  alignas(64) float values_[kMostPoints];
  V least_;
  const PointGroup* points_;
};

inline float Dot(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The widest gap found between two convex bodies, m; 0: no plane between them was. Ends once one
/// is wider than `margin`, or none can be. `gap(d, w, suffices)` finds the least d . (a - b) of
/// points a, b of the one and the other; unless that suffices, and it returns true, it stores that
/// a - b. `direction`: a guess from the other to the one, any but 0; becomes that of the gap, if
/// there is one.
template <typename Gap>
HWY_INLINE float GapBetween(float* direction, float margin, Gap gap) {
  Simplex<float> simplex;
  Eigen::Vector3f v = Eigen::Vector3f::Map(direction);
  float widest = 0;  // Squared.
  for (int i = 0; i < kMostDirections; ++i) {
    Eigen::Vector3f w;
    const auto suffices = [&](float along) {
      const float squared = along * along / v.squaredNorm();
      if (along > 0 && squared > widest) {
        widest = squared;
        Eigen::Vector3f::Map(direction) = v;
      }
      return widest > margin * margin;
    };
    if (gap(v.data(), w.data(), suffices)) break;
    simplex.Add(w);
    if (simplex.encloses_origin() || simplex.squared_distance() <= margin * margin) break;
    v = simplex.nearest();
  }
  return std::sqrt(widest);
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
