#include "results/reproduce.h"

#include <gtest/gtest.h>

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
  EXPECT_EQ(Command({{"set", "ara.k=[1,2],rrtc.range=1"}}),
            "benchmark_driver --set 'ara.k=[1,2]' --set rrtc.range=1");
}

TEST(ReproducingCommandTest, OfAMergedSessionIsThatOfItsParts) {
  EXPECT_EQ(Command({{kMergedCommands, "a && b"}, {"seed", "1"}}), "a && b");
}

TEST(ReproducingCommandTest, ResumesWithTheFlagsOfTheBeginning) {
  EXPECT_EQ(ResumingCommand({{"launch", "true"}, {"out", "a b"}, {"seed", "7"}}, "/a b"),
            "benchmark_driver --launch --seed 7 --resume '/a b'");
}

TEST(ReproducingCommandTest, QuotesForTheShell) {
  EXPECT_EQ(Command({{"robot", "it's $HOME"}}), "benchmark_driver --robot 'it'\\''s $HOME'");
}

}  // namespace
}  // namespace planbench
