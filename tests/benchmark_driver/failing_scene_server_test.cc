#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/error.h"
#include "messaging/asked_runs.h"
#include "tests/benchmark_driver/run_executor_fixture.h"

namespace planbench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// With patience that is soon told of, and a scene server that answers no request for a problem.
class SilentSceneServerTest : public RunExecutorTest {
 protected:
  SilentSceneServerTest() { patience_.until_told = std::chrono::milliseconds(1); }
  ~SilentSceneServerTest() override { is_over_ = true; }

  void StaySilent() {
    silent_.emplace(&bus_);
    silent_->BeforeAnswers([&](const auto&) { WaitUntil([&] { return is_over_.load(); }); });
    ASSERT_TRUE(WaitUntil([&] { return !registry_.Live(NodeKind::kSceneServer).empty(); }));
  }

  ServerPatience patience_;

 private:
  std::atomic<bool> is_over_ = false;
  std::optional<FakeSceneServer> silent_;
};

TEST_F(SilentSceneServerTest, WhileItWaitsForAVerdictItTellsWhatMakesThemFaster) {
  SessionConditions conditions = Conditions();
  FakeSceneServer server(&bus_);
  for (const bool with_clearance : {true, false}) {
    conditions.with_clearance = with_clearance;
    RunExecutor executor(&bus_, &registry_, conditions, {}, {}, {}, patience_);
    // Asked for again when it has been told.
    server.OnPathCheck([&](const PathCheckRequestMessage& check) {
      const auto is_same = [&](const auto& other) { return other.request_id == check.request_id; };
      WaitUntil([&] { return server.path_checks().Count(is_same) >= 2; });
      return FakeSceneServer::Verdict(true);
    });
    testing::internal::CaptureStdout();
    Execute(&executor);
    EXPECT_THAT(
        testing::internal::GetCapturedStdout(),
        HasSubstr(std::string("it is live, but silent; verdicts take less time with a larger "
                              "--referee-step than 0.004") +
                  (with_clearance ? ", or with --no-clearance)" : ")")));
  }
}

TEST_F(SilentSceneServerTest, TellsWhichProblemItWaitsForUntilTheSceneServerIsGone) {
  patience_.until_given_up = std::chrono::milliseconds(5);
  RunExecutor executor(&bus_, &registry_, Conditions(), {}, {}, {}, patience_);
  testing::internal::CaptureStdout();
  EXPECT_THAT([&] { executor.AskForProblem("cans", 2, [] { return false; }); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("no scene server has been live for 0.005 s, though the problem "
                                  "cans 2 is waited for"),
                        Not(HasSubstr("--resume")))))
      << "there may be nothing to resume yet";
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("waiting for the problem cans 2 from the scene server (no scene server is "
                        "live)"));
  StaySilent();
  int num_asked = 0;
  EXPECT_FALSE(executor.AskForProblem("cans", 2, [&] { return ++num_asked >= 100; }));
}

TEST_F(SilentSceneServerTest, AProblemThatTheSceneServerIsTooLongAtIsPassedOver) {
  patience_.until_passed_over = std::chrono::milliseconds(20);
  int num_new_starts = 0;
  const SupervisedServer supervised{[] { return 0; }, [&] { ++num_new_starts; }};
  RunExecutor executor(&bus_, &registry_, Conditions(), {}, {}, supervised, patience_);
  StaySilent();
  for (int time = 1; time <= 2; ++time) {
    const auto answer = executor.AskForProblem("cans", 2, [] { return false; });
    ASSERT_TRUE(answer);
    EXPECT_FALSE(answer->ok);
    EXPECT_EQ(answer->message,
              "the scene server did not answer within 0.02 s when it was asked for the problem "
              "cans 2");
  }
  EXPECT_EQ(num_new_starts, 1);
}

TEST_F(SilentSceneServerTest, ASceneServerStartedByHandThatDoesNotAnswerEndsTheSessionAtOnce) {
  patience_.until_passed_over = std::chrono::milliseconds(20);
  RunExecutor executor(&bus_, &registry_, Conditions(), {}, {}, {}, patience_);
  StaySilent();
  EXPECT_THAT([&] { executor.AskForProblem("cans", 2, [] { return false; }); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("asked for the problem cans 2, and whatever else it is asked for "
                                  "waits behind that: start it again"),
                        HasSubstr("it has answered nothing yet"), HasSubstr("ttl=0"))));
}

/// With a scene server whose failures are counted, as those of a child are.
class FailingVerdictTest : public RunExecutorTest {
 protected:
  /// As one that dies of a verdict, and then does not know the scene.
  PathCheckReplyMessage Fail() {
    ++num_failures_;
    throw InputError("no such scene");
  }

  std::atomic<int> num_failures_ = 0;
  const SupervisedServer supervised_{[this] { return num_failures_.load(); }, [] {}};
  RunExecutor counting_{&bus_, &registry_, Conditions(), {}, {}, supervised_};
  FakeSceneServer server_{&bus_};
};

TEST_F(FailingVerdictTest, ASceneServerThatFailsAtEveryVerdictIsItselfAtFault) {
  server_.OnPathCheck([&](const auto&) { return Fail(); });
  for (const int index : {1, 2}) EXPECT_FALSE(WasAsked(Execute(&counting_, Scheduled(index))));
  EXPECT_THAT([&] { Execute(&counting_, Scheduled(3)); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("the scene server fails whatever it is asked for: at cans 1, "
                                  "cans 2, cans 3, and"),
                        HasSubstr("the verdict on run/cans/3/"))));
}

TEST_F(FailingVerdictTest, ARunWhoseSimplifiedPathTheSceneServerFailsToJudgeIsToBeMadeAgain) {
  PlanResult result = FakePlanner::SolvedResult();
  result.simplified_path = {{0, 0}, {0.1, 0}, {1, 0.5}};
  AnswerWith(result);
  server_.OnPathCheck([&](const PathCheckRequestMessage& request) {
    if (request.path.size() == 2) return FakeSceneServer::Verdict(true);
    return Fail();
  });
  const RunRecordMessage record = Execute(&counting_);
  EXPECT_EQ(record.status, PlanStatus::kNoAnswer);
  EXPECT_THAT(record.message, HasSubstr("the verdict on run/cans/2/arm/backward/3/simplified"));
  EXPECT_FALSE(WasAsked(record));
  EXPECT_EQ(record.path_check, PathCheckReplyMessage()) << "of a path that is not recorded";
}

TEST_F(FailingVerdictTest, ARunWhosePathTheSceneServerFailsToJudgeIsToBeMadeAgain) {
  server_.OnPathCheck([&](const auto&) { return Fail(); });
  const std::string why = "twice the scene server died or fell silent when it was asked for ";
  const RunRecordMessage unjudged = Execute(&counting_);
  EXPECT_EQ(unjudged.status, PlanStatus::kNoAnswer);
  EXPECT_THAT(unjudged.message, testing::StartsWith("no verdict on its path: " + why));
  EXPECT_FALSE(WasAsked(unjudged));
  EXPECT_FALSE(IsUnjudgeable(unjudged));
  EXPECT_TRUE(unjudged.result.result.path.empty());
  const std::size_t num_requests = planner_.requests().messages().size();
  const RunRecordMessage next = Execute(&counting_);
  EXPECT_THAT(next.message, testing::StartsWith("no problem: " + why)) << "what is left of it";
  EXPECT_FALSE(WasAsked(next));
  EXPECT_EQ(planner_.requests().messages().size(), num_requests);
}

}  // namespace
}  // namespace planbench
