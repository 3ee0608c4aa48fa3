#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace planbench {

/// The values of epsilon an anytime search goes through: initial, initial - decrement, ..., final.
struct EpsilonSchedule {
  double initial = 100;    ///< >= final
  double decrement = 0.5;  ///< > 0
  double final = 1;        ///< >= 1

  /// The next value below both `epsilon` and the bound already proven (values the bound has
  /// overtaken are skipped); nothing once `bound` has reached the final value.
  std::optional<double> Next(double epsilon, double bound) const {
    if (bound <= final || epsilon <= final) return std::nullopt;
    const double below = std::min(epsilon, bound);
    const double steps = std::floor((initial - below) / decrement + 1e-9) + 1;
    double next = initial - steps * decrement;
    if (next >= below) next -= decrement;  // Of many steps the quotient is rounded by more.
    return std::max(final, next);
  }
};

}  // namespace planbench
