#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "report/compared_pairs.h"
#include "report/table.h"
#include "results/compared_sessions.h"

namespace planbench {

/// What is to be said where times are compared that were measured under different limits.
inline constexpr char kLimitsNote[] =
    "The time of a run contains its failed forward attempt, which lasts as long as the time limit "
    "lets it: such times, and ratios of them, are in part of limits.";
/// Different limits of contestants on a set, s, as far as they are known.
std::set<double> LimitsOn(const std::map<std::string, Outcomes>& by_contestant);
/// kLimitsNote with the sets on which contestants had different limits; "" if there are none.
std::string LimitsNote(const ComparedSessions& compared);

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
