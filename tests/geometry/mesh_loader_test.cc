#include "geometry/mesh_loader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>

#include "geometry/solid_mesh.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

using Corner = std::array<double, 3>;
using Triangle = std::array<Corner, 3>;

// A box of 1 x 2 x 3 m with its lowest corner at (0, 0, 0), outward triangles.
constexpr double kSize[3] = {1, 2, 3};

TriangleMesh UnevenBoxMesh() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(kSize[0] * (i & 1), kSize[1] * ((i >> 1) & 1),
                               kSize[2] * ((i >> 2) & 1));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// Triangles as a set that order of vertices and triangles does not change, but orientation does.
std::set<Triangle> TriangleSet(const TriangleMesh& mesh) {
  std::set<Triangle> triangles;
  for (const auto& indices : mesh.triangles) {
    Triangle triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d& v = mesh.vertices.at(indices[i]);
      // Rounding to nanometres: files hold single precision.
      for (int k = 0; k < 3; ++k) triangle[i][k] = std::round(v[k] * 1e6) / 1e6 + 0.0;
    }
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
    triangles.insert(triangle);
  }
  return triangles;
}

double Volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  }
  return volume;
}

std::string AsciiStl(const TriangleMesh& mesh) {
  std::string text = "solid box\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const std::uint32_t i : triangle) {
      const Vector3d& v = mesh.vertices[i];
      text += fmt::format("  vertex {:e} {:e} {:e}\n", v.x(), v.y(), v.z());
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid box\n";
}

std::string BinaryStl(const TriangleMesh& mesh) {
  static_assert(std::endian::native == std::endian::little);
  std::string data(80, ' ');
  const auto append = [&data](const auto& value) {
    data.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    append(std::array<float, 3>{0, 0, 0});
    for (const std::uint32_t i : triangle) {
      const Eigen::Vector3f v = mesh.vertices[i].cast<float>();
      append(std::array<float, 3>{v.x(), v.y(), v.z()});
    }
    append(std::uint16_t{0});
  }
  return data;
}

std::string Obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Vector3d& v : mesh.vertices) {
    text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return text;
}

struct DaeOptions {
  double unit = 1;  // m per unit of the file; the vertices are written in it.
  std::string up_axis = "Z_UP";
  std::string transform = {};  // Elements of the node, e.g. "<translate>1 0 0</translate>".
};

std::string Dae(const TriangleMesh& mesh, const DaeOptions& options = {}) {
  std::string positions;
  for (const Vector3d& v : mesh.vertices) {
    positions +=
        fmt::format("{} {} {} ", v.x() / options.unit, v.y() / options.unit, v.z() / options.unit);
  }
  std::string indices;
  for (const auto& [a, b, c] : mesh.triangles) indices += fmt::format("{} {} {} ", a, b, c);
  return fmt::format(R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="u" meter="{0}"/><up_axis>{1}</up_axis></asset>
  <library_geometries><geometry id="box"><mesh>
    <source id="positions">
      <float_array id="values" count="{2}">{3}</float_array>
      <technique_common><accessor source="#values" count="{4}" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common>
    </source>
    <vertices id="vertices"><input semantic="POSITION" source="#positions"/></vertices>
    <triangles count="{5}"><input semantic="VERTEX" source="#vertices" offset="0"/>
      <p>{6}</p>
    </triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="scene">
    <node id="node">{7}<instance_geometry url="#box"/></node>
  </visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
)",
                     options.unit, options.up_axis, 3 * mesh.vertices.size(), positions,
                     mesh.vertices.size(), mesh.triangles.size(), indices, options.transform);
}

std::string Ply(const TriangleMesh& mesh) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  for (const Vector3d& v : mesh.vertices) text += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

class LoadMeshTest : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(LoadMeshTest, EveryFormatGivesTheSameTriangles) {
  const TriangleMesh box = UnevenBoxMesh();
  const std::vector<std::pair<std::string, std::string>> files = {{"ascii.stl", AsciiStl(box)},
                                                                  {"binary.STL", BinaryStl(box)},
                                                                  {"box.obj", Obj(box)},
                                                                  {"box.dae", Dae(box)},
                                                                  {"box.ply", Ply(box)}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = LoadMesh(folder_.Write(name, content));
    EXPECT_EQ(TriangleSet(mesh), TriangleSet(box));
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(mesh.vertices.size(), 8u);  // Joined: STL alone would give 36.
    EXPECT_NEAR(Volume(mesh), 6, 1e-6);
  }
}

TEST_F(LoadMeshTest, LinesAndPointsAreLeftOutWhereOtherTrianglesHaveThem) {
  TriangleMesh mesh = UnevenBoxMesh();
  mesh.vertices.insert(mesh.vertices.end(), {{3, 3, 3}, {3, 3, 4}, {3, 3, 3}, {5, 5, 5}});
  TriangleMesh expected = mesh;
  mesh.triangles.insert(mesh.triangles.end(),
                        {{0, 0, 1}, {2, 1, 1}, {7, 7, 7}, {8, 9, 8}, {9, 9, 10}, {11, 11, 11}});
  expected.triangles.insert(expected.triangles.end(), {{8, 9, 8}, {11, 11, 11}});
  const std::vector<std::pair<std::string, std::string>> files = {{"ascii.stl", AsciiStl(mesh)},
                                                                  {"lines.obj", Obj(mesh)},
                                                                  {"lines.dae", Dae(mesh)},
                                                                  {"lines.ply", Ply(mesh)}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const TriangleMesh loaded = LoadMesh(folder_.Write(name, content));
    EXPECT_EQ(TriangleSet(loaded), TriangleSet(expected));
    EXPECT_EQ(loaded.triangles.size(), expected.triangles.size());
  }
}

TEST_F(LoadMeshTest, SplitsPolygonsIntoTriangles) {
  const TriangleMesh mesh = LoadMesh(
      folder_.Write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\nf 1 2 3 4\n"));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 4u);
}

std::string Replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

TEST_F(LoadMeshTest, ReadsObjFilesAsTheyAreWrittenInTheField) {
  TriangleMesh box = UnevenBoxMesh();
  for (Vector3d& vertex : box.vertices) vertex *= 0.5;
  const std::string plain = Obj(box);
  const std::vector<std::pair<std::string, std::string>> forms = {
      {"no zero before the point", Replaced(plain, "0.5", ".5")},
      {"plus", Replaced(plain, "0.5", "+.5")},
      {"exponent", Replaced(plain, "0.5", "5E-01")},
      {"CRLF", Replaced(plain, "\n", "\r\n")},
      {"CR", Replaced(plain, "\n", "\r")},
      {"mark of UTF-8", "\xef\xbb\xbf" + plain},
      {"tabs", Replaced(plain, " ", "\t")},
      {"spaces at the end", Replaced(plain, "\n", "  \n")},
      {"indented", Replaced(Replaced(plain, "v ", "  v "), "f ", "\tf ")},
      {"comments", Replaced(plain, "\n", " # 1 2 3 C:\\\n")},
      {"continued", Replaced(plain, " ", " \\\n ")},
      {"continued at once", Replaced(plain, " ", "\\\n ")},
      {"folders", "mtllib C:\\a\\\n" + Replaced(plain, "f ", "usemtl C:\\a\\\nf ")},
      {"colours", Replaced(plain, "\nv", " 0.1 0.2 0.3\nv")},
      {"weights of curves", Replaced(plain, "\nv", " 2\nv")},
      {"groups", "mtllib none.mtl\no box\n" + Replaced(plain, "f ", "g a b\nusemtl x\ns off\nf ")}};
  for (const auto& [name, content] : forms) {
    SCOPED_TRACE(name);
    EXPECT_EQ(TriangleSet(LoadMesh(folder_.Write("box.obj", content))), TriangleSet(box));
  }
}

TEST_F(LoadMeshTest, ReadsObjFacesOfEveryForm) {
  const std::string square = "v 0. 0. -0\nv 1. 0 0\nv +1 1e0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
  for (const char* face :
       {"f 1 2 3 4", "f 1/1 2/1 3/1 4/1", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/1/1 3/1/1 4/1/1",
        "f -4 -3 -2 -1", "f -4//-1 -3//-1 -2//-1 4"}) {
    SCOPED_TRACE(face);
    const TriangleMesh mesh = LoadMesh(folder_.Write("square.obj", square + face + "\nl 1 2\n"));
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.vertices.size(), 4u);
  }
  EXPECT_EQ(LoadMesh(folder_.Write("early.obj", "f 1 2 3\n" + square)).triangles.size(), 1u);
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"f 1 2 5", "no vertex 5"}, {"f 0 1 2", "'0'"},         {"f -5 1 2", "'-5'"},
      {"f 1 2 c", "'c'"},         {"f 1 2", "three corners"}, {"v 1 2", "three"},
      {"v 1 x 2", "three"},       {"v 1 nan 2", "finite"}};
  for (const auto& [line, what] : bad) {
    const auto file = folder_.Write("bad.obj", square + line + "\nf 1 2 3\n");
    ExpectInputError([&file] { LoadMesh(file); }, {file.string() + ":7:", what});
  }
}

TEST_F(LoadMeshTest, TakesStlFilesForWhatTheyAreAndNotForWhatTheyCallThemselves) {
  const TriangleMesh box = UnevenBoxMesh();
  const std::string ascii = AsciiStl(box);
  const std::string binary = BinaryStl(box);
  const std::vector<std::pair<std::string, std::string>> forms = {
      {"binary that begins with solid", std::string(binary).replace(0, 5, "solid")},
      {"binary, filled up", std::string(binary).replace(0, 5, "solid") + std::string(7, '\0')},
      {"upper case", Replaced(Replaced(ascii, "vertex", "VERTEX"), "solid", "SOLID")},
      {"spaces before", "\n  " + ascii},
      {"CRLF", Replaced(ascii, "\n", "\r\n")},
      {"mark of UTF-8", "\xef\xbb\xbf" + ascii},
      {"name", Replaced(ascii, "solid box", "solid caf\xe9 facet vertex")},
      {"numbers", Replaced(ascii, "1.000000e+00", "+.1E1")}};
  for (const auto& [name, content] : forms) {
    SCOPED_TRACE(name);
    EXPECT_EQ(TriangleSet(LoadMesh(folder_.Write("box.stl", content))), TriangleSet(box));
  }
}

TEST_F(LoadMeshTest, SaysWhereStlFilesAreCutOff) {
  const std::string ascii = AsciiStl(UnevenBoxMesh());
  const std::string binary = BinaryStl(UnevenBoxMesh());
  const std::vector<std::pair<std::string, std::vector<std::string>>> files = {
      {binary.substr(0, 200), {"12 triangles", "684 bytes", "has 200", "cut off"}},
      {std::string(binary).replace(0, 5, "solid").substr(0, 300), {"684 bytes", "has 300"}},
      {binary + std::string(50, '\1'), {"684 bytes", "has 734", "damaged"}},
      {binary.substr(0, 60), {"is no STL", "60 bytes"}},
      {ascii.substr(0, ascii.find("endloop")), {":7:", "within a facet"}},
      {ascii.substr(0, ascii.find("vertex") + 9), {":4:", "three numbers"}},
      {ascii.substr(0, ascii.find("endsolid")), {"without endsolid"}},
      {ascii.substr(0, ascii.find("endfacet") + 12), {"without endsolid"}},
      {Replaced(ascii, "endloop", "vertex 0 0 0 endloop"), {":8:", "4 corners"}}};
  for (const auto& [content, message] : files) {
    const auto file = folder_.Write("cut.stl", content);
    std::vector<std::string> parts = message;
    parts.push_back(file.string());
    ExpectInputError([&file] { LoadMesh(file); }, parts);
  }
}

TEST_F(LoadMeshTest, Utf16IsToldHowToBecomeUtf8) {
  for (const char* name : {"wide.stl", "wide.obj", "wide.dae"}) {
    std::string wide;
    for (const char c : std::string("solid box")) wide += {c, '\0'};
    const auto file = folder_.Write(name, wide);
    ExpectInputError([&file] { LoadMesh(file); }, {file.string(), "iconv -f UTF-16LE"});
    folder_.Write(name, "\xff\xfe" + wide);
    ExpectInputError([&file] { LoadMesh(file); }, {file.string(), "iconv -f UTF-16 "});
  }
}

TEST_F(LoadMeshTest, AppliesTheUnitOfColladaFilesAndIgnoresTheirUpAxis) {
  const TriangleMesh box = UnevenBoxMesh();
  for (const double unit : {1.0, 0.01, 0.0254}) {
    for (const char* up_axis : {"X_UP", "Y_UP", "Z_UP"}) {
      SCOPED_TRACE(fmt::format("{} {}", unit, up_axis));
      const auto file = folder_.Write("box.dae", Dae(box, {.unit = unit, .up_axis = up_axis}));
      EXPECT_EQ(TriangleSet(LoadMesh(file)), TriangleSet(box));
    }
  }
}

TEST_F(LoadMeshTest, ReadsColladaPolygonsOfEveryKind) {
  const std::string dae = Dae(UnevenBoxMesh());
  const std::size_t begin = dae.find("<triangles");
  const std::size_t end = dae.find("</triangles>") + 12;
  const std::string input = "<input semantic='VERTEX' source='#vertices' offset='0'/>";
  for (const std::string& square :
       {"<polylist count='1'>" + input + "<vcount>4</vcount><p>0 2 3 1</p></polylist>",
        "<polygons count='1'>" + input + "<p>0 2 3 1</p></polygons>",
        "<triangles count='0'>" + input + "<p> </p></triangles><polylist count='2'>" + input +
            "<vcount>3 3</vcount><p>0 2 3 0 3 1</p></polylist>",
        "<lines count='1'>" + input + "<p>4 5</p></lines>" + "<tristrips count='1'>" + input +
            "<p>0 2 1 3</p></tristrips>"}) {
    SCOPED_TRACE(square);
    std::string text = dae;
    text.replace(begin, end - begin, square);
    const TriangleMesh mesh = LoadMesh(folder_.Write("square.dae", text));
    EXPECT_EQ(mesh.triangles.size(), 2u);
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vector3d& corner = mesh.vertices[a];
      area -= (mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).z() / 2;
    }
    EXPECT_NEAR(area, 2, 1e-6);
  }
}

TEST_F(LoadMeshTest, AppliesNodeTransforms) {
  const auto file = folder_.Write(
      "box.dae",
      Dae(UnevenBoxMesh(), {.unit = 0.1,
                            .transform = "<translate>5 0 0</translate>"
                                         "<rotate>0 0 1 90</rotate><scale>2 1 1</scale>"}));
  const TriangleMesh mesh = LoadMesh(file);
  Eigen::AlignedBox3d bounds;
  for (const Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  // Scaled to 2 x 2 x 3, turned about z (x becomes -2..0, y 0..2), moved by 5 units of 0.1 m.
  EXPECT_TRUE(bounds.min().isApprox(Vector3d(-1.5, 0, 0), 1e-6)) << bounds.min().transpose();
  EXPECT_TRUE(bounds.max().isApprox(Vector3d(0.5, 2, 3), 1e-6)) << bounds.max().transpose();
  EXPECT_NEAR(Volume(mesh), 12, 1e-5);
}

TEST_F(LoadMeshTest, ScalesPerAxisAndKeepsSurfacesFacingOutwards) {
  const auto file = folder_.Write("box.stl", BinaryStl(UnevenBoxMesh()));
  const TriangleMesh scaled = LoadMesh(file, Vector3d(0.5, 2, 0.001));
  EXPECT_NEAR(Volume(scaled), 6 * 0.001, 1e-9);
  const TriangleMesh mirrored = LoadMesh(file, Vector3d(-1, 1, 1));
  EXPECT_NEAR(Volume(mirrored), 6, 1e-6);
  Eigen::AlignedBox3d bounds;
  for (const Vector3d& vertex : mirrored.vertices) bounds.extend(vertex);
  EXPECT_TRUE(bounds.min().isApprox(Vector3d(-1, 0, 0), 1e-6));
}

TEST_F(LoadMeshTest, RefusesBadFilesByName) {
  ExpectInputError([&] { LoadMesh(folder_.path() / "none.stl"); }, {"none.stl", "no such"});
  ExpectInputError([&] { LoadMesh(folder_.path()); }, {folder_.path().string(), "no such"});
  const std::vector<std::pair<std::string, std::string>> files = {
      {"empty.stl", ""},
      {"noise.stl", "this is no mesh"},
      {"cut.stl", BinaryStl(UnevenBoxMesh()).substr(0, 200)},
      {"nothing.stl", "solid nothing\nendsolid nothing\n"},
      {"points.obj", "o points\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"},
      {"cut.dae", Dae(UnevenBoxMesh()).substr(0, 700)},
      {"skew.dae", Dae(UnevenBoxMesh(), {.transform = "<skew>45 0 1 0 1 0 0</skew>"})},
      {"unknown.xyz", "0 0 0\n"}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const auto file = folder_.Write(name, content);
    ExpectInputError([&file] { LoadMesh(file); }, {file.string()});
  }
}

TEST_F(LoadMeshTest, PointersOfGitLfsAreToldFromMeshes) {
  for (const char* name : {"pointer.stl", "pointer.dae", "pointer.obj"}) {
    const auto file = folder_.Write(
        name, "version https://git-lfs.github.com/spec/v1\noid sha256:1f\nsize 6284\n");
    ExpectInputError([&file] { LoadMesh(file); }, {file.string(), "Git LFS", "git lfs pull"});
  }
}

TEST_F(LoadMeshTest, RefusesUnitsOfColladaThatAreNone) {
  const std::string dae = Dae(UnevenBoxMesh());
  const auto with_unit = [&](const std::string& meter) {
    std::string text = dae;
    const std::string own = "meter=\"1\"";
    return folder_.Write("unit.dae", text.replace(text.find(own), own.size(), meter));
  };
  for (const std::string bad : {"0", "-1", "cm", ""}) {
    const auto file = with_unit("meter='" + bad + "'");
    ExpectInputError([&file] { LoadMesh(file); },
                     {file.string() + ":3: <unit meter=\"" + bad + "\">", "above 0"});
  }
  EXPECT_NO_THROW(LoadMesh(with_unit("meter='0,1'")));
}

TEST_F(LoadMeshTest, ArchivesOfColladaAreToldFromFiles) {
  const auto file = folder_.Write("box.zae", "PK\3\4");
  ExpectInputError([&file] { LoadMesh(file); }, {file.string(), "unzip", ".dae"});
}

TEST_F(LoadMeshTest, RefusesWhatAssimpTakesAnotherWayInCollada) {
  const std::string dae = Dae(UnevenBoxMesh(), {.transform = "<rotate>0 0 1 90</rotate>"});
  const std::string controller = "<instance_controller url=\"#box\"/>";
  struct Case {
    std::string what;
    std::string by;
    std::vector<std::string> message;
  };
  const std::vector<Case> cases = {
      {"0 0 1 90", "1 1 0 90", {":17: <rotate>", "length 1, and is of 1.414"}},
      {"0 0 1 90", "0 0 2 90", {":17: <rotate>", "length 1, and is of 2"}},
      {"0 0 1 90", "0 0 1", {":17: <rotate>", "four numbers"}},
      {"<rotate>", "<skew>45 0 1 0 1 0 0</skew><rotate>", {":17: <skew>"}},
      {"count=\"24\"", "count=\"21\"", {":6: <float_array count=\"21\">", "24 values"}},
      {"url=\"#box\"", "url=\"#bax\"", {":17: <instance_geometry url=\"#bax\">", "no <geometry>"}},
      {"url=\"#box\"", "url=\"b.dae#box\"", {":17: <instance_geometry url=\"b.dae#box\">"}},
      {"<rotate>", "<instance_node url='#box'/><rotate>", {":17: <instance_node", "no <node>"}},
      {"<rotate>", controller + "<rotate>", {":17: <instance_controller>", "skinned"}},
      {"<rotate>", "<lookat>0 0 1 0 0 0 0 1 0</lookat><rotate>", {":17: <lookat>"}},
      {"<triangles", "<trifans count='1'><p>0 1 2</p></trifans><triangles", {":12: <trifans>"}},
      {"<triangles", "<convex_mesh/><triangles", {":12: <convex_mesh>"}},
      {"<triangles",
       "<triangles count='1'></triangles><triangles",
       {":12: <triangles", "it has 0 <p>"}},
      {"<triangles",
       "<triangles><p>0 1 2</p></triangles><triangles",
       {":12: <triangles", "it has 1 <p>"}},
      {"<triangles",
       "<polygons count='2'><p>0 1 2</p></polygons><triangles",
       {":12: <polygons", "1 <p>"}},
      {"<triangles",
       "<tristrips count='2'><p>0 1 2</p></tristrips><triangles",
       {":12: <tristrips", "1 <p>"}},
      {"<triangles",
       "<polylist count='1'><p>0 1 2</p></polylist><triangles",
       {":12: <p>", "no <vcount>"}},
      {"<triangles",
       "<polygons count='1'><p>0 1 -1</p></polygons><triangles",
       {":12: <p>", "below 0"}}};
  for (const auto& [what, by, message] : cases) {
    SCOPED_TRACE(what + " -> " + by);
    std::string text = dae;
    ASSERT_NE(text.find(what), std::string::npos);
    text.replace(text.find(what), what.size(), by);
    for (const char* name : {"bad.dae", "bad.xml"}) {
      const auto file = folder_.Write(name, text);
      std::vector<std::string> parts = message;
      parts[0] = file.string() + parts[0];
      ExpectInputError([&file] { LoadMesh(file); }, parts);
    }
  }
}

TEST_F(LoadMeshTest, RefusesInstancesWithoutAnEnd) {
  const auto with_node = [&](const std::string& inside, const std::string& after) {
    std::string text = Dae(UnevenBoxMesh());
    const std::string instance = "<instance_geometry";
    text.insert(text.find(instance), "<node id='n0'>" + inside + "</node>" + after);
    return folder_.Write("instances.dae", text);
  };
  const auto itself = with_node("<node><instance_node url='#n0'/></node>", "");
  ExpectInputError([&] { LoadMesh(itself); }, {itself.string(), "<instance_node>", "itself"});
  std::string doubled;
  for (int i = 1; i <= 20; ++i) {
    doubled += fmt::format(
        "<node id='n{0}'><instance_node url='#n{1}'/><instance_node "
        "url='#n{1}'/></node>",
        i, i - 1);
  }
  const auto many = with_node("", doubled);
  ExpectInputError([&] { LoadMesh(many); }, {many.string(), "<instance_node>", "more than"});
  EXPECT_NO_THROW(LoadMesh(with_node("", "<node><instance_node url='#n0'/></node>")));
}

TEST_F(LoadMeshTest, WhatHasNoMeshIsRefused) {
  const std::string dae = Dae(UnevenBoxMesh());
  const std::size_t begin = dae.find("<triangles");
  const std::size_t end = dae.find("</triangles>") + 12;
  const auto file = folder_.Write("none.dae", std::string(dae).erase(begin, end - begin));
  ExpectInputError([&file] { LoadMesh(file); }, {file.string()});
}

// As assimp cuts them, triangles lie beside such polygons or parts of them are left out.
TEST_F(LoadMeshTest, PolygonsWithCornersInARowCloseTheirMesh) {
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 3 2 0\nv 2 2 0\nv 2 1 0\nv 1.5 1 0\nv 1 1 0\n"
      "v 1 2 0\nv 0 2 0\nv 0 1 0\n";
  std::string prism = obj + Replaced(obj, " 0\n", " 1\n");
  std::string bottom = "f";
  std::string top = "f";
  for (int i = 1; i <= 13; ++i) {
    const int next = i % 13 + 1;
    bottom += fmt::format(" {}", 14 - i);
    top += fmt::format(" {}", 13 + i);
    prism += fmt::format("f {} {} {} {}\n", i, next, 13 + next, 13 + i);
  }
  const TriangleMesh mesh = LoadMesh(folder_.Write("comb.obj", prism + bottom + "\n" + top + "\n"));
  const SolidMesh::Survey survey = SolidMesh(mesh).survey();
  EXPECT_EQ(survey.open, 0);
  EXPECT_NEAR(survey.volume, 5, 1e-6);
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d& corner = mesh.vertices[a];
    area += (mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).norm() / 2;
  }
  EXPECT_NEAR(area, 22, 1e-6);
}

TEST_F(LoadMeshTest, KeepsItsDigitsFarFromTheOrigin) {
  TriangleMesh box = UnevenBoxMesh();
  for (Vector3d& vertex : box.vertices) vertex = 0.1 * vertex + Vector3d(500000.3, 5400000.7, 0);
  for (const auto& file :
       {folder_.Write("far.obj", Obj(box)), folder_.Write("far.ply", Ply(box))}) {
    SCOPED_TRACE(file);
    EXPECT_EQ(TriangleSet(LoadMesh(file)), TriangleSet(box));
    TriangleMesh scaled = box;
    for (Vector3d& vertex : scaled.vertices) vertex = vertex.cwiseProduct(Vector3d(1, 2, 3));
    EXPECT_EQ(TriangleSet(LoadMesh(file, Vector3d(1, 2, 3))), TriangleSet(scaled));
  }
  const auto dae = folder_.Write("far.dae", Dae(box));
  ExpectInputError([&dae] { LoadMesh(dae); }, {dae.string(), "5.4e+06 m", "mm only", "OBJ"});
  for (Vector3d& vertex : box.vertices) vertex -= Vector3d(499000, 5400000, 0);
  EXPECT_NO_THROW(LoadMesh(folder_.Write("near.dae", Dae(box))));
}

TEST_F(LoadMeshTest, CommentsOfColladaDoNotCount) {
  const std::string comment =
      "<!-- <unit meter='0'/>\n<skew> --><![CDATA[<instance_controller/>]]>";
  std::string dae = Dae(UnevenBoxMesh(), {.transform = "<rotate>0 0 9 0</rotate>"});
  dae.insert(dae.find("<asset>"), comment);
  EXPECT_EQ(TriangleSet(LoadMesh(folder_.Write("box.dae", dae))), TriangleSet(UnevenBoxMesh()));
  dae.replace(dae.find("meter=\"1\""), 9, "\nmeter = '0'");
  const auto file = folder_.Write("bad.dae", dae);
  ExpectInputError([&file] { LoadMesh(file); }, {file.string() + ":4: <unit meter=\"0\">"});
}

TEST_F(LoadMeshTest, PolygonsForBothSidesLeaveASolidSolid) {
  const std::string box =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
      "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  for (const char* back : {"", "f 7 8 6 5\n", "f 8 6 5 7\n", "f 2 4 3 1\nf 5 6 2 1\n"}) {
    const SolidMesh solid(LoadMesh(folder_.Write("box.obj", box + back)));
    EXPECT_TRUE(solid.Contains({0.3, 0.4, 0.5})) << back;
    EXPECT_FALSE(solid.Contains({0.3, 0.4, 1.5})) << back;
  }
}

TEST_F(LoadMeshTest, RefusesScalesThatFlattenOrAreNoNumbers) {
  const auto file = folder_.Write("box.stl", BinaryStl(UnevenBoxMesh()));
  ExpectInputError([&] { LoadMesh(file, Vector3d(1, 0, 1)); }, {file.string(), "scale"});
  ExpectInputError([&] { LoadMesh(file, Vector3d(1, NAN, 1)); }, {file.string(), "scale"});
}

TEST_F(LoadMeshTest, ReadsTheManufacturersMeshes) {
  PLANBENCH_NEED_SHARED_DATA("fetch_description/meshes");
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SharedData("fetch_description/meshes"))) {
    const TriangleMesh mesh = LoadMesh(entry.path());
    EXPECT_GE(mesh.triangles.size(), 12u) << entry.path();
    for (const Vector3d& vertex : mesh.vertices) EXPECT_LT(vertex.norm(), 2) << entry.path();
    ++count;
  }
  EXPECT_EQ(count, 20);
}

}  // namespace
}  // namespace planbench
