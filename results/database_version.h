#pragma once

namespace planbench {

/// PRAGMA user_version of the results databases that are written (docs/database.md).
inline constexpr int kResultsSchemaVersion = 2;

}  // namespace planbench
