#include <gtest/gtest.h>

#include "tests/pipeline/pipeline_fixture.h"

namespace planbench {
namespace {

class FiveProcesses : public PipelineTest {};

TEST_F(FiveProcesses, FindEachOtherInAnyOrderAndEndCleanly) {
  const auto session = folder() / "session";
  // The driver first, the scene server last.
  ChildProcess* driver =
      StartDriver({"--problems-range", "1-2", "--time", "30", "--directions", "both"});
  ChildProcess* logger = StartLogger(session);
  ChildProcess* rrtc = StartPlanner("rrtc");
  ChildProcess* ara = StartPlanner("ara");
  // The driver starts without a logger if it must: here it is to have one.
  ASSERT_TRUE(WaitUntil([&] { return Query(session, "SELECT count(*) FROM runs") == 0; }));
  ChildProcess* server = StartSceneServer();

  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  EXPECT_NE(driver->Output().find("Success"), std::string::npos);
  EXPECT_TRUE(rrtc->Running() && ara->Running() && server->Running() && logger->Running());
  for (ChildProcess* process : {server, ara, rrtc, logger}) ExpectEndsCleanly(process);
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs"), 8);
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE solved AND referee_valid IS NOT 1"), 0);
}

TEST_F(FiveProcesses, KilledPlannerIsNoAnswerAndTheBenchmarkGoesOnWhenItIsBack) {
  const auto session = folder() / "session";
  ChildProcess* logger = StartLogger(session);
  ChildProcess* server = StartSceneServer();
  // An anytime planner that never knows its best path to be the best: every request lasts its
  // whole time limit, so that the kill comes in the middle of one.
  ChildProcess* rrtc = StartPlanner("rrtc", {"--set", "algorithm=RRTstar"});
  ChildProcess* driver =
      StartDriver({"--problems-range", "1-2", "--time", "2", "--planners", "rrtc", "--directions",
                   "forward", "--trials", "3", "--anytime"});
  ASSERT_TRUE(WaitUntil([&] { return Query(session, "SELECT count(*) FROM runs") >= 2; }))
      << driver->Errors();
  rrtc->Signal(SIGKILL);
  ASSERT_TRUE(rrtc->Wait().has_value());
  ASSERT_TRUE(WaitUntil([&] {
    return Query(session, "SELECT count(*) FROM runs WHERE status = 7") == 1;
  })) << driver->Errors();
  EXPECT_TRUE(driver->Running());
  ChildProcess* back = StartPlanner("rrtc", {"--set", "algorithm=RRTstar"});
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  for (ChildProcess* process : {server, back, logger}) ExpectEndsCleanly(process);
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs"), 6);
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE status = 7"), 1);
}

}  // namespace
}  // namespace planbench
