#include "planner_rrtc/node_tree.h"

#include <utility>

#include "planner_rrtc/nearest_scan.h"

namespace planbench {
namespace {

/// Coordinate of places in the last block that no node has yet: far from everything, its square
/// finite.
constexpr float kNowhere = 1e15f;

}  // namespace

NodeTree::NodeTree(FlatJoints flat, const JointSpace& space) : flat_(std::move(flat)) {
  for (const bool continuous : {false, true}) {
    for (int j = 0; j < space.size(); ++j) {
      if (space.joint(j).continuous == continuous) order_.push_back(static_cast<std::size_t>(j));
    }
    if (!continuous) num_bounded_ = order_.size();
  }
  query_.resize(order_.size());
}

void NodeTree::Clear() {
  positions_.clear();
  parents_.clear();
  blocks_.clear();
}

int NodeTree::Add(std::span<const double> q, int parent) {
  const int node = size();
  const std::size_t place = static_cast<std::size_t>(node) % kScanBlock;
  const std::size_t block_size = order_.size() * kScanBlock;
  if (place == 0) blocks_.resize(blocks_.size() + block_size, kNowhere);
  float* x = blocks_.data() + blocks_.size() - block_size + place;
  for (const std::size_t j : order_) {
    *x = static_cast<float>(q[j]);
    x += kScanBlock;
  }
  positions_.insert(positions_.end(), q.begin(), q.end());
  parents_.push_back(parent);
  return node;
}

NodeTree::Neighbor NodeTree::Nearest(const double* q) const {
  const std::size_t n = order_.size();
  for (std::size_t j = 0; j < n; ++j) query_[j] = static_cast<float>(q[order_[j]]);
  const ScanPoints points{blocks_.data(), blocks_.size() / (n * kScanBlock), num_bounded_,
                          n - num_bounded_, flat_.metric()};
  const int node = ScanForNearest(points, query_.data()).point;
  return {node, flat_.Distance(Positions(node), q)};
}

}  // namespace planbench
