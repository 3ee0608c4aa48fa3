#include "results/imported_results.h"

#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

class ImportedCsvTest : public testing::Test {
 protected:
  std::vector<StoredRun> Read(const std::string& text) {
    folder_.Write("r.csv", text);
    return Import("r.csv", "published").runs;
  }
  StoredSession Import(const std::string& file, const std::string& name) {
    StoredSession session = ImportResults(folder_ / file, name, 60, &warnings_);
    EXPECT_EQ(session.contestants.at(0).name, name);
    EXPECT_TRUE(session.imported);
    return session;
  }
  void ExpectRefused(const std::string& text, const std::vector<std::string>& parts) {
    ExpectInputError([&] { Read(text); }, parts);
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(ImportedCsvTest, ReadsWhatIsThere) {
  const auto runs = Read(
      "problem_set,query_index,solved,time_s,waypoints\r\nbox,0,1,2.25,9\r\n\r\nbox,1,0,60,0\r\n");
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].problem_set, "box");
  EXPECT_EQ(runs[0].problem_index, 1);
  EXPECT_EQ(runs[0].status, PlanStatus::kSolved);
  EXPECT_TRUE(runs[0].claimed);
  EXPECT_EQ(runs[0].time_s, 2.25);
  EXPECT_EQ(runs[0].time_limit_s, 60);
  EXPECT_EQ(runs[0].direction, Direction::kForward);
  EXPECT_EQ(runs[0].trial, 1);
  EXPECT_EQ(runs[1].status, PlanStatus::kTimedOut);
  EXPECT_FALSE(runs[1].claimed);
}

TEST_F(ImportedCsvTest, OptionalColumnsCount) {
  const auto runs = Read(
      "trial,direction,time_limit_s,problem_set,problem_index,solved,time_s\n"
      "3,backward,10,cage,7,1,0.5\n");
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].trial, 3);
  EXPECT_EQ(runs[0].direction, Direction::kBackward);
  EXPECT_EQ(runs[0].time_limit_s, 10);
  EXPECT_EQ(runs[0].problem_index, 7);
}

TEST_F(ImportedCsvTest, RowsOfAProblemAreItsTrials) {
  const auto runs =
      Read("problem_set,problem_index,solved,time_s\nbox,1,1,0.5\nbox,2,1,1\nbox,1,1,0.7\n");
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].trial, 1);
  EXPECT_EQ(runs[1].trial, 1);
  EXPECT_EQ(runs[2].trial, 2);
  ExpectRefused("problem_set,problem_index,trial,solved,time_s\nbox,1,2,1,0.5\nbox,1,2,1,0.7\n",
                {"r.csv:3", "trial", "'2'", "problem 1 of 'box'"});
}

TEST_F(ImportedCsvTest, MeasuresAndReasonsAreRead) {
  const auto runs = Read(
      "problem_set,problem_index,solved,time_s,reason,path_length,clearance_simplified\n"
      "\"a, \"\"b\"\"\",1,1,2,,3.5,\nbox,2,0,9,\"hit, twice\",,\n");
  EXPECT_EQ(runs[0].problem_set, "a, \"b\"");
  EXPECT_EQ(runs[0].measures, (MeasuredValues{{"path_length", 3.5}}));
  EXPECT_TRUE(runs[0].measures_simple.empty());
  EXPECT_EQ(runs[1].message, "hit, twice");
}

TEST_F(ImportedCsvTest, CellsInQuotesMayGoOnInTheNextLine) {
  const std::string header = "problem_set,problem_index,solved,time_s,reason\r\n";
  folder_.Write("r.csv", header +
                             "box,1,0,9,\"hit,\r\n\r\nand \"\"stopped\"\"\"\r\n"
                             "box,2,0,9,5\" short\r\nbox,3,1,2,\r\n");
  const StoredSession session = Import("r.csv", "x");
  ASSERT_EQ(session.runs.size(), 3u);
  EXPECT_EQ(session.runs[0].message, "hit,  and \"stopped\"");
  EXPECT_EQ(session.runs[1].message, "5\" short") << "of the text, as it does not begin with it";
  EXPECT_EQ(session.runs[1].id, 5);
  ExpectRefused(header + "box,1,0,9,\"a\r\nb\"\r\nbox,2,2,9,\r\n", {"r.csv:4: solved: '2'"});
  ExpectRefused(header + "box,1,1,2,\r\nbox,2,0,9,\"hit\r\nbox,3,1,2,\r\n",
                {"r.csv:3: a quote (\") is not closed"});
}

TEST_F(ImportedCsvTest, BadFilesAreRefusedByLineAndColumn) {
  const std::string header = "problem_set,problem_index,solved,time_s\n";
  ExpectRefused("", {"r.csv", "no results"});
  ExpectRefused(header, {"r.csv", "no results"});
  ExpectRefused("problem_set,solved,time_s\nbox,1,2\n", {"r.csv", "problem_index"});
  ExpectRefused(header + "box,1,1\n", {"r.csv:2", "3 values for 4 columns"});
  ExpectRefused(header + "box,1,1,\n", {"r.csv:2", "time_s", "''"});
  ExpectRefused(header + "box,1,1,nan\n", {"r.csv:2", "time_s", "'nan'"});
  ExpectRefused(header + "box,1,2,1\n", {"r.csv:2", "solved", "'2'"});
  ExpectRefused(header + "box,1.5,1,1\n", {"r.csv:2", "problem_index", "whole"});
  ExpectRefused(header + "box,0,1,1\n", {"r.csv:2", "problem_index", "from 1 to"});
  ExpectInputError([&] { ImportResults("/none/r.csv", "x", 1, &warnings_); }, {"/none/r.csv"});
}

TEST_F(ImportedCsvTest, AFailedRunNeedsNoTime) {
  const auto runs = Read(
      "problem_set,problem_index,solved,time_s,time_limit_s,path_length\n"
      "box,1,0,,,\nbox,2,0,nan,10,NaN\nbox,3,0,4,,nan\n");
  EXPECT_EQ(runs[0].time_s, std::nullopt);
  EXPECT_EQ(runs[0].roundtrip_time_s, 60) << "its limit, here the session's";
  EXPECT_EQ(runs[1].time_s, std::nullopt);
  EXPECT_EQ(runs[1].roundtrip_time_s, 10);
  EXPECT_EQ(runs[2].time_s, 4);
  for (const StoredRun& run : runs) EXPECT_TRUE(run.measures.empty());
  EXPECT_TRUE(warnings_.empty());
  ExpectRefused("problem_set,problem_index,solved,time_s\nbox,1,0,soon\n",
                {"r.csv:2: time_s: 'soon' is not a number"});
}

TEST_F(ImportedCsvTest, OtherSeparatorsThanCommasAreNamed) {
  ExpectRefused("\nproblem_set;problem_index;solved;time_s\nbox;1;1;0,5\n",
                {"r.csv:2: columns are separated by ';': ", "commas", "points in numbers"});
  ExpectRefused("problem_set\tproblem_index\tsolved\ttime_s\n", {"r.csv:1:", "by tabs"});
  ExpectRefused("problem_set,problem_index,solved\n", {"r.csv:1: no column 'time_s'"});
  EXPECT_EQ(Read("problem_set,problem_index,solved,time_s,a;b\nbox,1,1,2,;\n").size(), 1u);
}

TEST_F(ImportedCsvTest, TwoColumnsOfIndicesTellTheSame) {
  const std::string header = "problem_set,problem_index,query_index,solved,time_s\n";
  EXPECT_EQ(Read(header + "box,4,3,1,2\n").at(0).problem_index, 4);
  ExpectRefused(header + "box,4,3,1,2\nbox,5,5,1,2\n",
                {"r.csv:3: problem_index: '5' is not 6, which query_index tells"});
}

TEST_F(ImportedCsvTest, RowsOfNoProblemAreRefused) {
  ExpectRefused("problem_set,problem_index,solved,time_s\nbox,1,1,2\n,1,1,2\n",
                {"r.csv:3: problem_set: '' is not the name"});
}

TEST_F(ImportedCsvTest, RowsOfOtherProblemsAreCounted) {
  folder_.Write("r.csv",
                "problem_set,problem_index,solved,time_s\nbox,1,1,2\nbxo,1,1,2\nbox,3,1,2\n");
  const auto keep = [&](const ProblemsBySet& problems) {
    StoredSession session = Import("r.csv", "x");
    KeepProblems(problems, &session, &warnings_);
    return session.num_runs;
  };
  EXPECT_EQ(keep({{"box", {1, 2}}}), 1);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("r.csv:3: problem 1 of 'bxo' is none of the session's; 2 of 3 "),
            std::string::npos)
      << warnings_[0];
  EXPECT_EQ(keep({{"box", {}}}), 2) << "any problem of the set";
  EXPECT_EQ(keep({{"box", {1, 3}}, {"bxo", {}}}), 3);
  EXPECT_EQ(warnings_.size(), 2u) << "all are the session's";
}

TEST_F(ImportedCsvTest, AColumnThatIsThereTwiceIsRefused) {
  ExpectRefused("\nproblem_set,problem_index,solved,time_s,time_s\nbox,1,1,0.5,50\n",
                {"r.csv:2: two columns are called 'time_s'"});
  ExpectRefused("problem_set,note,problem_index,solved,time_s,\"note\"\nbox,a,1,1,0.5,b\n",
                {"r.csv:1: two columns are called 'note'"});
  EXPECT_EQ(Read("problem_set,problem_index,solved,time_s,,\nbox,1,1,0.5,,\n").size(), 1u)
      << "a spreadsheet's empty columns have no name";
}

TEST_F(ImportedCsvTest, APathAfterTheTimeLimitIsNone) {
  const auto runs = Read(
      "problem_set,problem_index,solved,time_s,time_limit_s\nbox,1,1,10,10\nbox,2,1,11,10\n"
      "box,3,0,11,10\nbox,4,1,61,0\n");
  EXPECT_EQ(runs[0].status, PlanStatus::kSolved);
  EXPECT_EQ(runs[1].status, PlanStatus::kTimedOut);
  EXPECT_TRUE(runs[1].claimed);
  EXPECT_EQ(runs[1].message, "solved after 11 s, beyond the time limit of 10 s");
  EXPECT_EQ(runs[2].message, "");
  EXPECT_EQ(runs[3].status, PlanStatus::kTimedOut);  // the session's limit
  EXPECT_EQ(runs[3].time_limit_s, 60);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("r.csv: 2 solved runs took longer"), std::string::npos);
}

TEST_F(ImportedCsvTest, EncodingsOfSpreadsheets) {
  const std::string text = "problem_set,problem_index,solved,time_s\nbox,1,1,0.5\n";
  EXPECT_EQ(Read("\xef\xbb\xbf" + text).size(), 1u);
  std::string wide = "\xff\xfe";
  for (const char c : text) wide += {c, '\0'};
  ExpectRefused(wide, {"r.csv", "UTF-16"});
}

TEST_F(ImportedCsvTest, FilesOfOneNameAreOneSession) {
  const std::string header = "problem_set,problem_index,solved,time_s\n";
  folder_.Write("a.csv", header + "box,1,1,0.5\n");
  folder_.Write("b.csv", header + "box,2,1,0.5\nbox,3,0,0.5\n");
  const auto join = [&](const std::vector<std::string>& files,
                        const std::vector<std::string>& names) {
    std::vector<StoredSession> imported;
    for (std::size_t i = 0; i < files.size(); ++i) imported.push_back(Import(files[i], names[i]));
    return JoinImports(names, std::move(imported));
  };
  const std::vector<StoredSession> joined = join({"a.csv", "b.csv", "a.csv"}, {"Y", "Y", "Z"});
  ASSERT_EQ(joined.size(), 2u);
  EXPECT_EQ(joined[0].contestants.size(), 1u);
  EXPECT_EQ(joined[0].runs.size(), 3u);
  EXPECT_EQ(joined[0].num_runs, 3);
  EXPECT_EQ(joined[0].run_id, "a.csv, b.csv");
  EXPECT_NE(joined[0].contestants[0].settings.find("b.csv"), std::string::npos);
  EXPECT_EQ(joined[1].contestants[0].name, "Z");
  ExpectInputError(
      [&] {
        join({"b.csv", "b.csv"}, {"Y", "Y"});
      },
      {"b.csv: 'Y' has problem 2 of 'box', trial 1", "from another file"});
  RequireOtherNames({"A", "B"}, joined);
  ExpectInputError(
      [&] {
        RequireOtherNames({"A", "Z"}, joined);
      },
      {"a.csv", "a contestant is called 'Z'"});
}

}  // namespace
}  // namespace planbench
