#pragma once

#include <chrono>
#include <cstdint>

namespace planbench {

/// us since the Unix epoch: what stands in messages and logs. It can jump; for durations there is
/// the steady clock.
inline std::int64_t NowUtime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace planbench
