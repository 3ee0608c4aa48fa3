#include "sphere_fitting/link_body.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "common/error.h"
#include "common/numbers.h"
#include "geometry/polyhedra.h"
#include "sphere_fitting/hole_filling.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

constexpr int kSidesOfCylinders = 64;  // The prisms are 0.12 % of the radius off.

std::shared_ptr<const Solid> Placed(TriangleMesh mesh, const Eigen::Isometry3d& X_FS) {
  for (Vector3d& vertex : mesh.vertices) vertex = X_FS * vertex;
  return std::make_shared<const Solid>(std::move(mesh));
}

}  // namespace

Solid::Solid(TriangleMesh mesh) : mesh_(std::move(mesh)), inside_(mesh_), surface_(mesh_) {}

double Solid::Depth(const Vector3d& point) const {
  const double distance = surface_.Distance(point);
  return inside_.Contains(point) ? distance : -distance;
}

int LinkBody::Add(const PlacedShape& placed) {
  if (const auto* sphere = std::get_if<Sphere>(&placed.shape)) {
    spheres_.push_back({placed.X_FS.translation(), sphere->radius});
  } else if (const auto* box = std::get_if<Box>(&placed.shape)) {
    const auto solid = Placed(BoxMesh(box->size), placed.X_FS);
    solids_.push_back({solid, solid, solid});
  } else if (const auto* cylinder = std::get_if<Cylinder>(&placed.shape)) {
    const double around = cylinder->radius / std::cos(std::numbers::pi / kSidesOfCylinders);
    const auto hull = Placed(PrismMesh(around, cylinder->length, kSidesOfCylinders), placed.X_FS);
    const auto core =
        Placed(PrismMesh(cylinder->radius, cylinder->length, kSidesOfCylinders), placed.X_FS);
    solids_.push_back({hull, core, core});
  } else if (const auto* mesh = std::get_if<Mesh>(&placed.shape)) {
    const auto core = Placed(mesh->triangles, placed.X_FS);
    TriangleMesh filled = core->mesh();
    const int holes = FillSmallHoles(&filled);
    const auto shape = holes > 0 ? std::make_shared<const Solid>(std::move(filled)) : core;
    solids_.push_back({shape, shape, core});
    return holes;
  } else {
    throw InputError("spheres cannot be fitted to a " + ShapeTypeName(placed.shape));
  }
  return 0;
}

std::vector<const Solid*> LinkBody::hulls() const {
  std::vector<const Solid*> hulls;
  for (const Forms& forms : solids_) hulls.push_back(forms.hull.get());
  return hulls;
}

double LinkBody::HullDepth(const Vector3d& point) const {
  double depth = -kInfinity;
  for (const Forms& forms : solids_) depth = std::max(depth, forms.hull->Depth(point));
  return depth;
}

double LinkBody::Depth(const Vector3d& point) const {
  double depth = -kInfinity;
  for (const Forms& forms : solids_) depth = std::max(depth, forms.shape->Depth(point));
  for (const Ball& sphere : spheres_) {
    depth = std::max(depth, sphere.radius - (point - sphere.center).norm());
  }
  return depth;
}

double LinkBody::CoreDepth(const Vector3d& point) const {
  double depth = -kInfinity;
  for (const Forms& forms : solids_) depth = std::max(depth, forms.core->Depth(point));
  return depth;
}

bool LinkBody::Encloses(const Vector3d& point) const {
  return std::any_of(solids_.begin(), solids_.end(),
                     [&](const Forms& forms) { return forms.shape->inside().Contains(point); }) ||
         std::any_of(spheres_.begin(), spheres_.end(), [&](const Ball& sphere) {
           return (point - sphere.center).norm() < sphere.radius;
         });
}

}  // namespace planbench
