#pragma once

#include <chrono>
#include <cstdint>

#if defined(__x86_64__)
#include <cpuid.h>
#include <x86intrin.h>
#endif

namespace planbench {

/// Time in a unit of its own, for what is measured too often for a system clock: on x86-64 the
/// time-stamp counter where it runs evenly (an invariant one), else the steady clock. Ticks are
/// compared with ticks; over an interval taken by both, the steady clock tells what one is worth.
class Ticks {
 public:
  static std::uint64_t Now() {
#if defined(__x86_64__)
    if (kCounterIsInvariant) return __rdtsc();
#endif
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
  }
  /// Those since `begin`.
  static std::uint64_t Since(std::uint64_t begin) {
    const std::uint64_t now = Now();
    return now > begin ? now - begin : 0;
  }

 private:
#if defined(__x86_64__)
  static bool CounterIsInvariant() {
    unsigned int a = 0, b = 0, c = 0, d = 0;
    return __get_cpuid(0x80000007, &a, &b, &c, &d) != 0 && (d >> 8 & 1) != 0;
  }
  static inline const bool kCounterIsInvariant = CounterIsInvariant();
#endif
};

/// Runs from the moment it is made, on the steady clock and in ticks.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  std::uint64_t ticks() const { return Ticks::Since(begin_ticks_); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::uint64_t begin_ticks_ = Ticks::Now();
};

/// Adds the ticks of its own life to a total.
class ScopedTimer {
 public:
  explicit ScopedTimer(std::uint64_t* total) : total_(total) {}
  ~ScopedTimer() { *total_ += Ticks::Since(begin_); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  std::uint64_t* total_;
  std::uint64_t begin_ = Ticks::Now();
};

}  // namespace planbench
