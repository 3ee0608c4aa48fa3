#include "sphere_fitting/hole_filling.h"

#include <gtest/gtest.h>

#include "geometry/solid_mesh.h"
#include "tests/support/generated_meshes.h"

namespace planbench {
namespace {

TEST(FillSmallHoles, ClosesWhatAnExportLeftOut) {
  TriangleMesh mesh = Joined(TorusMesh(1, 0.3, 40, 30), SphereMesh(0.2, 20, 10), {3, 0, 0});
  const TriangleMesh whole = mesh;
  mesh.triangles.erase(mesh.triangles.begin() + 700, mesh.triangles.begin() + 702);
  mesh.triangles.erase(mesh.triangles.begin() + 100);
  ASSERT_EQ(SolidMesh(mesh).survey().open, 1);
  EXPECT_EQ(FillSmallHoles(&mesh), 2);
  EXPECT_EQ(mesh.triangles.size(), whole.triangles.size());
  const SolidMesh::Survey survey = SolidMesh(mesh).survey();
  EXPECT_EQ(survey.components, 2);
  EXPECT_EQ(survey.open, 0);
  EXPECT_EQ(survey.not_oriented, 0);
  EXPECT_NEAR(survey.volume, SolidMesh(whole).survey().volume, 1e-4);
}

TEST(FillSmallHoles, LeavesWhatIsOpenAndWhatIsClosed) {
  TriangleMesh sheet = SheetMesh(0.3, 0.5, 20, 5);
  const std::size_t triangles = sheet.triangles.size();
  EXPECT_EQ(FillSmallHoles(&sheet), 0);
  EXPECT_EQ(sheet.triangles.size(), triangles);
  TriangleMesh sphere = SphereMesh(0.3, 20, 10);
  EXPECT_EQ(FillSmallHoles(&sphere), 0);
  // A point, a line and a sliver are no holes.
  sphere.vertices.push_back(3 * sphere.vertices[0] - 2 * sphere.vertices[1]);
  const auto last = static_cast<std::uint32_t>(sphere.vertices.size() - 1);
  sphere.triangles.insert(sphere.triangles.end(), {{0, 0, 0}, {0, last, 0}, {0, 1, last}});
  EXPECT_EQ(FillSmallHoles(&sphere), 0);
}

}  // namespace
}  // namespace planbench
