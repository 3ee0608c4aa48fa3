#include "collision/collision_model.h"

#include <stdexcept>

namespace planbench {

std::string_view CollisionModelName(CollisionModel model) {
  switch (model) {
    case CollisionModel::kSpheres:
      return "spheres";
    case CollisionModel::kVoxels:
      return "voxels";
    case CollisionModel::kMeshes:
      return "meshes";
  }
  throw std::invalid_argument("CollisionModelName: no such collision model");
}

std::optional<CollisionModel> ParseCollisionModel(std::string_view name) {
  for (CollisionModel model :
       {CollisionModel::kSpheres, CollisionModel::kVoxels, CollisionModel::kMeshes}) {
    if (name == CollisionModelName(model)) return model;
  }
  return std::nullopt;
}

const std::vector<CollisionModel>& AvailableCollisionModels() {
  static const std::vector<CollisionModel> kAvailable = {
      CollisionModel::kSpheres, CollisionModel::kVoxels, CollisionModel::kMeshes};
  return kAvailable;
}

}  // namespace planbench
