#include "geometry/meshes_in_use.h"

#include <gtest/gtest.h>

#include <optional>

#include "common/error.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

TriangleMesh OneTriangle() {
  TriangleMesh mesh;
  mesh.vertices = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(MeshesInUse, ReadsAMeshOnceForAllThatHaveIt) {
  MeshesInUse meshes;
  int num_read = 0;
  const auto get = [&](const std::string& name) {
    return meshes.Get(name, [&] {
      ++num_read;
      return OneTriangle();
    });
  };
  std::optional<SharedMesh> first = get("a");
  std::optional<SharedMesh> second = get("a");
  EXPECT_EQ(num_read, 1);
  EXPECT_EQ(second->operator->(), first->operator->());
  EXPECT_EQ(get("b"), *first);
  EXPECT_EQ(num_read, 2);
  first.reset();
  get("a");
  EXPECT_EQ(num_read, 2);
  second.reset();
  get("a");
  EXPECT_EQ(num_read, 3) << "kept though nobody has it";
}

TEST(MeshesInUse, ForgetsTheNamesOfMeshesThatNobodyHas) {
  MeshesInUse meshes;
  const SharedMesh kept = meshes.Get("kept", OneTriangle);
  for (const char* name : {"a", "b", "c"}) meshes.Get(name, OneTriangle);
  EXPECT_EQ(meshes.size(), 2) << "the one in use, and the last";
  EXPECT_EQ(meshes.Get("kept", OneTriangle).operator->(), kept.operator->());
}

TEST(MeshesInUse, WhatCannotBeReadIsTriedAgain) {
  MeshesInUse meshes;
  const auto fail = []() -> TriangleMesh { throw InputError("a.obj: cannot be read"); };
  ExpectInputError([&] { meshes.Get("a", fail); }, {"a.obj"});
  EXPECT_EQ(meshes.size(), 0);
  EXPECT_EQ(meshes.Get("a", OneTriangle), SharedMesh(OneTriangle()));
}

}  // namespace
}  // namespace planbench
