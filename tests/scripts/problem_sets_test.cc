#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

/// scripts/problem_sets.sh with a stand-in for make_problems, which notes its arguments and writes
/// one problem, or fails.
class ProblemSetsTest : public testing::Test {
 protected:
  ProblemSetsTest() {
    Write("robot/robot.yaml", "name: one\n");
    Write("specs/shelf.yaml", "base: shelf\n");
    WriteProgram("touch \"$out/scene0001.yaml\"");
  }

  const std::filesystem::path& folder() const { return folder_.path(); }

  void Write(const std::string& name, const std::string& text) { folder_.Write(name, text); }
  std::string Read(const std::string& name) const {
    std::ifstream file(folder() / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// A program whose --out folder is made, and then `last` done.
  void WriteProgram(const std::string& last) {
    Write("make_problems",
          "#!/bin/sh\necho \"$@\" >> calls\nwhile [ $# -gt 1 ]; do [ $1 = --out ] && out=$2; "
          "shift; done\nmkdir \"$out\"\n" +
              last + "\n");
    std::filesystem::permissions(folder() / "make_problems", std::filesystem::perms::owner_all);
  }
  /// Exit code.
  int Ensure(const std::string& seed = "1", const std::string& count = "100") {
    const std::string script = "set -euo pipefail; cd '" + folder().string() + "'; . '" +
                               PLANBENCH_SOURCE_DIR + "/scripts/setup.sh'; . '" +
                               PLANBENCH_SOURCE_DIR +
                               "/scripts/problem_sets.sh'; ensure_problem_set ./make_problems "
                               "specs/shelf.yaml robot " +
                               seed + " " + count + " sets/shelf";
    ChildProcess bash({"bash", "-c", script}, folder() / "bash");
    return bash.Wait().value_or(-1);
  }
  int NumCalls() const {
    const std::string calls = Read("calls");
    return static_cast<int>(std::count(calls.begin(), calls.end(), '\n'));
  }
  bool Exists(const std::string& name) const { return std::filesystem::exists(folder() / name); }

 private:
  TemporaryFolder folder_;
};

TEST_F(ProblemSetsTest, ASetIsGeneratedOnce) {
  EXPECT_EQ(Ensure(), 0);
  EXPECT_EQ(Read("calls"),
            "--spec specs/shelf.yaml --robot robot --count 100 --seed 1 --out sets/shelf.new\n");
  EXPECT_TRUE(Exists("sets/shelf/scene0001.yaml"));
  EXPECT_FALSE(Exists("sets/shelf.new"));
  EXPECT_EQ(Ensure(), 0);
  EXPECT_EQ(NumCalls(), 1);
}

TEST_F(ProblemSetsTest, WhateverItDependsOnMakesItAnew) {
  ASSERT_EQ(Ensure(), 0);
  int calls = 1;
  const auto expect_made_anew_once = [&](const char* what, const std::string& seed = "1",
                                         const std::string& count = "100") {
    ++calls;
    EXPECT_EQ(Ensure(seed, count), 0);
    EXPECT_EQ(NumCalls(), calls) << what;
    EXPECT_EQ(Ensure(seed, count), 0);
    EXPECT_EQ(NumCalls(), calls) << what;
  };
  expect_made_anew_once("seed", "2");
  expect_made_anew_once("count", "1", "10");
  expect_made_anew_once("seed and count as before");
  Write("specs/shelf.yaml", "base: other shelf\n");
  expect_made_anew_once("specification");
  Write("specs/base.yaml", "boards: 2\n");
  expect_made_anew_once("a file that the specification may name");
  Write("robot/robot.yaml", "name: two\n");
  expect_made_anew_once("robot");
  WriteProgram("touch \"$out/scene0002.yaml\"");
  expect_made_anew_once("program");
  EXPECT_TRUE(Exists("sets/shelf/scene0002.yaml"));
  EXPECT_FALSE(Exists("sets/shelf/scene0001.yaml"));
  std::filesystem::remove_all(folder() / "sets/shelf");
  expect_made_anew_once("the set is gone");
}

TEST_F(ProblemSetsTest, AFailureIsPassedOnAndLeavesNoSet) {
  WriteProgram("exit 2");
  EXPECT_EQ(Ensure(), 2);
  EXPECT_FALSE(Exists("sets/shelf"));
  WriteProgram("touch \"$out/scene0001.yaml\"");
  EXPECT_EQ(Ensure(), 0);
  EXPECT_TRUE(Exists("sets/shelf/scene0001.yaml"));
}

}  // namespace
}  // namespace planbench
