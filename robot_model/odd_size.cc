#include "robot_model/odd_size.h"

#include <fmt/format.h>

#include <variant>

namespace planbench {
namespace {

constexpr double kLeastExtent = 1e-3;  // m

}  // namespace

std::optional<std::string> OddSize(const std::string& link, const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const double extent = mesh->triangles.box().sizes().maxCoeff();
    if (extent >= kLeastExtent && extent <= kGreatestExtent) return std::nullopt;
    return fmt::format("link '{}', {}: is {:.3g} m large: check its unit, and scale= in the URDF",
                       link, mesh->resource, extent);
  }
  const double extent = 2 * ComputeBoundingSphere(shape).radius;
  if (extent <= kGreatestExtent) return std::nullopt;
  return fmt::format("link '{}': a shape is {:.3g} m large: URDFs are in metres", link, extent);
}

}  // namespace planbench
