#pragma once

#include <string>
#include <vector>

#include "report/compared_pairs.h"

namespace planbench {

/// What the sessions say, in at most three sentences: who comes out best, by how much, and how sure
/// that is; in more, of the best and the next, what of it is no test because it has learned from
/// the set, and that its answers came much later than its times account for.
/// `pairs` as ComparePairs gives them.
std::vector<std::string> Answer(const ComparedSessions& compared,
                                const std::vector<ComparedPair>& pairs);

}  // namespace planbench
