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

TEST(ReproducingCommandTest, OfEarlierSessionsACommaThatNoNameFollowsIsPartOfAValue) {
  EXPECT_EQ(Command({{"set", "ara.k=[1,2],rrtc.range=1"}}),
            "benchmark_driver --set 'ara.k=[1,2]' --set rrtc.range=1");
  EXPECT_EQ(Command({{"planner-command", "mine=./a \\d"}}),
            "benchmark_driver --planner-command 'mine=./a \\d'");
}

TEST(ReproducingCommandTest, ValuesAreRecordedAsTheyWereGiven) {
  const std::vector<std::string> odd = {"x.y=a,b=c", "x.z=[1,2]", "x.w=\\", "x.v=\\,", "v.u=,=,"};
  for (const char* flag : {"set", "planner-command", "package-path", "reference"}) {
    EXPECT_TRUE(TakesSeveralValues(flag));
    EXPECT_EQ(SplitFlagValues(flag, JoinFlagValues(odd)), odd) << flag;
  }
  const std::vector<std::string> names = {"Planner A, B=x.csv", "C d=y,z.csv"};
  EXPECT_EQ(SplitFlagValues("reference", JoinFlagValues(names)), names);
  const std::vector<std::string> folders = {"c,d", "e\\", "\\,", "a=b"};
  EXPECT_EQ(SplitFlagValues("problems", JoinFlagValues(folders)), folders);
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

}  // namespace
}  // namespace planbench
