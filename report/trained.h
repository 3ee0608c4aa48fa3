#pragma once

#include <string>
#include <vector>

#include "report/table.h"
#include "results/compared_sessions.h"

namespace planbench {

/// Whether a contestant has learned from a set that it is tried on (training.h), or of kAllSets
/// from any such.
bool IsTrained(const ComparedSessions& compared, const std::string& set,
               const ComparedContestant& contestant);

/// The sets that it is tried on and has learned from.
std::vector<std::string> SetsLearnedFrom(const ComparedSessions& compared,
                                         const ComparedContestant& contestant);
/// What stands behind its name, or in a column beside it, where all sets are shown together
/// (TrainedMark).
std::string MarkOf(const ComparedSessions& compared, const ComparedContestant& contestant);

/// Columns that say which contestants have learned from the set of their row, or from which sets if
/// it is of none, behind those that name them, if any have. Names stay as they are, for those who
/// join tables by them.
void MarkTrained(const ComparedSessions& compared, Table* table);

}  // namespace planbench
