#pragma once

#include "report/table.h"
#include "results/compared_sessions.h"

namespace planbench {

/// What the sessions were, side by side; `only_different`: where they differ.
Table SessionTable(const ComparedSessions& compared, bool only_different);
/// Contestants of one name in several sessions, each against that of the session begun first.
Table ChangeTable(const ComparedSessions& compared);
/// What the conditions of the measurement leave uncertain.
Table ConditionTable(const ComparedSessions& compared);

}  // namespace planbench
