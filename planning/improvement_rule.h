#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "planning/plan_result.h"

namespace planbench {

/// Improvements of one request follow one another, and none of them costs more, but for rounding,
/// than what there was before. A cost of 0 is none.
class ImprovementRule {
 public:
  /// Why `next` does not follow those taken before; "" if it does, and is taken.
  std::string Take(const PlanProgress& next) {
    constexpr double kRounding = 1e-9;
    if (next.elapsed_s < elapsed_s_) {
      return fmt::format("elapsed_s falls from {} to {}", elapsed_s_, next.elapsed_s);
    }
    if (next.cost != 0 && cost_ != 0 && next.cost - cost_ > kRounding * std::abs(cost_)) {
      return fmt::format("cost rises from {} to {}", cost_, next.cost);
    }
    elapsed_s_ = next.elapsed_s;
    if (next.cost != 0) cost_ = next.cost;
    return "";
  }

 private:
  double elapsed_s_ = 0;
  double cost_ = 0;
};

}  // namespace planbench
