#pragma once

#include <map>
#include <string>

#include "results/compared_sessions.h"

namespace planbench {

/// That some of what a contestant is tried on is what it has learned from; "" if none is.
std::string DescribeTraining(const ComparedSessions& compared,
                             const ComparedContestant& contestant);

/// DescribeUntoldTimes of each session, by contestant.
std::map<std::string, std::string> UntoldTimes(const ComparedSessions& compared);

/// DescribeDisputedEnds, by contestant.
std::map<std::string, std::string> DisputedEnds(const ComparedSessions& compared);

}  // namespace planbench
