#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace planbench {

/// Sets of the numbers from 0 on, each for itself until it is joined to another.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : up_(size) {
    std::iota(up_.begin(), up_.end(), std::size_t{0});
  }

  /// The member that stands for the set of `i`.
  std::size_t Root(std::size_t i) {
    while (up_[i] != i) {
      up_[i] = up_[up_[i]];
      i = up_[i];
    }
    return i;
  }
  /// Makes one set of two, for which the root of `b` stands.
  void Join(std::size_t a, std::size_t b) { up_[Root(a)] = Root(b); }

 private:
  std::vector<std::size_t> up_;
};

}  // namespace planbench
