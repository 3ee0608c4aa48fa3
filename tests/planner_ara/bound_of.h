#pragma once

#include "planning/proven_bound.h"

namespace planbench {

/// How many times the optimum the best path of an AraStar or a TwoWaySearch is proven to cost at
/// most.
template <typename Search>
double BoundOf(Search& search) {
  return ProvenBound(search.best_cost(), search.ProveLowerBound());
}

}  // namespace planbench
