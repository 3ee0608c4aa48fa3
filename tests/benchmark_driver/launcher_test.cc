#include "benchmark_driver/launcher.h"

#include <gtest/gtest.h>

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
}

}  // namespace
}  // namespace planbench
