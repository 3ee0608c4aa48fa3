#include "report/shape_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/polyhedra.h"
#include "tests/report/browser.h"

namespace planbench {
namespace {

/// Numbers that a text of a mesh's content holds.
std::vector<std::uint32_t> Numbers(const Json& text, std::size_t num_bytes) {
  const std::string bytes = FromBase64(text);
  std::vector<std::uint32_t> numbers(bytes.size() / num_bytes);
  for (std::size_t i = 0; i < num_bytes * numbers.size(); ++i) {
    numbers[i / num_bytes] |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i]))
                              << (8 * (i % num_bytes));
  }
  return numbers;
}

Shape MeshShape(TriangleMesh mesh) {
  Mesh shape;
  shape.triangles = std::move(mesh);
  return shape;
}

TEST(ShapeJson, AMeshIsNamedAndItsContentIsThereOnce) {
  Json meshes = Json::object();
  const SharedMesh box(BoxMesh({2, 4, 0.5}));
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(ShapeJson(MeshShape(box), &meshes), Json({{"type", "mesh"}, {"mesh", box.id()}}));
  }
  ASSERT_EQ(meshes.size(), 1u);
  const Json& content = meshes[box.id()];
  EXPECT_EQ(content["low"], Json({-1.0, -2.0, -0.25}));
  EXPECT_EQ(content["size"], Json({2.0, 4.0, 0.5}));
  const auto vertices = Numbers(content["vertices"], 2);
  ASSERT_EQ(vertices.size(), 8u * 3);
  EXPECT_THAT(std::vector(vertices.begin() + 9, vertices.begin() + 12),
              testing::ElementsAre(65535u, 65535u, 0u));
  const auto corners = Numbers(content["triangles"], 2);
  ASSERT_EQ(corners.size(), 12u * 3);
  EXPECT_THAT(std::vector(corners.begin(), corners.begin() + 3), testing::ElementsAre(0u, 2u, 1u));
}

TEST(ShapeJson, AMeshOfManyVerticesHasWiderNumbers) {
  TriangleMesh mesh = BoxMesh({1, 1, 1});
  const auto width = [&](std::size_t num_vertices) {
    mesh.vertices.resize(num_vertices, Eigen::Vector3d(7, -7, 0));  // of no triangle, and far away
    const SharedMesh shared(mesh);
    Json meshes = Json::object();
    ShapeJson(MeshShape(shared), &meshes);
    const Json& content = meshes[shared.id()];
    EXPECT_EQ(content["size"], Json({1.0, 1.0, 1.0}));
    const auto vertices = Numbers(content["vertices"], 2);
    EXPECT_THAT(std::vector(vertices.end() - 3, vertices.end()),
                testing::ElementsAre(65535u, 0u, 32768u));
    return FromBase64(content["triangles"]).size() / 36;
  };
  EXPECT_EQ(width(65536), 2u);
  EXPECT_EQ(width(65537), 4u);
}

TEST(ShapeJson, WhatIsNoMeshHasNoTrianglesAndWhatIsFlatNoThickness) {
  TriangleMesh mesh{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}}};
  Json meshes = Json::object();
  ShapeJson(MeshShape(mesh), &meshes);
  EXPECT_EQ(meshes.begin().value()["low"], Json({0.0, 0.0, 1.0}));
  EXPECT_EQ(meshes.begin().value()["size"], Json({1.0, 1.0, 0.0}));
  EXPECT_THAT(Numbers(meshes.begin().value()["vertices"], 2),
              testing::ElementsAre(0, 0, 0, 65535, 0, 0, 0, 65535, 0));
  mesh.triangles.push_back({0, 1, 3});
  meshes = Json::object();
  ShapeJson(MeshShape(mesh), &meshes);
  EXPECT_EQ(meshes.begin().value()["triangles"], "");
}

}  // namespace
}  // namespace planbench
