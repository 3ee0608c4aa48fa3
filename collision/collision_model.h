#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace planbench {

/// What stands for the robot and the world in a collision check.
enum class CollisionModel {
  kSpheres,  ///< Robot spheres against exact primitives and meshes.
  kVoxels,   ///< Robot spheres against a Euclidean distance field of the scene.
  kMeshes,   ///< Robot meshes against exact primitives and meshes.
};

/// "spheres", "voxels", "meshes".
std::string_view CollisionModelName(CollisionModel model);
std::optional<CollisionModel> ParseCollisionModel(std::string_view name);
/// The models MakeCollisionChecker can build.
const std::vector<CollisionModel>& AvailableCollisionModels();

}  // namespace planbench
