#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "report/tables.h"
#include "tests/report/example_session.h"
#include "tests/support/temporary_folder.h"

namespace planbench {

/// The example's session, read back from what the logger wrote.
class ReportTest : public testing::Test {
 protected:
  static ComparedSessions Read(const std::vector<MadeRun>& runs) {
    const TemporaryFolder folder;
    WriteSession(folder / "example", runs, ExampleSession());
    return ComparedSessions(ReadSessions(folder / "example").sessions);
  }

  const ComparedSessions compared_ = Read(ExampleRuns());
  const std::vector<ComparedPair> pairs_ = ComparePairs(compared_);

  static std::vector<std::string> Texts(const Table& table, std::size_t row) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      texts.push_back(FormatCell(table.rows.at(row)[i], table.columns[i].style));
    }
    return texts;
  }
  using Row = std::vector<std::string>;
};

}  // namespace planbench
