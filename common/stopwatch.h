#pragma once

#include <chrono>

namespace planbench {

/// Runs from the moment it is made, on the steady clock.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Adds the seconds of its own life, times `factor`, to a total.
class ScopedTimer {
 public:
  explicit ScopedTimer(double* total_s, double factor = 1) : total_s_(total_s), factor_(factor) {}
  ~ScopedTimer() { *total_s_ += factor_ * stopwatch_.seconds(); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double* total_s_;
  double factor_;
  Stopwatch stopwatch_;
};

}  // namespace planbench
