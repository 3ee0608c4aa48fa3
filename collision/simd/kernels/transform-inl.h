// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_TRANSFORM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_TRANSFORM_INL_H_
#undef PLANBENCH_KERNELS_TRANSFORM_INL_H_
#else
#define PLANBENCH_KERNELS_TRANSFORM_INL_H_
#endif

#include "collision/simd/kernels/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// A pose X_AB that is not a lane's: R row-major, translation in m.
struct Transform {
  float rotation[9];
  float translation[3];

  void Times(const float* p_B, float* p_A) const {
    for (int row = 0; row < 3; ++row) {
      const float* r = rotation + 3 * row;
      p_A[row] = r[0] * p_B[0] + r[1] * p_B[1] + r[2] * p_B[2] + translation[row];
    }
  }
  HWY_INLINE Points operator*(const Points& p_B) const {
    const auto row = [&](int i) {
      const float* r = rotation + 3 * i;
      return hn::MulAdd(
          Fill(r[0]), p_B.x,
          hn::MulAdd(Fill(r[1]), p_B.y, hn::MulAdd(Fill(r[2]), p_B.z, Fill(translation[i]))));
    };
    return {row(0), row(1), row(2)};
  }
  void InverseTimes(const float* p_A, float* p_B) const {
    const float p[3] = {p_A[0] - translation[0], p_A[1] - translation[1], p_A[2] - translation[2]};
    for (int c = 0; c < 3; ++c) {
      p_B[c] = rotation[c] * p[0] + rotation[3 + c] * p[1] + rotation[6 + c] * p[2];
    }
  }
  Transform Inverse() const {
    Transform X;
    for (int i = 0; i < 9; ++i) X.rotation[i] = rotation[3 * (i % 3) + i / 3];
    const float zero[3] = {0, 0, 0};
    InverseTimes(zero, X.translation);
    return X;
  }
};

/// X_CA * X_AB, of which C's orientation and origin in A are given (R_CA row-major, p_AC in m): the
/// difference of positions, which may be far from A's origin both, is taken first.
inline Transform FromFrame(const float* R_CA, const float* p_AC, const Transform& X_AB) {
  Transform X;
  for (int row = 0; row < 3; ++row) {
    const float* r = R_CA + 3 * row;
    for (int c = 0; c < 3; ++c) {
      X.rotation[3 * row + c] =
          r[0] * X_AB.rotation[c] + r[1] * X_AB.rotation[3 + c] + r[2] * X_AB.rotation[6 + c];
    }
    X.translation[row] = 0;
    for (int k = 0; k < 3; ++k) X.translation[row] += r[k] * (X_AB.translation[k] - p_AC[k]);
  }
  return X;
}

/// X_AB of two poses in W.
inline Transform Between(const Transform& X_WA, const Transform& X_WB) {
  float R_AW[9];
  for (int i = 0; i < 9; ++i) R_AW[i] = X_WA.rotation[3 * (i % 3) + i / 3];
  return FromFrame(R_AW, X_WA.translation, X_WB);
}

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
