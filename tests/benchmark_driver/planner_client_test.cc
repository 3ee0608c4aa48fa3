#include "benchmark_driver/planner_client.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <future>

#include "tests/benchmark_driver/fake_nodes.h"
#include "tests/benchmark_driver/idle_process.h"
#include "tests/support/private_bus.h"
#include "tests/support/wait_until.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using Verdict = PlanAckVerdict;

class PlannerClientTest : public testing::Test {
 protected:
  explicit PlannerClientTest(const std::string& url = "memq://") : bus_(url) { bus_.Start(); }

  static PlanRequest Request(const std::string& id) {
    PlanRequest request;
    request.run_id = "run";
    request.request_id = id;
    request.scene_id = "scene";
    request.time_limit_s = 3600;
    return request;
  }
  static PlannerClient::Terms Impatient() {
    PlannerClient::Terms terms;
    terms.patience = std::chrono::milliseconds(200);
    return terms;
  }
  PlannerClient::Answer Solve(const std::string& id) {
    return client_.Solve(Request(id), [this] { return interrupted_.load(); });
  }
  std::future<PlannerClient::Answer> BeginToSolve(const std::string& id) {
    return std::async(std::launch::async, [this, id] { return Solve(id); });
  }

  Bus bus_;
  NodeRegistry registry_{&bus_};
  PlannerClient client_{&bus_, &registry_, "arm"};
  std::atomic<bool> interrupted_ = false;
};

/// The planner and somebody else have connections of their own.
class PlannerClientOnASharedBusTest : public PlannerClientTest {
 protected:
  explicit PlannerClientOnASharedBusTest(const std::string& url = PrivateUdpUrl())
      : PlannerClientTest(url), planner_bus_(url), other_bus_(url) {
    planner_bus_.Start();
    other_bus_.Start();
  }

  const PlannerChannels channels_{"arm"};
  Bus planner_bus_, other_bus_;
};

TEST_F(PlannerClientTest, ReturnsTheResult) {
  const FakePlanner planner(&bus_);
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kResult);
  EXPECT_EQ(answer.result.request_id, "a");
  EXPECT_EQ(answer.result.result.path, FakePath());
  EXPECT_GT(answer.roundtrip_time_s, 0);
  EXPECT_EQ(Solve("b").result.request_id, "b");
}

TEST_F(PlannerClientTest, WaitsForThePlannerToCome) {
  auto answer = BeginToSolve("a");
  const FakePlanner planner(&bus_);
  EXPECT_EQ(answer.get().outcome, PlannerClient::Outcome::kResult);
}

TEST_F(PlannerClientTest, WaitingForThePlannerCanBeInterrupted) {
  auto answer = BeginToSolve("a");
  interrupted_ = true;
  EXPECT_EQ(answer.get().outcome, PlannerClient::Outcome::kInterrupted);
}

TEST_F(PlannerClientTest, AsksAgainUntilTheResultComes) {
  std::atomic<int> num_requests = 0;
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    ++num_requests;  // the first was lost, the second is worked on, the third one's result is lost
    if (num_requests == 2) planner.Acknowledge(request, Verdict::kWorking);
    if (num_requests == 4) planner.Solve(request);
  });
  EXPECT_EQ(Solve("a").outcome, PlannerClient::Outcome::kResult);
}

TEST_F(PlannerClientTest, ResultsOfOtherRequestsAreNoConcern) {
  FakePlanner planner(&bus_);
  planner.SendResult("before", FakePlanner::SolvedResult());
  planner.OnRequest([&](const PlanRequest& request) {
    planner.SendResult("former", FakePlanner::SolvedResult());
    planner.Solve(request);
    planner.Solve(request);  // as if the request had been repeated
  });
  EXPECT_EQ(Solve("a").result.request_id, "a");
  EXPECT_EQ(Solve("b").result.request_id, "b");
}

TEST_F(PlannerClientTest, RefusalSaysWhy) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    planner.Acknowledge(request, Verdict::kRefused, "another robot");
  });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kRefused);
  EXPECT_EQ(answer.message, "another robot");
}

TEST_F(PlannerClientTest, ResultThatCannotBeReadEndsTheRequest) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    PlanResult result = FakePlanner::SolvedResult();
    result.planning_time_s = -1;
    planner.SendResult(request.request_id, result);
  });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kNoAnswer);
  EXPECT_THAT(answer.message, HasSubstr("planning_time_s"));
}

TEST_F(PlannerClientTest, ResultOfAnotherSessionOrPlannerIsNoAnswer) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    PlanResultMessage result;
    result.planner = "arm";
    result.run_id = "another";
    result.request_id = request.request_id;
    bus_.Publish(PlannerChannels("arm").result, result);
  });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kNoAnswer);
  EXPECT_THAT(answer.message, HasSubstr("session 'another'"));
}

TEST_F(PlannerClientTest, AnotherResultThanBeforeIsNoted) {
  FakePlanner planner(&bus_);
  EXPECT_EQ(Solve("a").outcome, PlannerClient::Outcome::kResult);
  planner.SendResult("a", FakePlanner::SolvedResult());  // the same, again
  PlanResult other = FakePlanner::SolvedResult();
  other.planning_time_s = 1e-6;
  planner.SendResult("a", other);
  EXPECT_TRUE(WaitUntil([&] { return bus_.contradictions().count() == 1; }));
  EXPECT_EQ(Solve("b").outcome, PlannerClient::Outcome::kResult);
}

TEST_F(PlannerClientTest, OfTwoResultsSentAtOnceTheFirstCountsAndTheOtherIsNoted) {
  FakePlanner planner(&bus_);
  planner.OnRequest([](const PlanRequest&) {});
  PlanResult other;
  other.status = PlanStatus::kExhausted;
  std::atomic<bool> sent = false;
  // Both have come before either is taken: the client asks this while it waits.
  const auto send_both = [&] {
    if (planner.requests().messages().empty() || sent.exchange(true)) return false;
    planner.SendResult("a", FakePlanner::SolvedResult());
    planner.SendResult("a", FakePlanner::SolvedResult());
    planner.SendResult("a", other);
    bus_.Publish(PlannerChannels("arm").cancel, PlanCancelMessage{"a"});
    EXPECT_EQ(planner.cancels().WaitFor(1).size(), 1u) << "what was sent before has been handled";
    return false;
  };
  const PlannerClient::Answer answer = client_.Solve(Request("a"), send_both);
  EXPECT_EQ(answer.result.result.status, PlanStatus::kSolved);
  EXPECT_EQ(bus_.contradictions().count(), 1);
}

TEST_F(PlannerClientOnASharedBusTest, OnlyTheProcessAskedIsListenedTo) {
  std::atomic<int> num_requests = 0;
  FakePlanner planner(&planner_bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    if (++num_requests >= 3) planner.Solve(request);
  });
  // Everything right but for the sender: a refusal, a result, a result that cannot be read.
  const Subscription forger =
      other_bus_.Subscribe<PlanRequest>(channels_.request, [&](const PlanRequest& request) {
        other_bus_.Publish(channels_.ack,
                           PlanAckMessage{"arm", request.request_id, Verdict::kRefused, "forged"});
        PlanResultMessage result;
        result.planner = "arm";
        result.run_id = request.run_id;
        result.request_id = request.request_id;
        result.result.status = PlanStatus::kExhausted;
        other_bus_.Publish(channels_.result, result);
        result.result.planning_time_s = -1;
        other_bus_.Publish(channels_.result, result);
      });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kResult) << answer.message;
  EXPECT_EQ(answer.result.result.path, FakePath());
  EXPECT_GE(bus_.contradictions().count(), 3);
}

TEST_F(PlannerClientOnASharedBusTest, NoAnswerTellsWhatWasRefused) {
  FakePlanner planner(&planner_bus_);
  // The planner's own answer, from another connection than its announcements, until that has been
  // heard; then one that ends the request.
  planner.OnRequest([&](const PlanRequest& request) {
    if (bus_.contradictions().count() > 0) {
      PlanResult unusable = FakePlanner::SolvedResult();
      unusable.path.clear();
      return planner.SendResult(request.request_id, unusable);
    }
    other_bus_.Publish(channels_.ack,
                       PlanAckMessage{"arm", request.request_id, Verdict::kWorking, ""});
  });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kNoAnswer);
  EXPECT_THAT(answer.message,
              testing::AllOf(HasSubstr("but it has no path; refused: what came on PLAN_ACK_ARM "),
                             HasSubstr(bus_.contradictions().entries().at(0).sender)));
}

TEST_F(PlannerClientOnASharedBusTest, TheEndOfAProcessThatOnlyHasItsIdIsNoConcern) {
  const pid_t pid = StartProcess();
  FakePlanner planner(&planner_bus_);  // on a host of the same name, say
  planner.status.pid = pid;
  Reannounce(&registry_, &planner);
  EXPECT_EQ(Solve("a").outcome, PlannerClient::Outcome::kResult);
  EndProcess(pid);
  EXPECT_EQ(Solve("b").outcome, PlannerClient::Outcome::kResult);
}

TEST_F(PlannerClientTest, PlannerThatDiesGivesNoAnswer) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest&) { planner.FallSilent(); });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kNoAnswer);
  EXPECT_THAT(answer.message, HasSubstr("died"));
}

TEST_F(PlannerClientTest, PlannerThatWasRestartedGivesNoAnswer) {
  FakePlanner planner(&bus_);
  planner.OnRequest([](const PlanRequest&) {});
  auto answer = BeginToSolve("a");
  ASSERT_FALSE(planner.requests().WaitFor(1).empty());
  planner.Restart();
  const PlannerClient::Answer given = answer.get();
  EXPECT_EQ(given.outcome, PlannerClient::Outcome::kNoAnswer);
  EXPECT_THAT(given.message, HasSubstr("restarted"));
  // The next request is the new process's.
  planner.OnRequest([&](const PlanRequest& request) { planner.Solve(request); });
  EXPECT_EQ(Solve("b").outcome, PlannerClient::Outcome::kResult);
}

TEST_F(PlannerClientTest, AProcessThatEndsIsNotedAtOnce) {
  const pid_t pid = StartProcess();
  FakePlanner planner(&bus_);  // goes on to be announced, as if its end were to be noticed yet
  planner.status.pid = pid;
  Reannounce(&registry_, &planner);
  planner.OnRequest([&](const PlanRequest&) { EndProcess(pid); });
  const PlannerClient::Answer answer = Solve("a");
  EXPECT_EQ(answer.message, "the process ended");
  EXPECT_EQ(planner.requests().messages().size(), 1u) << "its successor would die of it too";
  EXPECT_FALSE(client_.ExpectAnother()) << "its successor, which may be there, is new";
  // Nor is it asked again.
  auto next = BeginToSolve("b");
  planner.status.pid = getpid();
  Reannounce(&registry_, &planner);
  planner.OnRequest([&](const PlanRequest& request) { planner.Solve(request); });
  EXPECT_EQ(next.get().outcome, PlannerClient::Outcome::kResult);
}

TEST_F(PlannerClientTest, HowAProcessEndedIsToldAlsoIfThatIsKnownALittleLater) {
  const pid_t pid = StartProcess();
  FakePlanner planner(&bus_);
  planner.status.pid = pid;
  Reannounce(&registry_, &planner);
  planner.OnRequest([&](const PlanRequest&) { EndProcess(pid); });
  PlannerClient::Terms terms;
  int num_asked = 0;
  terms.how_ended = [&](auto since) {
    EXPECT_LE(since, std::chrono::steady_clock::now());
    return ++num_asked < 3 ? "" : "by signal 9";
  };
  PlannerClient client(&bus_, &registry_, "arm", terms);
  const PlannerClient::Answer answer = client.Solve(Request("a"), [] { return false; });
  EXPECT_EQ(answer.message, "the process ended by signal 9");
}

TEST_F(PlannerClientTest, OneThatHasEndedIsNotAtItsRequestAnyMore) {
  const pid_t pid = StartProcess();
  FakePlanner planner(&bus_);
  planner.status.pid = pid;
  Reannounce(&registry_, &planner);
  planner.OnRequest([&](const PlanRequest&) { EndProcess(pid); });
  PlannerClient client(&bus_, &registry_, "arm", Impatient());
  const auto solve = [&](const std::string& id) {
    return client.Solve(Request(id), [] { return false; });
  };
  EXPECT_EQ(solve("a").message, "the process ended");
  EXPECT_EQ(solve("b").message, "given up: it was not on the bus for 0.2 s");
}

TEST_F(PlannerClientTest, AProcessIsColdUntilItHasGivenAResult) {
  EXPECT_FALSE(client_.IsCold()) << "there is none";
  FakePlanner planner(&bus_);
  for (const char* time : {"first", "second"}) {
    Reannounce(&registry_, &planner);
    EXPECT_TRUE(client_.IsCold());
    planner.OnRequest(
        [&](const PlanRequest& request) { planner.Acknowledge(request, Verdict::kRefused, "no"); });
    EXPECT_EQ(Solve(fmt::format("{} a", time)).outcome, PlannerClient::Outcome::kRefused);
    EXPECT_TRUE(client_.IsCold());
    planner.OnRequest([&](const PlanRequest& request) { planner.Solve(request); });
    EXPECT_EQ(Solve(fmt::format("{} b", time)).outcome, PlannerClient::Outcome::kResult);
    EXPECT_FALSE(client_.IsCold());
  }
}

TEST_F(PlannerClientTest, APlannerThatComesBackAsAnotherIsNotAsked) {
  FakePlanner planner(&bus_);
  PlannerClient client(&bus_, &registry_, "arm", {.expected = planner.status});
  const auto solve = [&](const std::string& id) {
    return client.Solve(Request(id), [] { return false; });
  };
  EXPECT_EQ(solve("a").outcome, PlannerClient::Outcome::kResult);
  planner.status.settings["step"] = "6";
  Reannounce(&registry_, &planner);
  const PlannerClient::Answer answer = solve("b");
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kNoAnswer);
  EXPECT_THAT(answer.message, HasSubstr("node[arm].setting[step].value is \"6\", was \"5\""));
  EXPECT_EQ(planner.requests().messages().size(), 1u);
  EXPECT_FALSE(client.IsCold()) << "it is not to be asked to warm up either";
  planner.status.settings["step"] = "5";
  Reannounce(&registry_, &planner);
  EXPECT_EQ(solve("c").outcome, PlannerClient::Outcome::kResult);
}

TEST_F(PlannerClientTest, APlannerThatIsGivenUpIsNotWaitedFor) {
  std::atomic<bool> given_up = false;
  PlannerClient client(&bus_, &registry_, "arm", {.given_up = [&] {
    return given_up ? std::string("given up: it died") : "";
  }});
  auto answer = std::async(std::launch::async,
                           [&] { return client.Solve(Request("a"), [] { return false; }); });
  given_up = true;
  EXPECT_EQ(answer.get().message, "given up: it died");
  EXPECT_EQ(client.Solve(Request("b"), [] { return false; }).outcome,
            PlannerClient::Outcome::kNoAnswer);
  FakePlanner planner(&bus_);
  Reannounce(&registry_, &planner);
  EXPECT_FALSE(client.IsCold() || client.ExpectAnother()) << "though it has come";
  given_up = false;
  EXPECT_TRUE(client.IsCold() && client.ExpectAnother());
}

TEST_F(PlannerClientTest, OneThatStaysAwayIsGivenUpWhenItCannotBeAtItsRequestAnyMore) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest&) { planner.FallSilent(); });
  std::vector<std::string> told;
  PlannerClient::Terms terms = Impatient();
  terms.on_absence = [&](const std::string& why) { told.push_back(why); };
  PlannerClient client(&bus_, &registry_, "arm", terms);
  const auto solve = [&](const std::string& id) {
    PlanRequest request = Request(id);
    request.time_limit_s = 0.3;
    return client.Solve(request, [] { return false; });
  };
  EXPECT_THAT(solve("a").message, HasSubstr("died or fell silent"));
  testing::internal::CaptureStdout();  // Where messages go.
  const PlannerClient::Answer answer = solve("b");
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("waiting for the planner 'arm' to come (back) to the bus, 0.5 s at most"));
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kNoAnswer);
  EXPECT_EQ(answer.message, "given up: it was not on the bus for 0.5 s");
  EXPECT_EQ(answer.roundtrip_time_s, 0);
  Reannounce(&registry_, &planner);
  EXPECT_EQ(solve("c").message, answer.message);
  EXPECT_EQ(told, (std::vector<std::string>{"it was not on the bus for 0.5 s"}));
}

TEST_F(PlannerClientTest, OneThatWasToldToEndIsNotAskedThoughItIsLive) {
  FakePlanner planner(&bus_);
  EXPECT_EQ(Solve("a").outcome, PlannerClient::Outcome::kResult);
  EXPECT_TRUE(client_.ExpectAnother());
  std::future<PlannerClient::Answer> answer = BeginToSolve("b");
  EXPECT_EQ(answer.wait_for(std::chrono::milliseconds(200)), std::future_status::timeout);
  EXPECT_EQ(planner.requests().Count([](const auto& r) { return r.request_id == "b"; }), 0u);
  planner.Restart();
  EXPECT_EQ(answer.get().outcome, PlannerClient::Outcome::kResult);
}

TEST_F(PlannerClientTest, OneThatIsSilentAndRunsIsToBeToldToEnd) {
  FakePlanner planner(&bus_);
  EXPECT_EQ(Solve("a").outcome, PlannerClient::Outcome::kResult);
  planner.FallSilent();
  registry_.Forget(planner.status);  // as after a while
  EXPECT_TRUE(client_.ExpectAnother()) << "it would go on where it was";
  EXPECT_FALSE(client_.ExpectAnother()) << "it has been told";
}

TEST_F(PlannerClientTest, OneThatWasToldToEndAndStaysIsGivenUp) {
  FakePlanner planner(&bus_);
  Reannounce(&registry_, &planner);
  PlannerClient client(&bus_, &registry_, "arm", Impatient());
  EXPECT_TRUE(client.ExpectAnother());
  testing::internal::CaptureStdout();  // Where messages go.
  const PlannerClient::Answer answer = client.Solve(Request("a"), [] { return false; });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "") << "it may be short";
  EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kNoAnswer);
  EXPECT_EQ(answer.message,
            fmt::format("given up: its process (pid {}) was told to end, to be started anew, and "
                        "is on the bus 0.2 s later",
                        getpid()));
  EXPECT_EQ(answer.roundtrip_time_s, 0);
}

TEST_F(PlannerClientTest, OnceAnotherHasComeALaterAbsenceIsToldAtOnce) {
  FakePlanner planner(&bus_);
  Reannounce(&registry_, &planner);
  PlannerClient client(&bus_, &registry_, "arm", Impatient());
  EXPECT_TRUE(client.ExpectAnother());
  const pid_t pid = StartProcess();
  planner.status.pid = pid;
  Reannounce(&registry_, &planner);
  planner.OnRequest([&](const PlanRequest&) { EndProcess(pid); });
  const auto solve = [&](const std::string& id) {
    return client.Solve(Request(id), [] { return false; });
  };
  EXPECT_EQ(solve("a").message, "the process ended");
  testing::internal::CaptureStdout();  // Where messages go.
  EXPECT_EQ(solve("b").message, "given up: it was not on the bus for 0.2 s");
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("waiting for the planner 'arm'"));
}

TEST_F(PlannerClientTest, BusyCountsIfThePlannerAnnouncesAnotherRequest) {
  for (const bool announced : {true, false}) {
    std::atomic<int> num_requests = 0;
    FakePlanner planner(&bus_);
    planner.status.request_id = announced ? "another" : "";
    Reannounce(&registry_, &planner);
    planner.OnRequest([&](const PlanRequest& request) {
      if (++num_requests < 3) return planner.Acknowledge(request, Verdict::kBusy);
      planner.Solve(request);
    });
    const PlannerClient::Answer answer = Solve(announced ? "a" : "b");
    EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kResult);
    EXPECT_EQ(answer.roundtrip_time_s < 0.4, announced) << answer.roundtrip_time_s;
  }
}

TEST_F(PlannerClientTest, ASolutionHasAPathAndNothingElseHas) {
  FakePlanner planner(&bus_);
  PlanResult without_path = FakePlanner::SolvedResult();
  without_path.path.clear();
  PlanResult unsolved_path = FakePlanner::SolvedResult();
  unsolved_path.status = PlanStatus::kExhausted;
  int id = 0;
  for (const PlanResult& result : {without_path, unsolved_path}) {
    planner.OnRequest([&planner, result](const PlanRequest& request) {
      planner.SendResult(request.request_id, result);
    });
    const PlannerClient::Answer answer = Solve(std::to_string(++id));
    EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kNoAnswer);
    EXPECT_THAT(answer.message, HasSubstr("the result cannot be used: "));
  }
}

TEST_F(PlannerClientTest, APathThatAResultCannotHoldIsNoAnswer) {
  FakePlanner planner(&bus_);
  int id = 0;
  for (Path PlanResult::*const path : {&PlanResult::path, &PlanResult::simplified_path}) {
    const auto answer_with = [&](std::size_t num_waypoints) {
      PlanResult result = FakePlanner::SolvedResult();
      result.*path = Path(num_waypoints, Configuration{0, 0});
      planner.OnRequest([&planner, result](const PlanRequest& request) {
        planner.SendResult(request.request_id, result);
      });
      return Solve(std::to_string(++id));
    };
    const PlannerClient::Answer answer = answer_with(kMostResultWaypoints + 1);
    EXPECT_EQ(answer.outcome, PlannerClient::Outcome::kNoAnswer);
    EXPECT_EQ(answer.message,
              "the result cannot be used: path of 15001 waypoints; a result holds at most 15000");
    EXPECT_EQ(answer_with(kMostResultWaypoints).outcome, PlannerClient::Outcome::kResult);
  }
}

TEST_F(PlannerClientTest, InterruptionCancelsTheRequestUntilItsResultComes) {
  FakePlanner planner(&bus_);
  planner.OnRequest([](const PlanRequest&) {});
  std::atomic<int> num_cancels = 0;
  const Subscription cancels = bus_.Subscribe<PlanCancelMessage>(
      PlannerChannels("arm").cancel, [&](const PlanCancelMessage& cancel) {
        EXPECT_EQ(cancel.request_id, "a");
        if (++num_cancels == 2) planner.SendResult("a", {});  // the first was lost
      });
  auto answer = BeginToSolve("a");
  ASSERT_FALSE(planner.requests().WaitFor(1).empty());
  interrupted_ = true;
  EXPECT_EQ(answer.get().outcome, PlannerClient::Outcome::kInterrupted);
  EXPECT_EQ(num_cancels, 2);
}

}  // namespace
}  // namespace planbench
