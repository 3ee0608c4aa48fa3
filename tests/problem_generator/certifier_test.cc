#include "problem_generator/certifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/sqlite.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

/// A run as a session's database has it.
struct RunRow {
  int problem_index;
  int solved;
  const char* referee_valid;
};

/// The certifier with a stand-in for the driver: a script that notes its arguments and gives the
/// results that the test has laid out for the round.
class CertifierTest : public testing::Test {
 protected:
  CertifierTest() {
    std::filesystem::create_directory(options_.sessions);
    WriteDriver("cp \"" + folder_.path().string() + "/$round\" $out/results.sqlite");
  }

  void WriteDriver(const std::string& last) {
    options_.driver = folder_.Write(
        "driver", "#!/bin/sh\necho \"$@\" >> '" + (folder_ / "calls").string() +
                      "'\nwhile [ $# -gt 1 ]; do [ $1 = --out ] && out=$2; shift; done\n"
                      "mkdir $out\nround=$(basename $out)\n" +
                      last + "\n");
    std::filesystem::permissions(options_.driver, std::filesystem::perms::owner_all);
  }
  void WriteResults(int round, const std::vector<RunRow>& runs) {
    SqliteConnection results(folder_ / ("round_" + std::to_string(round)),
                             SqliteConnection::Mode::kReadWriteCreate);
    results.Execute("CREATE TABLE runs (problem_index INTEGER, solved, referee_valid)");
    results.Execute("BEGIN");
    for (const RunRow& run : runs) {
      results.Execute("INSERT INTO runs VALUES (" + std::to_string(run.problem_index) + ", " +
                      std::to_string(run.solved) + ", " + run.referee_valid + ")");
    }
    results.Execute("COMMIT");
  }
  Certification Certify(std::vector<int> indices) {
    return CertifyProblemSet("a/set", std::move(indices), options_,
                             [this](const std::vector<int>& replaced, int attempt) {
                               replacements_.emplace_back(replaced, attempt);
                             });
  }
  /// The arguments of each call of the driver.
  std::vector<std::string> Calls() const {
    std::ifstream file(folder_ / "calls");
    std::vector<std::string> calls;
    for (std::string line; std::getline(file, line);) calls.push_back(line);
    return calls;
  }
  void ExpectFailure(const std::string& text) {
    try {
      Certify({1});
      ADD_FAILURE() << "certified";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(text));
    }
  }

  TemporaryFolder folder_;
  CertifierOptions options_{.driver = "",
                            .robot = "a/robot",
                            .sessions = folder_ / "sessions",
                            .time_limit_s = 7.5,
                            .max_rounds = 3};
  std::vector<std::pair<std::vector<int>, int>> replacements_;
};

TEST_F(CertifierTest, WhatAnyPlannerSolvesInAnyDirectionStays) {
  WriteResults(1, {{1, 1, "1"}, {1, 0, "NULL"}, {2, 0, "NULL"}, {2, 1, "1"}});
  const Certification certification = Certify({1, 2});
  EXPECT_EQ(certification.num_rounds, 1);
  EXPECT_THAT(certification.unsolved, IsEmpty());
  EXPECT_THAT(certification.replaced, IsEmpty());
  EXPECT_THAT(replacements_, IsEmpty());
  ASSERT_EQ(Calls().size(), 1u);
  EXPECT_THAT(Calls()[0],
              HasSubstr("--launch --robot a/robot --problems a/set --problems-range 1-2 "
                        "--directions both --time 7.5 "));
}

TEST_F(CertifierTest, WhatNobodySolvesIsReplacedUntilItIsSolved) {
  WriteResults(1, {{1, 1, "1"}, {2, 0, "NULL"}, {3, 0, "NULL"}, {3, 0, "NULL"}});
  WriteResults(2, {{2, 1, "1"}, {3, 0, "NULL"}});
  WriteResults(3, {{3, 1, "1"}});
  const Certification certification = Certify({1, 2, 3});
  EXPECT_EQ(certification.num_rounds, 3);
  EXPECT_THAT(certification.unsolved, IsEmpty());
  EXPECT_THAT(certification.replaced, ElementsAre(Pair(2, 1), Pair(3, 2)));
  EXPECT_THAT(replacements_, ElementsAre(Pair(ElementsAre(2, 3), 1), Pair(ElementsAre(3), 2)));
  const auto calls = Calls();
  ASSERT_EQ(calls.size(), 3u);
  EXPECT_THAT(calls[1], HasSubstr("--problems-range 2-3 "));
  EXPECT_THAT(calls[2], HasSubstr("--problems-range 3 "));
}

TEST_F(CertifierTest, ManyProblemsFitIntoOneArgument) {
  std::vector<int> indices(30'000);
  std::iota(indices.begin(), indices.end(), 1);
  std::vector<RunRow> runs;
  for (const int index : indices) runs.push_back({index, index != 7 && index != 9, "1"});
  WriteResults(1, runs);
  WriteResults(2, {{7, 1, "1"}, {9, 1, "1"}});
  EXPECT_THAT(Certify(indices).replaced, ElementsAre(Pair(7, 1), Pair(9, 1)));
  EXPECT_THAT(Calls(), ElementsAre(HasSubstr("--problems-range 1-30000 "),
                                   HasSubstr("--problems-range 7,9 ")));
}

TEST_F(CertifierTest, APathThatTheRefereeDidNotFindValidIsNone) {
  options_.max_rounds = 1;
  WriteResults(1, {{1, 1, "0"}, {2, 1, "NULL"}, {3, 1, "1"}});
  EXPECT_THAT(Certify({1, 2, 3}).unsolved, ElementsAre(1, 2));
}

TEST_F(CertifierTest, TheRoundsAreNotEndless) {
  for (int round = 1; round <= 3; ++round) WriteResults(round, {{4, 0, "NULL"}});
  const Certification certification = Certify({4});
  EXPECT_EQ(certification.num_rounds, 3);
  EXPECT_THAT(certification.unsolved, ElementsAre(4));
  // What is left is what the last round has tried.
  EXPECT_THAT(certification.replaced, ElementsAre(Pair(4, 2)));
  EXPECT_EQ(Calls().size(), 3u);
}

TEST_F(CertifierTest, AProblemThatWasNotTriedIsNoSuccess) {
  WriteResults(1, {{2, 1, "1"}});
  ExpectFailure("problem 1");
}

TEST_F(CertifierTest, FailuresOfTheDriverAreTold) {
  WriteDriver("exit 2");
  ExpectFailure("exit code 2");
  WriteDriver("kill -KILL $$");
  ExpectFailure("exit code 137");
  WriteDriver("true");
  ExpectFailure("results.sqlite");
  options_.driver = folder_ / "missing";
  ExpectFailure("cannot be started");
}

}  // namespace
}  // namespace planbench
