#pragma once

#include <cstdint>
#include <ctime>

namespace planbench {

/// us since the Unix epoch of a time of day.
inline std::int64_t UtimeOf(const std::timespec& time) {
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000 + time.tv_nsec / 1000;
}

/// us since the Unix epoch: what stands in messages and logs. It can jump; for durations there is
/// the steady clock.
inline std::int64_t NowUtime() {
  std::timespec now{};
  // Not std::chrono::system_clock, whose nanoseconds overflow in the year 2262.
  clock_gettime(CLOCK_REALTIME, &now);
  return UtimeOf(now);
}

}  // namespace planbench
