#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace planbench {

/// A growing array of records of `width` elements of T. Grows by whole chunks and never moves what
/// it holds, so that a search of millions of states neither copies nor doubles its memory when it
/// grows, and bytes() is what it uses.
template <typename T>
class ChunkedArray {
 public:
  explicit ChunkedArray(std::size_t width = 1) : width_(width) {}

  std::size_t size() const { return size_; }
  std::size_t width() const { return width_; }
  /// The first element of record i < size().
  T* Record(std::size_t i) { return &chunks_[i >> kShift][(i & kMask) * width_]; }
  const T* Record(std::size_t i) const { return &chunks_[i >> kShift][(i & kMask) * width_]; }
  T& operator[](std::size_t i) { return *Record(i); }
  const T& operator[](std::size_t i) const { return *Record(i); }

  /// Appends a value-initialised record and returns its first element.
  T* Append() {
    if (size_ == chunks_.size() << kShift) {
      chunks_.push_back(std::make_unique<T[]>(width_ << kShift));
    }
    return Record(size_++);
  }

  std::size_t bytes() const { return (chunks_.size() << kShift) * width_ * sizeof(T); }

 private:
  static constexpr std::size_t kShift = 9;
  static constexpr std::size_t kMask = (std::size_t{1} << kShift) - 1;

  std::size_t width_;
  std::size_t size_ = 0;
  std::vector<std::unique_ptr<T[]>> chunks_;
};

}  // namespace planbench
