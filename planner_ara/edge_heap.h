#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace planbench {

/// Dense identifier of a search state, counted from 0.
using StateId = std::uint32_t;

/// Passes over all of OPEN ask whether to stop after so many entries.
inline constexpr std::int64_t kStepsBetweenStops = 4096;

/// What EdgeHeap multiplies by epsilon.
enum class EdgeOrder {
  kHeuristic,  ///< h, as ARA* does.
  kGuide,      ///< The graph's guide, which proves nothing.
};

/// A 4-ary min-heap of candidate edges by g + epsilon h (or guide), where g is the cost of the
/// edge's target by way of its source and h the heuristic of the target. Keys are not stored, so
/// that a new epsilon only needs the order restored. Equal keys go by smaller h, then newer source,
/// then smaller action: the order never depends on history.
class EdgeHeap {
 public:
  struct Entry {
    double g = 0;
    double h = 0;
    float guide = 0;
    StateId source = 0;
    std::uint16_t action = 0;
  };

  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  const Entry& top() const { return entries_.front(); }
  double top_key() const { return Key(top()); }
  std::span<const Entry> entries() const { return entries_; }

  void Push(const Entry& entry) {
    entries_.push_back(entry);
    std::size_t position = entries_.size() - 1;
    while (position > 0) {
      const std::size_t parent = (position - 1) / kArity;
      if (!Before(entry, entries_[parent])) break;
      entries_[position] = entries_[parent];
      position = parent;
    }
    entries_[position] = entry;
  }

  void Clear() { entries_.clear(); }

  Entry Pop() {
    const Entry first = entries_.front();
    const Entry last = entries_.back();
    entries_.pop_back();
    if (!entries_.empty()) SiftDown(0, last);
    return first;
  }

  /// Sets epsilon and order, takes in `more`, keeps only entries that `keep` accepts, and orders
  /// the rest; linear time. False if `should_stop` said so, which is asked now and then: all
  /// entries are there then, but without order, and the heap has to be rebuilt before it is used
  /// again.
  template <typename Predicate, std::predicate StopFunction>
  bool Rebuild(double epsilon, EdgeOrder order, std::span<const Entry> more, Predicate keep,
               StopFunction&& should_stop) {
    epsilon_ = epsilon;
    by_guide_ = order == EdgeOrder::kGuide;
    entries_.insert(entries_.end(), more.begin(), more.end());
    std::int64_t steps = 0;
    const auto must_stop = [&] { return ++steps % kStepsBetweenStops == 0 && should_stop(); };
    for (std::size_t i = 0; i < entries_.size();) {
      if (must_stop()) return false;
      if (keep(entries_[i])) {
        ++i;
      } else {
        entries_[i] = entries_.back();
        entries_.pop_back();
      }
    }
    for (std::size_t i = entries_.size(); i-- > 0;) {
      if (must_stop()) return false;
      SiftDown(i, Entry(entries_[i]));
    }
    return true;
  }

  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

 private:
  static constexpr std::size_t kArity = 4;

  double Key(const Entry& entry) const {
    return entry.g + epsilon_ * (by_guide_ ? static_cast<double>(entry.guide) : entry.h);
  }
  bool Before(const Entry& a, const Entry& b) const {
    const double key_a = Key(a);
    const double key_b = Key(b);
    if (key_a != key_b) return key_a < key_b;
    if (a.h != b.h) return a.h < b.h;
    if (a.source != b.source) return a.source > b.source;
    return a.action < b.action;
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
      entries_[position] = entries_[best];
      position = best;
    }
    entries_[position] = entry;
  }

  double epsilon_ = 1;
  bool by_guide_ = false;
  std::vector<Entry> entries_;
};

}  // namespace planbench
