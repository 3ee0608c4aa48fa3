#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

namespace planbench {

/// Up to four points of a convex body, and the point of their hull that is nearest to the origin, m
/// (Gilbert, Johnson and Keerthi, A fast procedure for computing the distance between complex
/// objects in three-dimensional space, 1988). Whatever is rounded, that is a point of the body.
template <typename Scalar>
class Simplex {
 public:
  using Vector = Eigen::Vector3<Scalar>;

  /// Adds the body's point that is furthest against nearest(), and drops those that the new nearest
  /// one does not need. There must be fewer than four.
  void Add(const Vector& point) {
    const std::size_t num = size_;
    std::array<Vector, 3> edges;
    std::array<Scalar, 3> along;  // -point . edge
    std::array<Scalar, 3> squared;
    for (std::size_t i = 0; i < num; ++i) {
      edges[i] = corners_[i] - point;
      along[i] = -point.dot(edges[i]);
      squared[i] = edges[i].squaredNorm();
    }
    nearest_ = point;
    squared_distance_ = point.squaredNorm();
    unsigned needed = 0;
    // Nothing that is not a number is, where edges have no extent.
    const auto take_nearer = [&](const Vector& other, unsigned corners) {
      const Scalar squared_norm = other.squaredNorm();
      if (!(squared_norm < squared_distance_)) return;
      nearest_ = other;
      squared_distance_ = squared_norm;
      needed = corners;
    };
    for (std::size_t i = 0; i < num; ++i) {
      if (along[i] < 0 || along[i] > squared[i]) continue;
      take_nearer(point + along[i] / squared[i] * edges[i], 1u << i);
    }
    for (std::size_t j = 1; j < num; ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        const Scalar between = edges[i].dot(edges[j]);
        const Scalar area = squared[i] * squared[j] - between * between;
        const Scalar weight_i = squared[j] * along[i] - between * along[j];
        const Scalar weight_j = squared[i] * along[j] - between * along[i];
        if (weight_i < 0 || weight_j < 0 || weight_i + weight_j > area) continue;
        take_nearer(point + weight_i / area * edges[i] + weight_j / area * edges[j],
                    1u << i | 1u << j);
      }
    }
    if (num == 3) {
      const auto& [a, b, c] = edges;
      const Vector across = b.cross(c);
      const Vector weights =
          -Vector(point.dot(across), point.dot(c.cross(a)), point.dot(a.cross(b))) / a.dot(across);
      if (weights.minCoeff() >= 0 && weights.sum() <= 1) {
        take_nearer(point + weights[0] * a + weights[1] * b + weights[2] * c, 7u);
      }
    }
    size_ = 0;
    for (std::size_t i = 0; i < num; ++i) {
      if ((needed >> i & 1) != 0) corners_[size_++] = corners_[i];
    }
    corners_[size_++] = point;
  }

  const Vector& nearest() const { return nearest_; }
  Scalar squared_distance() const { return squared_distance_; }
  /// Whether the nearest point is the origin, as far as it is not rounded.
  bool encloses_origin() const { return size_ == corners_.size(); }

 private:
  std::array<Vector, 4> corners_;
  std::size_t size_ = 0;
  Vector nearest_ = Vector::Zero();
  Scalar squared_distance_ = 0;
};

}  // namespace planbench
