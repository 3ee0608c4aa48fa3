#include "geometry/octomap.h"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <Eigen/Core>
#include <random>
#include <sstream>

#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kResolution = 0.05;

Bytes ToBytes(const std::string& text) { return {text.begin(), text.end()}; }

// A tree with solid parts, that prune to larger cells, and scattered ones; some free.
octomap::OcTree RandomTree(std::uint32_t seed) {
  octomap::OcTree tree(kResolution);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int block = 0; block < 3; ++block) {
    const octomap::point3d corner(static_cast<float>(place(random)),
                                  static_cast<float>(place(random)),
                                  static_cast<float>(place(random)));
    for (int i = 0; i < 512; ++i) {
      const Eigen::Vector3i cell(i % 8, i / 8 % 8, i / 64);
      const octomap::point3d offset(static_cast<float>(cell.x()), static_cast<float>(cell.y()),
                                    static_cast<float>(cell.z()));
      tree.updateNode(corner + offset * static_cast<float>(kResolution), true);
    }
  }
  for (int i = 0; i < 400; ++i) {
    tree.updateNode(
        octomap::point3d(static_cast<float>(place(random)), static_cast<float>(place(random)),
                         static_cast<float>(place(random))),
        random() % 2 == 0);
  }
  tree.updateInnerOccupancy();
  return tree;
}

// Whether a point is in one of the boxes; in no two.
bool Inside(const std::vector<PlacedShape>& boxes, const Eigen::Vector3d& p) {
  int count = 0;
  for (const PlacedShape& placed : boxes) {
    const Eigen::Vector3d q = (p - placed.X_FS.translation()).cwiseAbs();
    count += (q.array() < std::get<Box>(placed.shape).size.array() / 2).all() ? 1 : 0;
  }
  EXPECT_LE(count, 1);
  return count > 0;
}

TEST(Octomap, BoxesAreTheOccupiedCells) {
  for (const std::uint32_t seed : {1u, 2u}) {
    octomap::OcTree tree = RandomTree(seed);
    std::ostringstream full;
    tree.writeData(full);
    const auto of_full = OctomapBoxes(ToBytes(full.str()), false, "OcTree", kResolution);
    tree.toMaxLikelihood();  // As the binary form takes it.
    std::ostringstream binary;
    tree.writeBinaryData(binary);
    const auto of_binary = OctomapBoxes(ToBytes(binary.str()), true, "OcTree", kResolution);
    EXPECT_LT(of_full.size(), 700u) << "cells are joined";
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> cell(-24, 24);
    int occupied = 0;
    for (int i = 0; i < 3000; ++i) {
      Eigen::Vector3d p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = (cell(random) + 0.5) * kResolution;
      const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
      const bool expected = node != nullptr && tree.isNodeOccupied(node);
      EXPECT_EQ(Inside(of_full, p), expected) << p.transpose();
      EXPECT_EQ(Inside(of_binary, p), expected) << p.transpose();
      occupied += expected ? 1 : 0;
    }
    EXPECT_GT(occupied, 20);
  }
}

TEST(Octomap, JoinsCells) {
  // Two leaves side by side, below the first child of the root.
  const auto boxes = OctomapBoxes(Bytes{0x0a, 0}, true, "OcTree", 1);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(std::get<Box>(boxes[0].shape).size, Eigen::Vector3d(65536, 32768, 32768));
  EXPECT_EQ(boxes[0].X_FS.translation(), Eigen::Vector3d(0, -16384, -16384));
}

TEST(Octomap, DataThatIsNoTreeIsRefused) {
  const auto read = [](const Bytes& data, bool binary) {
    return [=] { OctomapBoxes(data, binary, "OcTree", 0.1); };
  };
  ExpectInputError(read({}, true), {"cut off"});
  ExpectInputError(read({3, 0}, true), {"cut off"});
  ExpectInputError(read({2, 0, 1}, true), {"1 bytes are left over"});
  ExpectInputError(read({0, 0, 0, 0}, false), {"cut off"});
  ExpectInputError(read(Bytes(1000, 0xff), true), {"too deep"});
  ExpectInputError(read(Bytes(1000, 0xff), false), {"too deep"});
  ExpectInputError([] { OctomapBoxes(Bytes{2, 0}, true, "ColorOcTree", 0.1); }, {"'ColorOcTree'"});
  ExpectInputError([] { OctomapBoxes(Bytes{2, 0}, true, "OcTree", 0); }, {"resolution is 0"});
  EXPECT_TRUE(OctomapBoxes(Bytes{0, 0}, true, "OcTree", 0.1).empty());
}

TEST(Octomap, AnyDataIsATreeOrRefused) {
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    Bytes data(random() % 60);
    for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random() & random());
    try {
      OctomapBoxes(data, i % 2 == 0, "OcTree", 0.1);
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace planbench
