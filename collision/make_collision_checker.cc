#include "collision/collision_checker.h"
#include "collision/fcl/fcl_checker.h"
#include "collision/follower_checker.h"
#include "collision/simd/kernels/sphere_kernel.h"
#include "collision/simd/simd_checker.h"

namespace planbench {
std::unique_ptr<CollisionChecker> MakeCollisionChecker(const Robot& robot,
                                                       const PlanningGroup& group,
                                                       CollisionModel model) {
  if (!group.followers.empty()) {
    return std::make_unique<FollowerChecker>(robot, group, model, MakeCollisionChecker);
  }
  return std::make_unique<SimdChecker>(robot, group, model);
}

std::unique_ptr<CollisionChecker> MakeReferenceChecker(const Robot& robot,
                                                       const PlanningGroup& group,
                                                       CollisionModel model) {
  if (!group.followers.empty()) {
    return std::make_unique<FollowerChecker>(robot, group, model, MakeReferenceChecker);
  }
  switch (model) {
    case CollisionModel::kSpheres:
    case CollisionModel::kEnclosing:
    case CollisionModel::kMeshes:
      return std::make_unique<FclChecker>(robot, group, model);
    case CollisionModel::kVoxels:
      break;  // the field is approximate by definition: its one engine is its reference
  }
  return std::make_unique<SimdChecker>(robot, group, model);
}

std::string VectorInstructions() {
  const std::string name = kernels::InstructionSet();
  // Of AVX3, AVX3_DL, AVX3_ZEN4, ... the kernels use the same.
  return name.starts_with("AVX3") ? "AVX-512" : name;
}

}  // namespace planbench
