#pragma once

#include <string>

#include "common/sqlite.h"

namespace planbench {

/// The statements that create the tables of results.sqlite (docs/database.md): those of OMPL's
/// benchmark databases, as OMPL's tools and Planner Arena expect them, and our own.
std::string ResultsSchema();

/// Databases of before had room for one entry of `progress` a time: takes that key away.
void KeepEveryProgressEntry(SqliteConnection* connection);

}  // namespace planbench
