#include "geometry/polygons.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/lexicographic_less.h"

namespace planbench {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFar = 1000;  // In the file's unit: single precision is within 6e-5 there.

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Seen from where the polygon turns to the left.
std::vector<Vector2d> Flattened(std::span<const Vector3d> polygon) {
  const Vector3d& origin = polygon.front();
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    normal += (polygon[i] - origin).cross(polygon[i + 1] - origin);
  }
  const double length = normal.norm();
  const Vector3d up = length > 0 ? Vector3d(normal / length) : Vector3d::UnitZ();
  const Vector3d x = up.unitOrthogonal();
  const Vector3d y = up.cross(x);
  std::vector<Vector2d> flat;
  for (const Vector3d& p : polygon) flat.emplace_back(x.dot(p - origin), y.dot(p - origin));
  return flat;
}

class EarClipper {
 public:
  explicit EarClipper(std::vector<Vector2d> corners) : corners_(std::move(corners)) {
    const auto n = static_cast<std::uint32_t>(corners_.size());
    Vector2d low = corners_.front();
    Vector2d high = low;
    for (std::uint32_t i = 0; i < n; ++i) {
      before_.push_back((i + n - 1) % n);
      after_.push_back((i + 1) % n);
      low = low.cwiseMin(corners_[i]);
      high = high.cwiseMax(corners_[i]);
    }
    extent_ = (high - low).norm();
  }

  std::vector<std::array<std::uint32_t, 3>> Clip() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::uint32_t at = 1;
    for (std::size_t left = corners_.size(); left >= 3; --left) {
      at = FindEar(at, left);
      const std::uint32_t before = before_[at];
      const std::uint32_t after = after_[at];
      triangles.push_back({before, at, after});
      after_[before] = after;
      before_[after] = before;
      at = after;
    }
    return triangles;
  }

 private:
  // From a corner on; where rounding denies all what is most of an ear.
  std::uint32_t FindEar(std::uint32_t from, std::size_t left) const {
    if (left == 3) return from;
    for (const double slack : {1e-9, 1e-6, 1e-4}) {
      std::uint32_t at = from;
      for (std::size_t i = 0; i < left; ++i, at = after_[at]) {
        if (IsEar(at, slack * extent_)) return at;
      }
    }
    std::uint32_t flattest = from;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < left; ++i, from = after_[from]) {
      const double area = std::abs(TwiceArea(from));
      if (area >= least) continue;
      least = area;
      flattest = from;
    }
    return flattest;
  }

  double TwiceArea(std::uint32_t at) const {
    const Vector2d& corner = corners_[at];
    return Cross(corner - corners_[before_[at]], corners_[after_[at]] - corner);
  }

  // Whether the triangle that a corner makes with those beside it is within the polygon. Corners
  // that are no further than the slack, m, within it do not count.
  bool IsEar(std::uint32_t at, double slack) const {
    const Vector2d& a = corners_[before_[at]];
    const Vector2d& b = corners_[at];
    const Vector2d& c = corners_[after_[at]];
    const Vector2d ab = b - a;
    const Vector2d bc = c - b;
    const Vector2d ca = a - c;
    if (!(Cross(ab, bc) > slack * std::max({ab.norm(), bc.norm(), ca.norm()}))) return false;
    for (std::uint32_t i = after_[after_[at]]; i != before_[at]; i = after_[i]) {
      const Vector2d& p = corners_[i];
      if (p == a || p == b || p == c) continue;  // Of a bridge: its other edges tell.
      if (Cross(ab, p - a) > slack * ab.norm() && Cross(bc, p - b) > slack * bc.norm() &&
          Cross(ca, p - c) > -slack * ca.norm()) {
        return false;
      }
    }
    return true;
  }

  std::vector<Vector2d> corners_;
  std::vector<std::uint32_t> before_;  // Of each corner that is left the one that is.
  std::vector<std::uint32_t> after_;
  double extent_ = 0;
};

}  // namespace

void Polygons::AddVertex(const Vector3d& vertex) {
  if (vertices_.empty() && vertex.cwiseAbs().maxCoeff() > kFar) origin_ = vertex;
  vertices_.push_back(origin_ + (vertex - origin_).cast<float>().cast<double>());
}

void Polygons::AddPolygon(std::span<const std::uint32_t> corners) {
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  ends_.push_back(corners_.size());
}

std::vector<std::array<std::uint32_t, 3>> Triangulate(std::span<const Vector3d> polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return {};
  if (n == 3) return {{0, 1, 2}};
  // Not by the corner and the side that a file begins with.
  const auto least = std::min_element(polygon.begin(), polygon.end(), LexicographicLess);
  const auto first = static_cast<std::size_t>(least - polygon.begin());
  const bool is_turned = LexicographicLess(polygon[(first + 1) % n], polygon[(first + n - 1) % n]);
  std::vector<std::uint32_t> places;
  std::vector<Vector3d> corners;
  for (std::size_t i = 0; i < n; ++i) {
    places.push_back(static_cast<std::uint32_t>((first + (is_turned ? n - i : i)) % n));
    corners.push_back(polygon[places.back()]);
  }
  auto triangles = EarClipper(Flattened(corners)).Clip();
  for (auto& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = places[corner];
    if (is_turned) std::swap(triangle[1], triangle[2]);
  }
  return triangles;
}

}  // namespace planbench
