#pragma once

#include <cstddef>

namespace planbench {

/// Measures the memory that `new` hands out in this program, bytes.
class AllocationMeter {
 public:
  /// Starts from what is in use now.
  AllocationMeter();
  /// The largest amount that was in use at once since then, beyond that.
  std::size_t Peak() const;

 private:
  std::size_t start_;
};

}  // namespace planbench
