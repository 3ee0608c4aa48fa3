#include "geometry/plain_polygons.h"

#include <fmt/format.h>

#include <iterator>

namespace planbench {
namespace {

constexpr double kFar = 1000;  // In the file's unit: single precision is within 6e-5 there.

}  // namespace

void PlainPolygons::AddVertex(const Eigen::Vector3d& vertex) {
  if (vertices_.empty() && vertex.cwiseAbs().maxCoeff() > kFar) origin_ = vertex;
  const Eigen::Vector3d v = vertex - origin_;
  fmt::format_to(std::back_inserter(vertices_), "v {} {} {}\n", v.x(), v.y(), v.z());
}

void PlainPolygons::AddPolygon(std::span<const std::uint32_t> corners) {
  faces_ += 'f';
  for (const std::uint32_t corner : corners) {
    fmt::format_to(std::back_inserter(faces_), " {}", corner);
  }
  faces_ += '\n';
}

}  // namespace planbench
