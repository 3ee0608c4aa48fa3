#pragma once

#include <vector>

#include "report/compared_pairs.h"
#include "report/table.h"
#include "results/compared_sessions.h"

namespace planbench {

/// What the page draws (report/web/): every number is computed, the page only places it. Sets and
/// contestants are told by their indices in `sets` and `contestants`; times are in ms, numbers
/// rounded to six digits; what does not exist or is not finite is null.
Json FigureData(const ComparedSessions& compared, const std::vector<ComparedPair>& pairs,
                const std::vector<Table>& tables);

}  // namespace planbench
