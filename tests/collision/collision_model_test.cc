#include "collision/collision_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planbench {
namespace {

TEST(CollisionModelTest, NamesAreParsedBack) {
  EXPECT_EQ(ParseCollisionModel("spheres"), CollisionModel::kSpheres);
  EXPECT_EQ(ParseCollisionModel("voxels"), CollisionModel::kVoxels);
  EXPECT_EQ(ParseCollisionModel("meshes"), CollisionModel::kMeshes);
  for (const char* unknown : {"", "sphere", "Spheres", "meshes "}) {
    EXPECT_EQ(ParseCollisionModel(unknown), std::nullopt);
  }
  EXPECT_THAT(AvailableCollisionModels(),
              testing::ElementsAre(CollisionModel::kSpheres, CollisionModel::kVoxels,
                                   CollisionModel::kMeshes));
}

}  // namespace
}  // namespace planbench
