#include "results/reference.h"

#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

class ReferenceTest : public testing::Test {
 protected:
  std::vector<Attempt> Read(const std::string& text) {
    folder_.Write("r.csv", text);
    return ReadReference(folder_.path() / "r.csv", "published", 60);
  }
  void ExpectRefused(const std::string& text, const std::vector<std::string>& parts) {
    ExpectInputError([&] { Read(text); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(ReferenceTest, ReadsWhatIsThere) {
  const auto attempts = Read(
      "problem_set,query_index,solved,time_s,waypoints\r\nbox,0,1,2.25,9\r\n\r\nbox,1,0,60,0\r\n");
  ASSERT_EQ(attempts.size(), 2u);
  EXPECT_EQ(attempts[0].problem_set, "box");
  EXPECT_EQ(attempts[0].problem_index, 1);
  EXPECT_EQ(attempts[0].contestant, "published");
  EXPECT_EQ(attempts[0].status, PlanStatus::kSolved);
  EXPECT_TRUE(attempts[0].claimed);
  EXPECT_EQ(attempts[0].time_s, 2.25);
  EXPECT_EQ(attempts[0].time_limit_s, 60);
  EXPECT_EQ(attempts[0].direction, Direction::kForward);
  EXPECT_EQ(attempts[0].trial, 1);
  EXPECT_EQ(attempts[1].status, PlanStatus::kTimedOut);
  EXPECT_FALSE(attempts[1].claimed);
}

TEST_F(ReferenceTest, OptionalColumnsCount) {
  const auto attempts = Read(
      "trial,direction,time_limit_s,problem_set,problem_index,solved,time_s\n"
      "3,backward,10,cage,7,1,0.5\n");
  ASSERT_EQ(attempts.size(), 1u);
  EXPECT_EQ(attempts[0].trial, 3);
  EXPECT_EQ(attempts[0].direction, Direction::kBackward);
  EXPECT_EQ(attempts[0].time_limit_s, 10);
  EXPECT_EQ(attempts[0].problem_index, 7);
}

TEST_F(ReferenceTest, BadFilesAreRefusedByLineAndColumn) {
  const std::string header = "problem_set,problem_index,solved,time_s\n";
  ExpectRefused("", {"r.csv", "no results"});
  ExpectRefused(header, {"r.csv", "no results"});
  ExpectRefused("problem_set,solved,time_s\nbox,1,2\n", {"r.csv", "problem_index"});
  ExpectRefused(header + "box,1,1\n", {"r.csv:2", "3 values for 4 columns"});
  ExpectRefused(header + "box,1,1,\n", {"r.csv:2", "time_s", "''"});
  ExpectRefused(header + "box,1,1,nan\n", {"r.csv:2", "time_s", "'nan'"});
  ExpectRefused(header + "box,1,2,1\n", {"r.csv:2", "solved", "'2'"});
  ExpectRefused(header + "box,1.5,1,1\n", {"r.csv:2", "problem_index", "whole"});
  ExpectInputError([] { ReadReference("/none/r.csv", "x", 1); }, {"/none/r.csv"});
}

}  // namespace
}  // namespace planbench
