#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "planner_ara/chunked_array.h"

namespace planbench {

/// Dense identifier of a search state, counted from 0.
using StateId = std::uint32_t;

/// A 4-ary min-heap of states with keys that can be changed. Ties are broken by the smaller `tie`
/// value, then by the larger (newer) id, so that the order never depends on the history of the
/// heap.
class StateHeap {
 public:
  struct Entry {
    double key;
    float tie;
    StateId state;
  };

  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  const Entry& top() const { return entries_.front(); }
  std::span<const Entry> entries() const { return entries_; }
  bool Contains(StateId state) const {
    return state < positions_.size() && positions_[state] != kAbsent;
  }

  /// Inserts a state, or changes the key of one it holds, up or down.
  void Set(StateId state, double key, float tie) {
    while (positions_.size() <= state) *positions_.Append() = kAbsent;
    const Entry entry{key, tie, state};
    std::uint32_t position = positions_[state];
    if (position == kAbsent) {
      position = static_cast<std::uint32_t>(entries_.size());
      entries_.push_back(entry);
      SiftUp(position, entry);
    } else if (Before(entry, entries_[position])) {
      SiftUp(position, entry);
    } else {
      SiftDown(position, entry);
    }
  }

  StateId Pop() {
    const StateId state = entries_.front().state;
    positions_[state] = kAbsent;
    const Entry last = entries_.back();
    entries_.pop_back();
    if (!entries_.empty()) SiftDown(0, last);
    return state;
  }

  /// Replaces the content in linear time. States must be distinct.
  void Assign(std::vector<Entry> entries) {
    for (const Entry& entry : entries_) positions_[entry.state] = kAbsent;
    entries_ = std::move(entries);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      while (positions_.size() <= entries_[i].state) *positions_.Append() = kAbsent;
      positions_[entries_[i].state] = static_cast<std::uint32_t>(i);
    }
    for (std::size_t i = entries_.size(); i-- > 0;) SiftDown(i, entries_[i]);
  }

  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry) + positions_.bytes(); }

 private:
  static constexpr std::size_t kArity = 4;
  static constexpr std::uint32_t kAbsent = std::numeric_limits<std::uint32_t>::max();

  static bool Before(const Entry& a, const Entry& b) {
    if (a.key != b.key) return a.key < b.key;
    if (a.tie != b.tie) return a.tie < b.tie;
    return a.state > b.state;
  }
  void Place(std::size_t position, const Entry& entry) {
    entries_[position] = entry;
    positions_[entry.state] = static_cast<std::uint32_t>(position);
  }
  void SiftUp(std::size_t position, const Entry entry) {
    while (position > 0) {
      const std::size_t parent = (position - 1) / kArity;
      if (!Before(entry, entries_[parent])) break;
      Place(position, entries_[parent]);
      position = parent;
    }
    Place(position, entry);
  }
  void SiftDown(std::size_t position, const Entry entry) {
    for (;;) {
      const std::size_t first = position * kArity + 1;
      if (first >= entries_.size()) break;
      const std::size_t last = first + kArity < entries_.size() ? first + kArity : entries_.size();
      std::size_t best = first;
      for (std::size_t child = first + 1; child < last; ++child) {
        if (Before(entries_[child], entries_[best])) best = child;
      }
      if (!Before(entries_[best], entry)) break;
      Place(position, entries_[best]);
      position = best;
    }
    Place(position, entry);
  }

  std::vector<Entry> entries_;
  ChunkedArray<std::uint32_t> positions_;  // by state
};

}  // namespace planbench
