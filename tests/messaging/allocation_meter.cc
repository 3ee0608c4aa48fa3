#include "tests/messaging/allocation_meter.h"

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <new>

namespace {

std::size_t in_use = 0;
std::size_t peak = 0;

}  // namespace

// Replace the global ones; the array forms call these. Not inlined: on ARM, GCC 12 would see memory
// of malloc deleted, and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* const memory = std::malloc(std::max<std::size_t>(size, 1));
  if (memory == nullptr) throw std::bad_alloc();
  in_use += malloc_usable_size(memory);
  peak = std::max(peak, in_use);
  return memory;
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void operator delete(void* memory) noexcept {
  if (memory != nullptr) in_use -= malloc_usable_size(memory);
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

namespace planbench {

AllocationMeter::AllocationMeter() : start_(in_use) { peak = in_use; }

std::size_t AllocationMeter::Peak() const { return peak - start_; }

}  // namespace planbench
