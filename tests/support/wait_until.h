#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

namespace planbench {

/// How long tests wait for what must come. Generous: a test that passes never waits that long,
/// however busy the machine.
inline constexpr std::chrono::seconds kTestPatience{120};

/// Waits until `condition` holds, asking often at first, then every 50 ms; false after
/// kTestPatience.
inline bool WaitUntil(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kTestPatience;
  std::chrono::milliseconds pause{2};
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::milliseconds(50));
  }
  return true;
}

}  // namespace planbench
