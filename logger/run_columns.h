#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/sqlite.h"
#include "messaging/messages.h"

namespace planbench {

/// A column of table `runs`, besides id, experimentid and plannerid. docs/database.md defines each.
struct RunColumn {
  std::string name;
  /// REAL, INTEGER, TEXT, or what OMPL's tools know as BOOLEAN and ENUM.
  const char* type;
  /// What a record has to say; NULL where it says nothing.
  std::function<SqliteValue(const RunRecordMessage&)> value;
};

/// All of them, in the order of the table.
const std::vector<RunColumn>& RunColumns();

}  // namespace planbench
