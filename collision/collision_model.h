#pragma once

#include "common/enum_names.h"

namespace planbench {

/// What stands for the robot and the world in a collision check.
enum class CollisionModel {
  kSpheres,    ///< Robot spheres against exact primitives and meshes.
  kVoxels,     ///< Robot spheres against a Euclidean distance field of the scene.
  kMeshes,     ///< Robot meshes against exact primitives and meshes.
  kEnclosing,  ///< As kSpheres, with the spheres that enclose the robot's meshes.
};
template <>
struct EnumNames<CollisionModel> {
  static constexpr auto kNames =
      std::to_array<std::string_view>({"spheres", "voxels", "meshes", "enclosing"});
};

/// For --help.
inline constexpr char kCollisionModelsHelp[] =
    "spheres: the robot's spheres; voxels: the same, against a distance field of the scene; "
    "meshes: its URDF's collision geometry; enclosing: its spheres that enclose that";

}  // namespace planbench
