#include "collision/shape_check.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "common/error.h"

namespace planbench {
namespace {

void RequireSizes(const std::string& owner, const Shape& shape,
                  std::initializer_list<double> sizes) {
  for (double size : sizes) {
    if (!std::isfinite(size) || size < 0) {
      throw InputError(
          fmt::format("'{}': a {} has the size {} m", owner, ShapeTypeName(shape), size));
    }
  }
}

void RequireTriangles(const std::string& owner, const Mesh& mesh) {
  const std::string& fault = mesh.triangles.fault();
  if (fault.empty()) return;
  throw InputError(fmt::format("'{}': {} {}", owner,
                               mesh.resource.empty() ? "a mesh" : "mesh " + mesh.resource, fault));
}

}  // namespace

void RequireSolid(const Shape& shape, const std::string& owner) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    RequireSizes(owner, shape, {box->size.x(), box->size.y(), box->size.z()});
  } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    RequireSizes(owner, shape, {sphere->radius});
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    RequireSizes(owner, shape, {cylinder->radius, cylinder->length});
  } else if (const auto* cone = std::get_if<Cone>(&shape)) {
    RequireSizes(owner, shape, {cone->radius, cone->length});
  } else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    RequireSizes(owner, shape, {capsule->radius, capsule->length});
  } else if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    RequireTriangles(owner, *mesh);
  }
}

}  // namespace planbench
