#pragma once

#include <string>

namespace planbench {

/// The statements that create the tables of results.sqlite (docs/database.md): those of OMPL's
/// benchmark databases, as OMPL's tools and Planner Arena expect them, and our own.
std::string ResultsSchema();

}  // namespace planbench
