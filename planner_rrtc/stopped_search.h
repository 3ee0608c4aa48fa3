#pragma once

#include "planning/search_query.h"
#include "planning/search_result.h"

namespace planbench {

/// What came of a search that ended without a path.
inline SearchResult StoppedSearch(const SearchQuery& query) {
  SearchResult result;
  result.status = query.Cancelled() ? PlanStatus::kCancelled : PlanStatus::kTimedOut;
  result.message = query.Cancelled() ? "cancelled" : "no path was found within the time limit";
  return result;
}

}  // namespace planbench
