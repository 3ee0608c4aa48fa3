#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "scene/problem.h"
#include "tests/problem_generator/generator_support.h"
#include "tests/support/child_process.h"

namespace planbench {
namespace {

using testing::HasSubstr;

class MakeProblemsTest : public testing::Test {
 protected:
  struct Outcome {
    int exit_code;
    std::string output;
    std::string errors;
  };
  Outcome Run(std::vector<std::string> arguments,
              const std::map<std::string, std::string>& environment = {}) {
    arguments.insert(arguments.begin(), std::string(PLANBENCH_BIN_DIR) + "/make_problems");
    ChildProcess process(arguments, folder_ / "process", environment);
    return {process.Wait().value_or(-1), process.Output(), process.Errors()};
  }
  Outcome Make(const std::filesystem::path& spec, const std::string& out,
               const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {
        "--spec",  spec.string(),
        "--robot", std::string(PLANBENCH_SOURCE_DIR) + "/robots/fetch",
        "--out",   (folder_ / out).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Run(arguments);
  }
  std::map<std::string, std::string> Contents(const std::string& set) {
    std::map<std::string, std::string> contents;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / set)) {
      std::ifstream file(entry.path());
      contents[entry.path().filename()] = {std::istreambuf_iterator<char>(file), {}};
    }
    return contents;
  }

  const TemporaryFolder folder_;
};

TEST_F(MakeProblemsTest, WritesTheSetAndSaysWhatItDid) {
  const Outcome outcome = Make(ShippedProblems() / "box.yaml", "a", {"--count", "12"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");  // No progress bar where there is no terminal.
  EXPECT_THAT(outcome.output, HasSubstr("box: 12 problems with seed 1"));
  EXPECT_THAT(outcome.output, HasSubstr("approach\n"));
  EXPECT_THAT(outcome.output, HasSubstr("approach goal: in collision\n"));
  EXPECT_EQ(ListProblemSet(folder_ / "a").problems.size(), 12);

  // The first of fewer problems are the same, in any number of threads; another seed differs.
  EXPECT_EQ(Make(ShippedProblems() / "box.yaml", "b", {"--count", "4", "--threads", "3"}).exit_code,
            0);
  EXPECT_EQ(Make(ShippedProblems() / "box.yaml", "c", {"--count", "4", "--seed", "2"}).exit_code,
            0);
  const auto a = Contents("a"), b = Contents("b"), c = Contents("c");
  ASSERT_EQ(b.size(), 8);
  ASSERT_EQ(c.size(), 8);
  for (const auto& [name, text] : b) {
    EXPECT_EQ(text, a.at(name)) << name;
    EXPECT_NE(text, c.at(name)) << name;
  }
}

TEST_F(MakeProblemsTest, ReplacesASetOnlyIfTold) {
  const auto spec = ShippedProblems() / "box.yaml";
  EXPECT_EQ(Make(spec, "a", {"--count", "3"}).exit_code, 0);
  const Outcome refused = Make(spec, "a", {"--count", "2"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("--replace"));
  EXPECT_EQ(Make(spec, "a", {"--count", "2", "--replace"}).exit_code, 0);
  EXPECT_EQ(ListProblemSet(folder_ / "a").problems.size(), 2);
}

TEST_F(MakeProblemsTest, AFailureKeepsTheSetThatWasThere) {
  const SpecFolder specs;
  const auto spec =
      specs.Write(CanOnTableWith("position: [1.0, 0, [0.6, 0.8]]", "position: [4.0, 0, 0.7]"));
  EXPECT_EQ(Make(ShippedProblems() / "box.yaml", "a", {"--count", "2"}).exit_code, 0);
  const auto before = Contents("a");
  const Outcome outcome = Make(spec, "a", {"--replace"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("spec.yaml:19: queries[0].goal"));
  EXPECT_THAT(outcome.errors, HasSubstr("no inverse kinematics solution"));
  EXPECT_EQ(Contents("a"), before);
}

TEST_F(MakeProblemsTest, WithoutAFolderForTheSessionsOfCertifyingNothingIsMade) {
  const std::string nowhere = folder_ / "nowhere", out = folder_ / "a";
  const Outcome outcome =
      Run({"--spec", ShippedProblems() / "box.yaml", "--robot",
           std::string(PLANBENCH_SOURCE_DIR) + "/robots/fetch", "--out", out, "--certify"},
          {{"TMPDIR", nowhere}});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.output, "");
  EXPECT_THAT(outcome.errors, HasSubstr(nowhere));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(MakeProblemsTest, BadUseEndsWithTwoAndOneLine) {
  const std::string robot = std::string(PLANBENCH_SOURCE_DIR) + "/robots/fetch";
  const std::string spec = (ShippedProblems() / "box.yaml").string();
  const std::string out = (folder_ / "x").string();
  const std::vector<std::vector<std::string>> uses = {
      {},
      {"--spec", spec, "--robot", robot},
      {"--spec", spec, "--robot", robot, "--out", out, "--count", "0"},
      {"--spec", spec, "--robot", robot, "--out", out, "--seed", "-1"},
      {"--spec", spec, "--robot", robot, "--out", out, "--nonsense"},
      {"--spec", "nothing.yaml", "--robot", robot, "--out", out},
      {"--spec", spec, "--robot", "nowhere", "--out", out},
  };
  for (const auto& use : uses) {
    const Outcome outcome = Run(use);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.errors;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    EXPECT_TRUE(outcome.errors.starts_with("make_problems: ")) << outcome.errors;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(MakeProblemsTest, SaysWhatItIs) {
  const Outcome help = Run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* flag : {"--spec", "--robot", "--count", "--seed", "--out", "--replace"}) {
    EXPECT_THAT(help.output, HasSubstr(flag));
  }
  const Outcome version = Run({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.output.starts_with("make_problems ")) << version.output;
}

}  // namespace
}  // namespace planbench
