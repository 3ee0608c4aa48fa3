#include "benchmark_driver/launcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "messaging/node_announcer.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

TEST(RequireProgramsTest, EveryContestantNeedsAProgramOrACommand) {
  const TemporaryFolder programs;
  for (const char* program : {"planner_rrtc", "planner_ara", "logger"}) programs.Write(program, "");
  std::vector<LineUpEntry> line_up(3);
  line_up[0].program = "ara";
  line_up[1].program = "rrtc";
  line_up[2].contestant.planner = "mine";
  line_up[2].contestant.command = "./mine";
  EXPECT_NO_THROW(RequirePrograms(line_up, programs.path()));
  line_up[2].contestant.command = "";
  line_up[2].program = "prm";
  ExpectInputError([&] { RequirePrograms(line_up, programs.path()); },
                   {"'prm'", "ara, rrtc", "--planner-command mine="});
  ExpectInputError(
      [&] { RequirePrograms(line_up, programs.path(), "/my line-up.yaml"); },
      {"'prm'", "the session was made with --lineup '/my line-up.yaml': give it again"});
}

TEST(ProcessStopperTest, OfPlannersThatAreLiveThoseOfACommandAreNamedOnceHoweverASessionEnds) {
  Bus bus("memq://");
  bus.Start();
  const auto announce = [&](const std::string& name) {
    return std::make_unique<NodeAnnouncer>(
        &bus, [status = MakeNodeStatus(name, NodeKind::kPlanner)] { return status; });
  };
  const auto mine = announce("mine");
  const auto own = announce("own");
  const auto elsewhere = announce("elsewhere");
  std::vector<LineUpEntry> line_up(2);
  line_up[0].contestant.planner = "mine";
  line_up[0].contestant.command = "./mine";
  line_up[1].contestant.planner = "own";
  Supervisor supervisor;
  for (const bool ends_well : {true, false}) {
    testing::internal::CaptureStdout();  // Where messages go.
    {
      ProcessStopper stopper(line_up, &bus, &supervisor);
      if (ends_well) stopper.Stop();
    }
    const std::string output = testing::internal::GetCapturedStdout();
    const std::string named = "the planner 'mine' (host ";
    EXPECT_THAT(output, testing::HasSubstr(named));
    EXPECT_EQ(output.find(named), output.rfind(named)) << output;
    EXPECT_THAT(output, testing::Not(testing::HasSubstr("'own'")));
    EXPECT_THAT(output, testing::Not(testing::HasSubstr("'elsewhere'")));
  }
}

}  // namespace
}  // namespace planbench
