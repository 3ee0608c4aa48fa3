#include "tests/contract/collision_checker_contract.h"

namespace planbench {
namespace {

INSTANTIATE_TEST_SUITE_P(Fcl, CollisionCheckerContract,
                         testing::Values(CollisionEngine{
                             "spheres",
                             [](const Robot& robot, const PlanningGroup& group) {
                               return MakeCollisionChecker(robot, group, CollisionModel::kSpheres);
                             }}),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace planbench
