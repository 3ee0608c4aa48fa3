#include "geometry/octomap.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include "common/error.h"

namespace planbench {
namespace {

constexpr int kDepth = 16;  // Of OctoMap's trees: keys are 16 bits a coordinate.

// A box of whole cells, in units of the smallest.
struct Cells {
  std::array<int, 3> lower;
  std::array<int, 3> upper;  // Exclusive.
};

// Walks a tree as OctoMap stores it, depth first, and keeps the occupied leaves. Not by OctoMap's
// own reader, which does not notice where the data ends.
class TreeReader {
 public:
  TreeReader(std::span<const std::uint8_t> data, bool binary) : rest_(data) {
    const int half = 1 << (kDepth - 1);
    const std::array<int, 3> corner = {-half, -half, -half};
    if (binary) {
      ReadBinaryNode(corner, kDepth);
    } else {
      ReadFullNode(corner, kDepth);
    }
    if (!rest_.empty()) {
      throw InputError(fmt::format("octomap: {} bytes are left over after the tree", rest_.size()));
    }
  }

  const std::vector<Cells>& occupied() const { return occupied_; }

 private:
  std::span<const std::uint8_t> Take(std::size_t size) {
    if (rest_.size() < size) throw InputError("octomap: the data is cut off");
    const std::span<const std::uint8_t> taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

  // `level`: a node's edge is 2^level cells.
  static std::array<int, 3> ChildCorner(std::array<int, 3> corner, int level, unsigned child) {
    if (level == 0) throw InputError("octomap: the data is no tree, it is too deep");
    for (unsigned axis = 0; axis < 3; ++axis) {
      if ((child >> axis & 1) != 0) corner[axis] += 1 << (level - 1);
    }
    return corner;
  }

  void AddOccupied(const std::array<int, 3>& corner, int level) {
    Cells cells{corner, corner};
    for (int& bound : cells.upper) bound += 1 << level;
    occupied_.push_back(cells);
  }

  // Two bits a child: unknown, free, occupied, or a node of its own.
  void ReadBinaryNode(const std::array<int, 3>& corner, int level) {
    const std::span<const std::uint8_t> bytes = Take(2);
    const unsigned children = bytes[0] | static_cast<unsigned>(bytes[1]) << 8;
    for (unsigned child = 0; child < 8; ++child) {
      const unsigned kind = children >> (2 * child) & 3;
      if (kind == 2) AddOccupied(ChildCorner(corner, level, child), level - 1);
      if (kind == 3) ReadBinaryNode(ChildCorner(corner, level, child), level - 1);
    }
  }

  // The logarithm of the odds, a bit a child.
  void ReadFullNode(const std::array<int, 3>& corner, int level) {
    static_assert(std::endian::native == std::endian::little, "as ROS messages are");
    const std::span<const std::uint8_t> bytes = Take(5);
    float log_odds = 0;
    std::memcpy(&log_odds, bytes.data(), sizeof(log_odds));
    const unsigned children = bytes[4];
    if (children == 0 && log_odds >= 0) AddOccupied(corner, level);
    for (unsigned child = 0; child < 8; ++child) {
      if ((children >> child & 1) == 0) continue;
      ReadFullNode(ChildCorner(corner, level, child), level - 1);
    }
  }

  std::span<const std::uint8_t> rest_;
  std::vector<Cells> occupied_;
};

// Joins boxes that continue each other along `axis`.
std::vector<Cells> Joined(const std::vector<Cells>& boxes, std::size_t axis) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  std::map<std::array<int, 5>, Cells> by_face;  // Cross-section, then place along the axis.
  for (const Cells& box : boxes) {
    by_face[{box.lower[u], box.upper[u], box.lower[v], box.upper[v], box.lower[axis]}] = box;
  }
  std::vector<Cells> joined;
  for (const auto& [face, box] : by_face) {
    const bool continues =
        !joined.empty() && joined.back().upper[axis] == box.lower[axis] &&
        joined.back().lower[u] == box.lower[u] && joined.back().upper[u] == box.upper[u] &&
        joined.back().lower[v] == box.lower[v] && joined.back().upper[v] == box.upper[v];
    if (continues) {
      joined.back().upper[axis] = box.upper[axis];
    } else {
      joined.push_back(box);
    }
  }
  return joined;
}

}  // namespace

std::vector<PlacedShape> OctomapBoxes(std::span<const std::uint8_t> data, bool binary,
                                      const std::string& id, double resolution) {
  if (id != "OcTree") {
    throw InputError(fmt::format("octomap: the id is '{}'; only 'OcTree' is supported", id));
  }
  if (!(resolution > 0) || !std::isfinite(resolution)) {
    throw InputError(
        fmt::format("octomap: the resolution is {}, must be greater than zero", resolution));
  }
  std::vector<Cells> boxes = TreeReader(data, binary).occupied();
  for (const std::size_t axis : {0u, 1u, 2u}) boxes = Joined(boxes, axis);
  std::vector<PlacedShape> shapes;
  for (const Cells& box : boxes) {
    const Eigen::Vector3d lower(box.lower[0], box.lower[1], box.lower[2]);
    const Eigen::Vector3d upper(box.upper[0], box.upper[1], box.upper[2]);
    PlacedShape shape{Box{resolution * (upper - lower)}, Eigen::Isometry3d::Identity()};
    shape.X_FS.translation() = resolution * (upper + lower) / 2;
    shapes.push_back(shape);
  }
  return shapes;
}

}  // namespace planbench
