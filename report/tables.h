#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "report/table.h"
#include "results/compared_sessions.h"
#include "results/comparison.h"

namespace planbench {

/// What stands for all sets together where there are several.
inline constexpr char kAllSets[] = "all sets";

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

/// What is to be said where times are compared that were measured under different limits.
inline constexpr char kLimitsNote[] =
    "The time of a run contains its failed forward attempt, which lasts as long as the time limit "
    "lets it: such times, and ratios of them, are in part of limits.";
/// Different limits of contestants on a set, s, as far as they are known.
std::set<double> LimitsOn(const std::map<std::string, Outcomes>& by_contestant);
/// kLimitsNote with the sets on which contestants had different limits; "" if there are none.
std::string LimitsNote(const ComparedSessions& compared);

/// One contestant against another on one set, or on all.
struct ComparedPair {
  std::string set;
  std::string first;
  std::string second;
  PairedComparison result;
  double adjusted_p = 1;  ///< Holm's, over the pairs of the set.
};
/// All pairs that tried a problem in common, those that rank higher first.
std::vector<ComparedPair> ComparePairs(const ComparedSessions& compared);

Table SuccessTable(const ComparedSessions& compared);
Table TimeTable(const ComparedSessions& compared);
/// Times of the attempts themselves, of contestants that searched backward, too; no rows if there
/// are none.
Table DirectionTable(const ComparedSessions& compared);
Table PairTable(const std::vector<ComparedPair>& pairs);
/// Medians of every path measure, raw and simplified.
Table QualityTable(const ComparedSessions& compared);
Table PhaseTable(const ComparedSessions& compared);
Table FailureTable(const ComparedSessions& compared);
/// Verdicts of the mesh robot and what its meshes touch; no rows if there are none.
Table MeshTable(const ComparedSessions& compared);

/// Names of all tables that there can be (Table::name), with or without rows.
std::vector<std::string> TableNames();

/// All of them and those of the sessions (session_tables.h) that have rows. Columns of their own
/// mark who has learned from the set of a row, or from any if rows are of none (training.h).
std::vector<Table> AllTables(const ComparedSessions& compared,
                             const std::vector<ComparedPair>& pairs);

}  // namespace planbench
