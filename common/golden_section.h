#pragma once

#include <algorithm>
#include <cmath>

namespace planbench {

/// The least value that a convex function of [low, high] takes at its ends and in at most 60 golden
/// sections, which end once `is_enough(low, high)` of what is left.
template <typename Function, typename IsEnough>
double LeastByGoldenSections(double low, double high, const Function& function,
                             const IsEnough& is_enough) {
  const double golden = (std::sqrt(5.0) - 1) / 2;
  double least = std::min(function(low), function(high));
  double a = high - golden * (high - low);
  double b = low + golden * (high - low);
  double at_a = function(a);
  double at_b = function(b);
  for (int i = 0; i < 60 && !is_enough(low, high); ++i) {
    least = std::min({least, at_a, at_b});
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - golden * (high - low);
      at_a = function(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + golden * (high - low);
      at_b = function(b);
    }
  }
  return least;
}

}  // namespace planbench
