#include "geometry/ply_reader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/mesh_loader.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

// A quad and a triangle of four corners.
constexpr const char* kPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
constexpr const char* kPlyBody = "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n4 0 1 2 3\n3 0 2 3\n";
constexpr const char* kPlyObj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1 2 3 4\nf 1 3 4\n";

// What a file has, as an OBJ file has it.
std::string ObjOf(const std::string& ply) {
  const Polygons polygons = ReadPly(ply, "a.ply");
  std::string text;
  for (const Eigen::Vector3d& v : polygons.vertices()) {
    text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  }
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    text += 'f';
    for (const std::uint32_t corner : polygons.corners(i)) text += fmt::format(" {}", corner + 1);
    text += '\n';
  }
  return text;
}

std::string PlyWith(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

template <typename T>
void AppendBytes(std::string* data, T value, bool is_big) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(value));
  if (is_big) std::ranges::reverse(bytes);
  *data += bytes;
}

// Properties in an order of their own, lists and elements that are not read between them.
std::string BinaryPly(bool is_big) {
  std::string data = fmt::format(
      "ply\r\nformat binary_{}_endian 1.0\r\ncomment element face 9\r\nobj_info a b\r\n"
      "element face 2\r\nproperty list ushort double texcoord\r\nproperty char flags\r\n"
      "property list uint8 uint32 vertex_index\r\n"
      "element edge 1\r\nproperty int vertex1\r\n"
      "element vertex 4\r\nproperty short z_\r\nproperty double z\r\nproperty int8 y\r\n"
      "property float32 x\r\nproperty uint quality\r\nend_header\r\n",
      is_big ? "big" : "little");
  const auto append = [&](auto value) { AppendBytes(&data, value, is_big); };
  const std::vector<std::vector<std::uint32_t>> faces = {{0, 1, 2, 3}, {0, 2, 3}};
  for (const auto& face : faces) {
    append(std::uint16_t{1});
    append(0.25);
    append(std::int8_t{10});  // Looks like the end of a line.
    append(static_cast<std::uint8_t>(face.size()));
    for (const std::uint32_t corner : face) append(corner);
  }
  append(std::int32_t{7});
  const std::vector<Eigen::Vector3d> vertices = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0),
                                                 Eigen::Vector3d(1, 1, 0),
                                                 Eigen::Vector3d(0, 1, 0.5)};
  for (const Eigen::Vector3d& vertex : vertices) {
    append(std::int16_t{-3});
    append(vertex.z());
    append(static_cast<std::int8_t>(vertex.y()));
    append(static_cast<float>(vertex.x()));
    append(std::uint32_t{1});
  }
  return data;
}

TEST(ReadPly, ReadsTextAndBytesOfEitherOrder) {
  const std::string plain = std::string(kPlyHeader) + kPlyBody;
  EXPECT_EQ(ObjOf(plain), kPlyObj);
  EXPECT_EQ(ObjOf(BinaryPly(false)), kPlyObj);
  EXPECT_EQ(ObjOf(BinaryPly(true)), kPlyObj);
  for (const std::string end : {"\r", "\r\n", "\n\n", " \n"}) {
    std::string text;
    for (const char c : plain) text += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(ObjOf(text), kPlyObj);
  }
  const std::string points = PlyWith(plain.substr(0, plain.find("4 0")), "face 2", "face 0");
  EXPECT_EQ(ReadPly(points, "a.ply").size(), 0u);
}

TEST(ReadPly, StripsBecomeTrianglesThatFaceOneWay) {
  const std::string strips =
      PlyWith(PlyWith(kPlyHeader, "face 2", "tristrips 1"), "uchar int", "int int") +
      "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n8 0 1 3 2 -1 3 2 1\n";
  EXPECT_EQ(ObjOf(strips), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1 2 4\nf 4 2 3\nf 4 3 2\n");
}

TEST(ReadPly, EveryCutIsTold) {
  for (const std::string& data :
       {std::string(kPlyHeader) + kPlyBody, BinaryPly(false), BinaryPly(true)}) {
    const std::size_t whole = data.size() - (data.ends_with('\n') ? 1 : 0);
    for (std::size_t size = 0; size < whole; ++size) {
      SCOPED_TRACE(size);
      ExpectInputError([&] { ReadPly(data.substr(0, size), "cut.ply"); }, {"cut.ply"});
    }
  }
}

TEST(ReadPly, TheLastLineNeedsNoEndWhereNothingCanBeCutOff) {
  // Eleven vertices: the index 1 may have been 10, which 2 may not.
  const auto ply = [](const std::string& properties, const std::string& last_face) {
    std::string text = PlyWith(kPlyHeader, "vertex 4", "vertex 11");
    text = PlyWith(text, "end_header", properties + "end_header");
    for (int i = 0; i < 11; ++i) text += "0 0 0\n";
    return text + "3 0 1 2 7\n" + last_face;
  };
  const std::string flags = "property uchar flags\n";
  for (const std::string& whole :
       {ply("", "3 1 0 2"), ply("", "3 1 2 0"), ply("", "3 0 2 10"), ply("", "3 0 2 1 "),
        ply(flags, "3 0 2 1 1"), ply(flags, "3 0 2 1 1\n\n ")}) {
    EXPECT_EQ(ObjOf(whole), ObjOf(whole + "\n")) << whole;
  }
  ExpectInputError([&] { ReadPly(ply(flags, "3 0 2 1"), "a.ply"); }, {"a.ply:23: ", "too few"});
  ExpectInputError([&] { ReadPly(ply("", "3 0 2 1"), "a.ply"); },
                   {"a.ply:22: ", "no end", "echo >> FILE"});
}

TEST(ReadPly, SaysWhatIsWrongAndWhere) {
  const std::string plain = std::string(kPlyHeader) + kPlyBody;
  struct Case {
    std::string what;
    std::string by;
    std::vector<std::string> message;
  };
  const std::vector<Case> cases = {
      {"ply", "plx", {"a.ply:1:", "no PLY"}},
      {"ascii", "binary", {"'binary'", "binary_little_endian"}},
      {"vertex 4", "vertex -4", {"a.ply:3:", "a number"}},
      {"vertex 4", "vertex 3", {"a.ply:13: face 1 of 2", "three corners"}},
      {"vertex 4", "vertex 5", {"face 2 of 2", "missing"}},
      {"face 2", "face 3", {"face 3 of 3", "missing", "cut off"}},
      {"face 2", "face 1", {"8 bytes follow"}},
      {"float x", "half x", {"a.ply:4:", "unknown type 'half'"}},
      {"float y", "float v", {"element vertex", "no x, y and z"}},
      {"uchar int", "float int", {"a.ply:8:", "must be an integer"}},
      {"vertex_indices", "corners", {"element face", "vertex_indices"}},
      {"element face", "element vertex", {"a.ply:7:", "one before"}},
      {"end_header", "end", {"a.ply:9:", "'end'"}},
      {"end_header\n", "comment ", {"a.ply:10:", "'1'"}},
      {"1 1 0\n", "1 1\n", {"a.ply:12: vertex 3 of 4", "too few"}},
      {"1 1 0\n", "1 nan 0\n", {"a.ply:12: vertex 3 of 4", "not finite"}},
      {"1 1 0\n", "1 x 0\n", {"a.ply:12: vertex 3 of 4", "'x' is no number"}},
      {"4 0 1 2 3", "4 0 1 2 4", {"a.ply:14: face 1 of 2", "no vertex 4; the file has 4"}},
      {"4 0 1 2 3", "4 0 1 2 -1", {"a.ply:14:", "no vertex -1"}},
      {"4 0 1 2 3", "4 0 1 2 1.5", {"a.ply:14:", "no vertex 1.5"}},
      {"4 0 1 2 3", "2 0 1", {"a.ply:14:", "three corners"}},
      {"4 0 1 2 3", "-4 0 1 2 3", {"a.ply:14:", "-4 is no length"}}};
  for (const auto& [what, by, message] : cases) {
    SCOPED_TRACE(what + " -> " + by);
    const std::string data = PlyWith(plain, what, by);
    ExpectInputError([&] { ReadPly(data, "a.ply"); }, message);
  }
}

TEST(LoadMesh, SplitsConcavePolygonsOfPlyFiles) {
  // An L of 0.75 m2 that a fan from its first corner would leave.
  const TemporaryFolder folder;
  const auto file = folder.Write(
      "l.ply", PlyWith(PlyWith(kPlyHeader, "vertex 4", "vertex 6"), "face 2", "face 1") +
                   "1 0 0\n1 0.5 0\n0.5 0.5 0\n0.5 1 0\n0 1 0\n0 0 0\n6 0 1 2 3 4 5\n");
  const TriangleMesh mesh = LoadMesh(file);
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& corner = mesh.vertices[a];
    area += (mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).norm() / 2;
  }
  EXPECT_NEAR(area, 0.75, 1e-6);
}

}  // namespace
}  // namespace planbench
