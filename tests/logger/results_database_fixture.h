#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "logger/results_database.h"
#include "tests/support/temporary_folder.h"

namespace planbench {

inline const SqliteValue kNull;

inline SqliteValue Int(std::int64_t value) { return value; }

class ResultsDatabaseTest : public testing::Test {
 protected:
  ResultsDatabaseTest() : file_(folder_ / "results.sqlite"), database_(file_) {}

  SqliteValue Query(const std::string& sql) {
    return SqliteConnection(file_, SqliteConnection::Mode::kReadOnly).QueryValue(sql);
  }
  SqliteValue Run(const std::string& column, const std::string& request_id = "request-1") {
    return Query("SELECT " + column + " FROM runs WHERE request_id = '" + request_id + "'");
  }
  SqliteValue Count(const std::string& table) { return Query("SELECT count(*) FROM " + table); }

  TemporaryFolder folder_;
  std::filesystem::path file_;
  ResultsDatabase database_;
};

}  // namespace planbench
