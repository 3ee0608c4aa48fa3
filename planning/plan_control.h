#pragma once

#include <atomic>
#include <functional>

#include "planning/plan_result.h"

namespace planbench {

/// How a running plan is watched and stopped. Thread-safe.
struct PlanControl {
  std::atomic<bool> cancelled = false;
  /// Called on the solver thread at each improved solution; may be empty.
  std::function<void(const PlanProgress&)> on_progress;
};

}  // namespace planbench
