#include "geometry/stl_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "common/error.h"
#include "common/text.h"
#include "geometry/text_words.h"

namespace planbench {
namespace {

using Eigen::Vector3d;
using Triangles = std::vector<std::array<Vector3d, 3>>;

constexpr std::size_t kHeaderSize = 84;  // Text of 80 bytes, then the number of triangles.
constexpr std::size_t kTriangleSize = 50;

std::uint32_t NumTriangles(std::string_view data) {
  std::uint32_t count = 0;
  std::memcpy(&count, data.data() + kHeaderSize - sizeof(count), sizeof(count));
  return count;
}

std::size_t BinarySize(std::string_view data) {
  return kHeaderSize + kTriangleSize * NumTriangles(data);
}

bool IsAscii(std::string_view data) {
  const std::size_t begin = data.find_first_not_of(" \t\r\n");
  return begin != std::string_view::npos && LowerCase(data.substr(begin, 5)) == "solid" &&
         data.find('\0') == std::string_view::npos;
}

Triangles ReadBinary(std::string_view data) {
  Triangles triangles(NumTriangles(data));
  const char* at = data.data() + kHeaderSize + 3 * sizeof(float);  // Behind the normal.
  for (auto& corners : triangles) {
    std::array<std::array<float, 3>, 3> values;
    std::memcpy(values.data(), at, sizeof(values));
    for (std::size_t i = 0; i < 3; ++i) corners[i] = {values[i][0], values[i][1], values[i][2]};
    at += kTriangleSize;
  }
  return triangles;
}

class AsciiReader {
 public:
  AsciiReader(std::string_view text, const std::string& file) : lines_(text), file_(file) {
    while (const auto line = lines_.Next()) ReadLine(*line);
    if (within_facet_) Fail("the file ends within a facet; it is cut off");
    // Where facets are lost a planner would go through what they were of.
    if (!ended_) Fail("the file ends without endsolid; it may be cut off (add it if it is whole)");
  }

  Triangles Take() { return std::move(triangles_); }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, lines_.number(), what));
  }

  void ReadLine(std::string_view line) {
    while (true) {
      const std::string word = LowerCase(TakeWord(&line));
      if (word.empty()) return;
      ended_ = word == "endsolid";
      if (ended_ || word == "solid") return;  // A name follows.
      if (word == "facet") {
        if (within_facet_) Fail("facet: the one before has no endfacet");
        within_facet_ = true;
        num_corners_ = 0;
      } else if (word == "vertex") {
        ReadVertex(&line);
      } else if (word == "endfacet") {
        EndFacet();
      }
    }
  }

  void ReadVertex(std::string_view* line) {
    Vector3d vertex;
    for (double& value : vertex) {
      const auto number = ParseNumber(TakeWord(line));
      if (!number) Fail("vertex: expected three numbers");
      // Single precision as binary files have it, in which corners that differ by rounding meet.
      value = static_cast<float>(*number);
    }
    if (num_corners_ < corners_.size()) corners_[num_corners_] = vertex;
    ++num_corners_;
  }

  void EndFacet() {
    if (!within_facet_ || num_corners_ != corners_.size()) {
      Fail(fmt::format("endfacet: the facet has {} corners; expected three", num_corners_));
    }
    triangles_.push_back(corners_);
    within_facet_ = false;
    num_corners_ = 0;
  }

  TextLines lines_;
  const std::string& file_;
  Triangles triangles_;
  std::array<Vector3d, 3> corners_;
  std::size_t num_corners_ = 0;  // Of the facet so far.
  bool within_facet_ = false;
  bool ended_ = false;  // By endsolid, which nothing has followed.
};

[[noreturn]] void RefuseSize(std::string_view data, const std::string& file) {
  RefuseUtf16(data, file);
  if (data.size() < kHeaderSize) {
    throw InputError(
        fmt::format("{}: is no STL: it does not begin with \"solid\", and its {} bytes are fewer "
                    "than the {} of a binary file's header",
                    file, data.size(), kHeaderSize));
  }
  throw InputError(fmt::format(
      "{}: the {} triangles that its header tells take {} bytes, but the file has {}; it is {}",
      file, NumTriangles(data), BinarySize(data), data.size(),
      data.size() < BinarySize(data) ? "cut off, or no STL" : "damaged, or no STL"));
}

}  // namespace

Triangles ReadStl(std::string_view data, const std::string& file) {
  const bool has_header = data.size() >= kHeaderSize;
  if (has_header && data.size() == BinarySize(data)) return ReadBinary(data);
  if (data.starts_with("\xef\xbb\xbf")) data.remove_prefix(3);  // The mark of UTF-8.
  if (IsAscii(data)) return AsciiReader(data, file).Take();
  // Some writers fill up a file's end, by less than a triangle.
  const bool is_filled = has_header && data.size() > BinarySize(data) &&
                         data.size() < BinarySize(data) + kTriangleSize;
  if (!is_filled) RefuseSize(data, file);
  return ReadBinary(data);
}

}  // namespace planbench
