#include <algorithm>
#include <stdexcept>
#include <variant>

#include "common/content_hash.h"
#include "scene/pose.h"
#include "scene/scene.h"

namespace planbench {
namespace {

// Changes with the layout of what is hashed, so that ids of different layouts never meet.
constexpr const char* kSceneLayout = "planbench scene 1";

void AddVector(const Eigen::Vector3d& vector, ContentHash* hash) {
  for (int i = 0; i < 3; ++i) hash->Add(vector[i]);
}

void AddPose(const Eigen::Isometry3d& pose, ContentHash* hash) {
  AddVector(pose.translation(), hash);
  for (const std::int64_t step : OrientationSteps(pose)) hash->Add(step);
}

struct ShapeHasher {
  ContentHash* hash;

  void operator()(const Box& box) const { AddVector(box.size, hash); }
  void operator()(const Sphere& sphere) const { hash->Add(sphere.radius); }
  void operator()(const Cylinder& cylinder) const {
    hash->Add(cylinder.radius);
    hash->Add(cylinder.length);
  }
  void operator()(const Cone& cone) const {
    hash->Add(cone.radius);
    hash->Add(cone.length);
  }
  void operator()(const Capsule& capsule) const {
    hash->Add(capsule.radius);
    hash->Add(capsule.length);
  }
  void operator()(const HalfSpace&) const {}
  void operator()(const Mesh& mesh) const {
    if (mesh.triangles->triangles.empty()) {
      throw std::invalid_argument("SceneId: the mesh '" + mesh.resource + "' is not loaded");
    }
    hash->Add(mesh.triangles.id());
  }
};

void AddObject(const SceneObject& object, ContentHash* hash) {
  hash->Add(object.id);
  AddPose(object.X_WO, hash);
  hash->Add(object.shapes.size());
  // Primitives before meshes before half-spaces, as files keep them in three lists.
  for (const int list : {0, 1, 2}) {
    for (const PlacedShape& placed : object.shapes) {
      const int own_list = std::holds_alternative<Mesh>(placed.shape)        ? 1
                           : std::holds_alternative<HalfSpace>(placed.shape) ? 2
                                                                             : 0;
      if (own_list != list) continue;
      hash->Add(ShapeTypeName(placed.shape));
      AddPose(placed.X_FS, hash);
      std::visit(ShapeHasher{hash}, placed.shape);
    }
  }
}

void AddAttached(const AttachedObject& attached, ContentHash* hash) {
  hash->Add(attached.link);
  AddObject(attached.object, hash);
  std::vector<std::string> touch_links = attached.touch_links;
  std::sort(touch_links.begin(), touch_links.end());
  touch_links.erase(std::unique(touch_links.begin(), touch_links.end()), touch_links.end());
  hash->Add(touch_links.size());
  for (const std::string& link : touch_links) hash->Add(link);
}

void AddAllowedCollisions(const AllowedCollisionMatrix& matrix, ContentHash* hash) {
  hash->Add(matrix.default_entries().size());
  for (const auto& [name, allowed] : matrix.default_entries()) {
    hash->Add(name);
    hash->Add(allowed);
  }
  const auto tells = [&](const auto& entry) { return matrix.Tells(entry); };
  hash->Add(static_cast<std::size_t>(
      std::count_if(matrix.entries().begin(), matrix.entries().end(), tells)));
  for (const auto& entry : matrix.entries()) {
    if (!tells(entry)) continue;
    const auto& [pair, allowed] = entry;
    hash->Add(pair.first);
    hash->Add(pair.second);
    hash->Add(allowed);
  }
}

}  // namespace

std::string SceneId(const Scene& scene) {
  ContentHash hash;
  hash.Add(kSceneLayout);
  hash.Add(scene.world_frame);
  hash.Add(scene.objects.size());
  for (const SceneObject& object : scene.objects) AddObject(object, &hash);
  hash.Add(scene.attached.size());
  for (const AttachedObject& attached : scene.attached) AddAttached(attached, &hash);
  AddAllowedCollisions(scene.allowed_collisions, &hash);
  return hash.HexDigest();
}

}  // namespace planbench
