#pragma once

#include <ompl/datastructures/NearestNeighbors.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/stopwatch.h"
#include "planner_rrtc/node_tree.h"
#include "planner_rrtc/ompl_joint_space.h"

namespace planbench {

/// Nearest neighbours for OMPL's planners over an OmplJointSpace, by the vectorised scan of all
/// (NodeTree): in these spaces OMPL's own trees (GNAT) look at most of their nodes, one at a time,
/// through two calls that cannot be inlined. `T` points to something with a `state`. The distance
/// function set is used where several neighbours are asked for.
///
/// Not thread-safe, not even for queries.
template <typename T>
class ScanNeighbors final : public ompl::NearestNeighbors<T> {
 public:
  bool reportsSortedResults() const override { return true; }
  void clear() override {
    if (nodes_) nodes_->Clear();
    items_.clear();
  }
  void add(const T& item) override {
    const OmplJointSpace& space = OmplSpaceOf(item->state);
    if (!nodes_) nodes_.emplace(space.flat_joints(), space.joints());
    nodes_->Add({OmplPositions(item->state), space.flat_joints().size()}, NodeTree::kNoParent);
    items_.push_back(item);
  }
  bool remove(const T& item) override {
    std::vector<T> kept = items_;
    if (std::erase(kept, item) == 0) return false;
    clear();
    for (const T& other : kept) add(other);
    return true;
  }
  T nearest(const T& item) const override {
    const ScopedTimer timer(OmplSpaceOf(item->state).neighbor_ticks());
    const int node = nodes_->Nearest(OmplPositions(item->state)).node;
    return items_[static_cast<std::size_t>(node)];
  }
  void nearestK(const T& item, std::size_t k, std::vector<T>& neighbors) const override {
    neighbors = items_;
    Sort(item, &neighbors);
    neighbors.resize(std::min(k, neighbors.size()));
  }
  void nearestR(const T& item, double radius, std::vector<T>& neighbors) const override {
    neighbors = items_;
    std::erase_if(neighbors, [&](const T& other) { return this->distFun_(other, item) > radius; });
    Sort(item, &neighbors);
  }
  std::size_t size() const override { return items_.size(); }
  void list(std::vector<T>& items) const override { items = items_; }

 private:
  void Sort(const T& item, std::vector<T>* neighbors) const {
    std::stable_sort(neighbors->begin(), neighbors->end(), [&](const T& a, const T& b) {
      return this->distFun_(a, item) < this->distFun_(b, item);
    });
  }

  std::optional<NodeTree> nodes_;
  std::vector<T> items_;
};

}  // namespace planbench
