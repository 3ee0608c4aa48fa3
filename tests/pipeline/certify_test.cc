#include <gtest/gtest.h>

#include "tests/pipeline/pipeline_fixture.h"

namespace planbench {
namespace {

class Certify : public PipelineTest {};

TEST_F(Certify, LivePlannersSolveWhatIsWritten) {
  const auto set = folder() / "table_pick";
  ChildProcess* process =
      Start({Program("make_problems"), "--spec", PLANBENCH_SOURCE_DIR "/problems/table_pick.yaml",
             "--robot", RobotFolder(), "--count", "2", "--out", set.string(), "--certify",
             "--certify-time", "20"});
  EXPECT_EQ(process->Wait(), 0) << process->Errors();
  EXPECT_NE(process->Output().find("certified"), std::string::npos) << process->Output();
  EXPECT_TRUE(std::filesystem::exists(set / "request0002.yaml"));
}

}  // namespace
}  // namespace planbench
