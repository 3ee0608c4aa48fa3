#include "results/reproduce.h"

#include <gtest/gtest.h>

#include "results/recorded_flags.h"

namespace planbench {
namespace {

std::string Command(const std::map<std::string, std::string>& flags) {
  return ReproducingCommand(flags);
}

TEST(ReproducingCommandTest, RepeatsWhatWasGiven) {
  EXPECT_EQ(Command({{"launch", "true"},
                     {"parallel", "false"},
                     {"sets", ""},
                     {"planners", "ara,rrtc"},
                     {"time", "10"}}),
            "benchmark_driver --launch --planners ara,rrtc --time 10");
  EXPECT_EQ(Command({}), "");
}

TEST(ReproducingCommandTest, LeavesOutTheSessionsOwnFolderAndBus) {
  EXPECT_EQ(Command({{"out", "x"}, {"resume", "y"}, {"lcm-url", "udpm://z"}, {"seed", "1"}}),
            "benchmark_driver --seed 1");
}

TEST(ReproducingCommandTest, RepeatsFlagsThatWereGivenSeveralTimes) {
  EXPECT_EQ(Command({{"problems", "/a,/b c"}}), "benchmark_driver --problems /a --problems '/b c'");
  EXPECT_EQ(Command({{"problems", "/c\\,d,/e"}}), "benchmark_driver --problems /c,d --problems /e");
}

TEST(ReproducingCommandTest, ValuesAreRecordedAsTheyWereGiven) {
  const std::vector<std::vector<std::string>> given = {
      {"x.y=1", "a+b.k=2"},
      {"x.y=a,b=c", "x.z=[1,2]", "x.w=\\", "x.v=\\,", "v.u=,=,"},
      {"Planner A, B=x.csv", "C d=y,z.csv"},
      {"c,d", "e\\", "\\,", "a=b"},
      {"mine=./a \\d"}};
  for (const std::vector<std::string>& values : given) {
    EXPECT_EQ(SplitFlagValues(JoinFlagValues(values)), values) << values.front();
  }
  EXPECT_EQ(JoinFlagValues({"/a", "/b c"}), "/a,/b c");
}

TEST(ReproducingCommandTest, OfAMergedSessionIsThatOfItsParts) {
  EXPECT_EQ(Command({{kMergedCommands, "a && b"}, {"seed", "1"}}), "a && b");
}

TEST(ReproducingCommandTest, ResumesWithTheFlagsOfTheBeginning) {
  EXPECT_EQ(ResumingCommand({{"launch", "true"}, {"out", "a b"}, {"seed", "7"}}, "/a b"),
            "benchmark_driver --launch --seed 7 --resume '/a b'");
}

TEST(ReproducingCommandTest, CommandsOfSeveralAreJoinedOnceEach) {
  const std::string quoted = Command({{"planner-command", "m=cd x && ./y's"}});
  const std::string joined = JoinCommands({"a", quoted, "", "b && a", quoted});
  EXPECT_EQ(joined, "a && " + quoted + " && b");
  EXPECT_EQ(ResumingCommand({{kMergedCommands, joined}}, "/s"),
            "a --resume /s && " + quoted + " --resume /s && b --resume /s");
}

TEST(ReproducingCommandTest, QuotesForTheShell) {
  EXPECT_EQ(Command({{"robot", "it's $HOME"}}), "benchmark_driver --robot 'it'\\''s $HOME'");
}

TEST(WhatMakesThemTest, TellsRunsApartThatNoResumedSessionMakes) {
  EXPECT_EQ(WhatMakesThem(1, 0), "--resume makes it");
  EXPECT_EQ(WhatMakesThem(3, 0), "--resume makes them");
  EXPECT_EQ(WhatMakesThem(2, 2), "a new session with a larger --referee-step makes them");
  EXPECT_EQ(WhatMakesThem(3, 2),
            "--resume makes 1 of them, a new session with a larger --referee-step the others");
}

TEST(DescribeOwedTest, NobodyIsToldToResumeForWhatThatDoesNotMake) {
  const std::string begin = "runs of the session's earlier plan ";
  EXPECT_EQ(DescribeOwed(3, 0, 0, "make"),
            begin + "not made: 3; it is not finished; go on with: make");
  EXPECT_EQ(DescribeOwed(2, 2, 0, "make"),
            begin +
                "not made: 2 (a new session with a larger --referee-step makes them); it is "
                "not finished");
  EXPECT_EQ(DescribeOwed(0, 0, 1, "make"),
            begin + "disturbed and not made again: 1; it is not finished; go on with: make");
  EXPECT_EQ(DescribeOwed(1, 1, 1, "make"),
            begin +
                "not made: 1 (a new session with a larger --referee-step makes it), disturbed "
                "and not made again: 1; it is not finished; go on with: make");
}

}  // namespace
}  // namespace planbench
