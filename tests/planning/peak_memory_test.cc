#include "planning/peak_memory.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>

namespace planbench {
namespace {

constexpr std::size_t kSizeMb = 256;

/// Memory of the process grows by kSizeMb and shrinks again.
void UseAndFree() {
  constexpr std::size_t kSize = kSizeMb << 20;
  void* memory = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  std::memset(memory, 1, kSize);
  munmap(memory, kSize);
}

TEST(PeakMemoryTest, RemembersWhatWasFreedUntilItIsReset) {
  const double before = PeakMemoryMb();
  EXPECT_GT(before, 0);
  UseAndFree();
  const double peak = PeakMemoryMb();
  EXPECT_GE(peak, kSizeMb);
  ResetPeakMemory();
  if (access("/proc/self/clear_refs", W_OK) != 0) GTEST_SKIP() << "this kernel keeps the peak";
  EXPECT_LT(PeakMemoryMb(), peak - kSizeMb / 2.0);
  EXPECT_GT(PeakMemoryMb(), 0);
  UseAndFree();
  EXPECT_GE(PeakMemoryMb(), kSizeMb);
}

}  // namespace
}  // namespace planbench
