#include <memory>

#include "collision/fcl/fcl_checker.h"
#include "collision/simd/simd_checker.h"
#include "tests/contract/collision_checker_contract.h"

namespace planbench {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Engines, CollisionCheckerContract,
    testing::Values(CollisionEngine{"fcl",
                                    [](const Robot& robot, const PlanningGroup& group) {
                                      return std::make_unique<FclChecker>(robot, group,
                                                                          CollisionModel::kSpheres);
                                    }},
                    CollisionEngine{"simd",
                                    [](const Robot& robot, const PlanningGroup& group) {
                                      return std::make_unique<SimdChecker>(robot, group);
                                    },
                                    1e-4}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace planbench
