#include <fmt/format.h>
#include <fmt/ranges.h>

#include "collision/collision_checker.h"
#include "collision/fcl_checker.h"
#include "collision/simd_checker.h"
#include "common/error.h"

namespace planbench {
namespace {

[[noreturn]] void RefuseModel(CollisionModel model) {
  std::vector<std::string_view> available;
  for (CollisionModel each : AvailableCollisionModels()) {
    available.push_back(CollisionModelName(each));
  }
  throw InputError(fmt::format("the {} model is not available; available: {}",
                               CollisionModelName(model), fmt::join(available, ", ")));
}

}  // namespace

std::unique_ptr<CollisionChecker> MakeCollisionChecker(const Robot& robot,
                                                       const PlanningGroup& group,
                                                       CollisionModel model) {
  if (model == CollisionModel::kSpheres) return std::make_unique<SimdChecker>(robot, group);
  return MakeReferenceChecker(robot, group, model);
}

std::unique_ptr<CollisionChecker> MakeReferenceChecker(const Robot& robot,
                                                       const PlanningGroup& group,
                                                       CollisionModel model) {
  switch (model) {
    case CollisionModel::kSpheres:
    case CollisionModel::kMeshes:
      return std::make_unique<FclChecker>(robot, group, model);
    case CollisionModel::kVoxels:
      break;
  }
  RefuseModel(model);
}

}  // namespace planbench
