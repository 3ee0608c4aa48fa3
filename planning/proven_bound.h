#pragma once

#include "common/numbers.h"

namespace planbench {

/// How many times the optimum a path costs at most if no path costs less than `lower_bound`; at
/// least 1. Infinity without a path (a cost of infinity) or without a bound (0).
inline double ProvenBound(double cost, double lower_bound) {
  if (cost == kInfinity) return kInfinity;
  return cost <= lower_bound ? 1 : cost / lower_bound;
}

/// The same as results tell it: 0 where nothing is proven.
inline double ToldEpsilon(double cost, double lower_bound) {
  return lower_bound > 0 ? ProvenBound(cost, lower_bound) : 0;
}

}  // namespace planbench
