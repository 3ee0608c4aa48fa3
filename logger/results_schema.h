#pragma once

#include <string>

namespace planbench {

/// PRAGMA user_version of the databases this program writes.
inline constexpr int kResultsSchemaVersion = 2;

/// The statements that create the tables of results.sqlite (docs/database.md): those of OMPL's
/// benchmark databases, as OMPL's tools and Planner Arena expect them, and our own.
std::string ResultsSchema();

}  // namespace planbench
