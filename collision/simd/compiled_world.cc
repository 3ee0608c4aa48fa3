#include "collision/simd/compiled_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "collision/at.h"
#include "collision/balls.h"
#include "collision/object_cover.h"
#include "collision/shape_check.h"

namespace planbench {
namespace {

using kernels::Kind;
using kernels::Solid;

/// Solids further out or larger than this, m, lose more than a hundredth of a millimetre to single
/// precision.
constexpr double kLargest = 20;
/// Enlargement of solids, m: rounding of their numbers and of differences with positions in reach.
constexpr double kSolidPadding = 2e-5;

constexpr int kMaxLeafSolids = 4;

/// Whether a unit vector points along z, up to a rounding that moves nothing within `extent` (m) by
/// more than a small part of the padding.
bool IsVertical(const Eigen::Vector3d& axis, double extent) {
  return std::hypot(axis.x(), axis.y()) * extent < kSolidPadding / 10;
}

void SetCenter(const Eigen::Vector3d& center, Solid* solid) {
  for (int k = 0; k < 3; ++k) solid->center[k] = static_cast<float>(center[k]);
}

float Padded(double size) { return static_cast<float>(size + kSolidPadding); }

bool BoxWithin(const Eigen::Vector3d& center, const Eigen::Matrix3d& R_WS,
               const Eigen::Vector3d& half_size, const Ball& ball) {
  const Eigen::Vector3d p = R_WS.transpose() * (ball.center - center);
  const double reach = ball.radius + 2 * kSolidPadding;
  return (p.cwiseAbs() - half_size).cwiseMax(0.0).squaredNorm() <= reach * reach;
}

Solid MakeBox(const Eigen::Vector3d& center, const Eigen::Matrix3d& R_WS,
              const Eigen::Vector3d& half_size) {
  Solid solid{};
  SetCenter(center, &solid);
  for (int up = 0; up < 3; ++up) {
    if (!IsVertical(R_WS.col(up), half_size.norm())) continue;
    const int i = (up + 1) % 3;
    solid.kind = Kind::kUprightBox;
    const Eigen::Vector2d side = R_WS.col(i).head<2>().normalized();
    solid.v[0] = static_cast<float>(side.x());
    solid.v[1] = static_cast<float>(side.y());
    solid.v[2] = Padded(half_size[i]);
    solid.v[3] = Padded(half_size[(up + 2) % 3]);
    solid.v[4] = Padded(half_size[up]);
    return solid;
  }
  solid.kind = Kind::kBox;
  for (int k = 0; k < 9; ++k) solid.v[k] = static_cast<float>(R_WS(k % 3, k / 3));
  for (int k = 0; k < 3; ++k) solid.v[9 + k] = Padded(half_size[k]);
  return solid;
}

Solid MakeAxial(Kind kind, const Eigen::Vector3d& center, const Eigen::Vector3d& axis,
                double radius, double half_length) {
  Solid solid{};
  solid.kind = kind;
  SetCenter(center, &solid);
  for (int k = 0; k < 3; ++k) solid.v[k] = static_cast<float>(axis[k]);
  solid.v[3] = Padded(radius);
  solid.v[4] = Padded(half_length);
  return solid;
}

/// A box cut to the part that points within `reach` can have as their nearest one: distances from
/// there stay as they are, and its numbers small. Returns false if nothing is left.
bool CutBox(const Ball& reach, const Eigen::Matrix3d& R_WS, Eigen::Vector3d* center,
            Eigen::Vector3d* half_size) {
  const Eigen::Vector3d p = R_WS.transpose() * (reach.center - *center);
  Eigen::Vector3d middle;
  for (int k = 0; k < 3; ++k) {
    const double low = std::max(-(*half_size)[k], p[k] - 3 * reach.radius);
    const double high = std::min((*half_size)[k], p[k] + 3 * reach.radius);
    if (low > high) return false;
    middle[k] = (low + high) / 2;
    (*half_size)[k] = (high - low) / 2;
  }
  *center += R_WS * middle;
  return true;
}

}  // namespace

void CompiledWorld::SetObjects(const Scene& scene, const CompiledRobot& robot, Ball reach) {
  kernel.solids.clear();
  kernel.meshes.clear();
  kernel.trees.clear();
  kernel.candidates.clear();
  kernel.bvh.clear();
  kernel.bvh_solids.clear();
  sources_.clear();
  objects_.clear();
  meshes_before_ = std::move(meshes_);
  meshes_.clear();
  cones_are_doubtful_ = !robot.kernel.patches.empty();
  reach.radius += kMaxDistance;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const Pose X_WO = Pose::From(object.X_WO);
    const auto place = static_cast<int>(objects_.size());
    for (const PlacedShape& placed : object.shapes) {
      RequireSolid(placed.shape, object.id);
      AddShape(placed.shape, X_WO * Pose::From(placed.X_FS), place, reach);
    }
    const bool has_solid = !sources_.empty() && sources_.back().object == place;
    if (has_solid) objects_.push_back(static_cast<int>(i));
  }
  meshes_before_.clear();
  if (kernel.solids.size() > kMaxListed) BuildHierarchy();
}

void CompiledWorld::AddShape(const Shape& shape, const Pose& X_WS, int object, const Ball& reach) {
  if (std::holds_alternative<HalfSpace>(shape)) {
    AddHalfSpace(X_WS, object, reach);
    return;
  }
  const Eigen::AlignedBox3d box = BoxAround(shape);
  Source source{object, X_WS * box.center(), X_WS.rotation, box.sizes() / 2};
  const Eigen::Vector3d axis = X_WS.rotation.col(2);
  const auto* cylinder = std::get_if<Cylinder>(&shape);
  const auto* cone = std::get_if<Cone>(&shape);
  const auto* capsule = std::get_if<Capsule>(&shape);
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (!BoxWithin(source.center, source.R_WS, source.half_size, reach)) return;

  const bool is_box = std::holds_alternative<Box>(shape);
  const bool large = !is_box && std::max(source.half_size.maxCoeff(),
                                         (source.center - reach.center).norm()) > kLargest;
  const bool doubtful = large || (cone != nullptr && cones_are_doubtful_);
  if (is_box || doubtful || mesh != nullptr) {
    if (!CutBox(reach, source.R_WS, &source.center, &source.half_size)) return;
    Solid solid = MakeBox(source.center, source.R_WS, source.half_size);
    solid.doubtful = doubtful;
    if (mesh != nullptr && !doubtful) solid.mesh = AddMesh(mesh->triangles, X_WS);
    AddSolid(solid, source);
  } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    Solid solid{};
    solid.kind = Kind::kSphere;
    SetCenter(source.center, &solid);
    solid.v[0] = Padded(sphere->radius);
    AddSolid(solid, source);
  } else if (cylinder != nullptr && IsVertical(axis, source.half_size.norm())) {
    Solid solid{};
    solid.kind = Kind::kUprightCylinder;
    SetCenter(source.center, &solid);
    solid.v[0] = Padded(cylinder->radius);
    solid.v[1] = Padded(cylinder->length / 2);
    AddSolid(solid, source);
  } else if (cylinder != nullptr) {
    AddSolid(
        MakeAxial(Kind::kCylinder, source.center, axis, cylinder->radius, cylinder->length / 2),
        source);
  } else if (capsule != nullptr) {
    AddSolid(MakeAxial(Kind::kCapsule, source.center, axis, capsule->radius, capsule->length / 2),
             source);
  } else {
    AddSolid(MakeAxial(Kind::kCone, source.center, axis, cone->radius, cone->length / 2), source);
  }
}

int CompiledWorld::AddMesh(const SharedMesh& mesh, const Pose& X_WS) {
  std::shared_ptr<const MeshTree>& tree = meshes_[mesh.id()];
  if (tree == nullptr) tree = meshes_before_[mesh.id()];
  if (tree == nullptr) tree = std::make_shared<const MeshTree>(mesh);

  kernels::WorldMesh placed{};
  placed.tree = &tree->tree();
  const Eigen::Vector3d position = X_WS * Eigen::Vector3d::Map(tree->tree().origin);
  for (int row = 0; row < 3; ++row) {
    placed.position[row] = static_cast<float>(position[row]);
    for (int column = 0; column < 3; ++column) {
      placed.rotation[3 * row + column] = static_cast<float>(X_WS.rotation(column, row));
    }
  }
  kernel.meshes.push_back(placed);
  return static_cast<int>(kernel.meshes.size()) - 1;
}

void CompiledWorld::AddHalfSpace(const Pose& X_WS, int object, const Ball& reach) {
  const Eigen::Vector3d normal = X_WS.rotation.col(2);
  const double height = normal.dot(reach.center - X_WS.translation);
  if (height > reach.radius + 2 * kSolidPadding) return;
  // Its bounding box is that of the part below the plane that points within reach can be in or
  // have as their nearest one.
  const Eigen::Vector3d foot = reach.center - height * normal;
  const double depth = 2 * reach.radius + std::max(-height, 0.0);
  Source source{object, foot - depth / 2 * normal, X_WS.rotation,
                Eigen::Vector3d(2 * reach.radius, 2 * reach.radius, depth / 2)};
  Solid solid{};
  solid.kind = Kind::kHalfSpace;
  SetCenter(foot + kSolidPadding * normal, &solid);
  for (int k = 0; k < 3; ++k) solid.v[k] = static_cast<float>(normal[k]);
  AddSolid(solid, source);
}

void CompiledWorld::AddSolid(Solid solid, const Source& source) {
  solid.extent = static_cast<float>(source.half_size.maxCoeff());
  kernel.solids.push_back(solid);
  sources_.push_back(source);
}

std::vector<unsigned char> CompiledWorld::DoubtfulObjects(std::size_t num_objects) const {
  std::vector<unsigned char> doubtful(num_objects, 0);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (kernel.solids[i].doubtful) At(doubtful, At(objects_, sources_[i].object)) = 1;
  }
  return doubtful;
}

void CompiledWorld::AddTree(const CompiledTree& tree, const std::vector<unsigned char>& checked) {
  const int first = static_cast<int>(kernel.candidates.size());
  const bool all_checked = std::find(checked.begin(), checked.end(), 0) == checked.end();
  if (!kernel.bvh.empty() && all_checked) {
    kernel.trees.push_back({tree.root, tree.body, tree.doubtful, tree.reach, 0, -1, 0, -1});
    return;
  }
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Source& source = sources_[i];
    if (At(checked, source.object) == 0) continue;
    if (!BoxWithin(source.center, source.R_WS, source.half_size, tree.reach_W)) continue;
    kernel.candidates.push_back(static_cast<std::int32_t>(i));
  }
  const int num = static_cast<int>(kernel.candidates.size()) - first;
  kernel.trees.push_back({tree.root, tree.body, tree.doubtful, tree.reach, first, num, 0, -1});
  if (all_checked) return;
  kernel.trees.back().first_checked = static_cast<int>(kernel.candidates.size());
  kernel.trees.back().num_checked = 0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (At(checked, sources_[i].object) == 0) continue;
    kernel.candidates.push_back(static_cast<std::int32_t>(i));
    ++kernel.trees.back().num_checked;
  }
}

void CompiledWorld::BuildHierarchy() {
  kernel.bvh_solids.resize(sources_.size());
  std::iota(kernel.bvh_solids.begin(), kernel.bvh_solids.end(), 0);
  BuildNode(0, static_cast<int>(sources_.size()));
}

void CompiledWorld::BuildNode(int first, int last) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  Eigen::Vector3d centers_low = low;
  Eigen::Vector3d centers_high = high;
  for (int i = first; i < last; ++i) {
    const Source& source = At(sources_, At(kernel.bvh_solids, i));
    const Eigen::Vector3d extent = source.R_WS.cwiseAbs() * source.half_size;
    low = low.cwiseMin(source.center - extent);
    high = high.cwiseMax(source.center + extent);
    centers_low = centers_low.cwiseMin(source.center);
    centers_high = centers_high.cwiseMax(source.center);
  }
  const std::size_t index = kernel.bvh.size();
  kernels::BvhNode node{};
  for (int k = 0; k < 3; ++k) {
    node.low[k] = static_cast<float>(low[k] - 4 * kSolidPadding);
    node.high[k] = static_cast<float>(high[k] + 4 * kSolidPadding);
  }
  const bool leaf = last - first <= kMaxLeafSolids;
  node.first = first;
  node.count = leaf ? last - first : 0;
  kernel.bvh.push_back(node);
  if (!leaf) {
    int axis = 0;
    (centers_high - centers_low).maxCoeff(&axis);
    const int middle = (first + last) / 2;
    std::nth_element(kernel.bvh_solids.begin() + first, kernel.bvh_solids.begin() + middle,
                     kernel.bvh_solids.begin() + last, [&](std::int32_t a, std::int32_t b) {
                       const double at = At(sources_, a).center[axis];
                       const double bt = At(sources_, b).center[axis];
                       return at < bt || (at == bt && a < b);
                     });
    BuildNode(first, middle);
    BuildNode(middle, last);
  }
  kernel.bvh[index].next = static_cast<std::int32_t>(kernel.bvh.size());
}

}  // namespace planbench
