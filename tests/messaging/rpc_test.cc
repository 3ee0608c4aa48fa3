#include "messaging/rpc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <string>
#include <thread>

#include "messaging/channels.h"
#include "tests/support/message_collector.h"

namespace planbench {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using testing::HasSubstr;

using Client = RpcClient<ProblemRequestMessage, ProblemMessage>;
using Server = RpcServer<ProblemRequestMessage, ProblemMessage>;

constexpr milliseconds kRetry{20};

ProblemMessage Reply(const ProblemRequestMessage& request) {
  ProblemMessage reply;
  reply.problem_set = request.problem_set;
  reply.problem_index = request.problem_index;
  reply.scene_id = "scene";
  return reply;
}

class RpcTest : public testing::Test {
 protected:
  RpcTest() { bus_.Start(); }

  void Send(const ProblemRequestMessage& request) {
    bus_.Publish(channel::kProblemRequest, request);
  }

  Bus bus_{"memq://"};
  Client client_{&bus_, channel::kProblemRequest, channel::kProblem};
};

class RpcServerTest : public RpcTest {
 protected:
  ProblemMessage Answer(const ProblemRequestMessage& request) {
    if (request.problem_set == "unknown") throw InputError("no such set");
    ++num_answers_;
    if (request.problem_set == "slow") released_.wait();
    return Reply(request);
  }

  std::atomic<int> num_answers_ = 0;
  std::promise<void> release_;
  std::shared_future<void> released_ = release_.get_future().share();
  MessageCollector<ProblemMessage> replies_{&bus_, channel::kProblem};
  Server server_{&bus_, channel::kProblemRequest, channel::kProblem,
                 [this](const ProblemRequestMessage& request) { return Answer(request); }};
};

TEST_F(RpcServerTest, AnswersByTheRequestsId) {
  const auto reply = client_.Call({"id", "set", 7}, kRetry, kTestPatience);
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->ok);
  EXPECT_EQ(reply->request_id, "id");
  EXPECT_EQ(reply->problem_index, 7);
}

TEST_F(RpcServerTest, AnswersARepeatedRequestFromTheCache) {
  Send({"id", "set", 1});
  ASSERT_EQ(replies_.WaitFor(1).size(), 1u);
  Send({"id", "set", 1});
  const auto replies = replies_.WaitFor(2);
  ASSERT_EQ(replies.size(), 2u);
  EXPECT_EQ(replies[1].request_id, "id");
  EXPECT_EQ(num_answers_, 1);
}

TEST_F(RpcServerTest, ForgetsTheOldestAnswers) {
  for (std::size_t i = 0; i <= AnswerMemory::kCapacity; ++i) Send({std::to_string(i), "set", 1});
  ASSERT_EQ(replies_.WaitFor(AnswerMemory::kCapacity + 1).size(), AnswerMemory::kCapacity + 1);
  Send({"1", "set", 1});  // still there
  ASSERT_EQ(replies_.WaitFor(AnswerMemory::kCapacity + 2).size(), AnswerMemory::kCapacity + 2);
  EXPECT_EQ(num_answers_, static_cast<int>(AnswerMemory::kCapacity) + 1);
  Send({"0", "set", 1});
  ASSERT_EQ(replies_.WaitFor(AnswerMemory::kCapacity + 3).size(), AnswerMemory::kCapacity + 3);
  EXPECT_EQ(num_answers_, static_cast<int>(AnswerMemory::kCapacity) + 2);
}

TEST(AnswerMemory, HoldsNoMoreBytesThanItMayButTheLastAnswer) {
  AnswerMemory answers(100);
  const auto holds = [&](const char* id) { return answers.Find(id) != nullptr; };
  answers.Add("a", std::vector<std::uint8_t>(50));
  answers.Add("b", std::vector<std::uint8_t>(50));
  EXPECT_TRUE(holds("a") && holds("b"));
  answers.Add("c", std::vector<std::uint8_t>(1));
  EXPECT_TRUE(!holds("a") && holds("b") && holds("c"));
  EXPECT_EQ(answers.Add("d", std::vector<std::uint8_t>(101)).size(), 101u);
  EXPECT_TRUE(!holds("b") && !holds("c") && holds("d"));
  answers.Add("e", std::vector<std::uint8_t>(100));
  EXPECT_TRUE(!holds("d") && holds("e"));
}

TEST_F(RpcServerTest, DoesNotQueueARequestTwice) {
  Send({"first", "slow", 1});
  ASSERT_TRUE(WaitUntil([&] { return num_answers_ == 1; }));
  Send({"first", "slow", 1});  // being answered
  Send({"second", "set", 1});
  Send({"second", "set", 1});  // waiting
  Send({"last", "set", 1});
  // All of them have been taken in once this has been.
  MessageCollector<DiscoverMessage> barrier(&bus_, channel::kDiscover);
  bus_.Publish(channel::kDiscover, DiscoverMessage{"test"});
  ASSERT_EQ(barrier.WaitFor(1).size(), 1u);
  release_.set_value();
  ASSERT_TRUE(replies_.WaitForOne([](const ProblemMessage& r) { return r.request_id == "last"; }));
  EXPECT_EQ(num_answers_, 3);
  EXPECT_EQ(replies_.messages().size(), 3u);
}

TEST_F(RpcServerTest, DropsWhatComesWhenTooManyRequestsWait) {
  Send({"slow", "slow", 1});
  ASSERT_TRUE(WaitUntil([&] { return num_answers_ == 1; }));
  MessageCollector<DiscoverMessage> barriers(&bus_, channel::kDiscover);
  std::size_t num_sent = 0;
  for (std::size_t num_barriers = 1; num_sent <= Server::kMostWaiting; ++num_barriers) {
    // Fewer at once than the bus itself drops.
    for (int i = 0; i < 100; ++i) Send({std::to_string(num_sent++), "set", 1});
    bus_.Publish(channel::kDiscover, DiscoverMessage{"test"});
    ASSERT_EQ(barriers.WaitFor(num_barriers).size(), num_barriers);
  }
  release_.set_value();
  // Comes after all that wait.
  EXPECT_TRUE(client_.Call({"another", "set", 1}, kRetry, kTestPatience));
  EXPECT_EQ(num_answers_, static_cast<int>(Server::kMostWaiting) + 2);
}

TEST_F(RpcServerTest, InputErrorsBecomeRefusals) {
  const auto reply = client_.Call({"id", "unknown", 1}, kRetry, kTestPatience);
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->ok);
  EXPECT_EQ(reply->message, "no such set");
}

TEST_F(RpcServerTest, RefusesAMalformedRequestByItsId) {
  const auto reply = client_.Call({"id", "set", -3}, kRetry, kTestPatience);
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->ok);
  EXPECT_THAT(reply->message, HasSubstr(channel::kProblemRequest));
  EXPECT_THAT(reply->message, HasSubstr("problem_index"));
  EXPECT_EQ(num_answers_, 0);
}

TEST_F(RpcServerTest, RefusesARequestThatIsCutBehindItsId) {
  std::vector<std::uint8_t> bytes = Encode(ProblemRequestMessage{"id", "set", 1});
  bytes.pop_back();
  bus_.PublishBytes(channel::kProblemRequest, bytes);
  const std::vector<ProblemMessage> replies = replies_.WaitFor(1);
  ASSERT_EQ(replies.size(), 1u);
  EXPECT_EQ(replies[0].request_id, "id");
  EXPECT_FALSE(replies[0].ok);
  EXPECT_THAT(replies[0].message, HasSubstr("truncated or damaged lcmt_problem_request"));
}

TEST_F(RpcServerTest, ASpoiledCopyOfARequestThatWasTakenChangesNothing) {
  Send({"id", "slow", 1});
  ASSERT_TRUE(WaitUntil([&] { return num_answers_ == 1; }));
  Send({"id", "slow", -3});  // being answered
  MessageCollector<DiscoverMessage> barrier(&bus_, channel::kDiscover);
  bus_.Publish(channel::kDiscover, DiscoverMessage{"test"});
  ASSERT_EQ(barrier.WaitFor(1).size(), 1u);
  release_.set_value();
  ASSERT_EQ(replies_.WaitFor(1).size(), 1u);
  Send({"id", "slow", -3});  // answered
  EXPECT_TRUE(client_.Call({"another", "set", 1}, kRetry, kTestPatience));
  for (const ProblemMessage& reply : replies_.messages()) EXPECT_TRUE(reply.ok) << reply.message;
}

TEST_F(RpcServerTest, MalformedRequestWithoutIdIsDropped) {
  Send({"", "set", 1});
  bus_.PublishBytes(channel::kProblemRequest, std::vector<std::uint8_t>{1, 2, 3});
  EXPECT_TRUE(client_.Call({"id", "set", 1}, kRetry, kTestPatience));
  for (const ProblemMessage& reply : replies_.messages()) EXPECT_EQ(reply.request_id, "id");
  EXPECT_EQ(num_answers_, 1);
}

TEST_F(RpcServerTest, CallsFromSeveralThreadsGetTheirOwnReplies) {
  std::vector<std::thread> callers;
  std::atomic<int> num_right = 0;
  for (int caller = 0; caller < 8; ++caller) {
    callers.emplace_back([&, caller] {
      for (int i = 0; i < 20; ++i) {
        const std::string id = std::to_string(caller) + "/" + std::to_string(i);
        const auto reply = client_.Call({id, "set", 100 * caller + i}, kRetry, kTestPatience);
        num_right += reply && reply->request_id == id && reply->problem_index == 100 * caller + i;
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(num_right, 8 * 20);
  EXPECT_EQ(num_answers_, 8 * 20);
}

TEST_F(RpcTest, ServerEndsWithRequestsWaiting) {
  std::atomic<int> num_answers = 0;
  std::promise<void> release;
  auto server = std::make_unique<Server>(&bus_, channel::kProblemRequest, channel::kProblem,
                                         [&](const ProblemRequestMessage& request) {
                                           if (++num_answers == 1) release.get_future().wait();
                                           return Reply(request);
                                         });
  for (int i = 0; i < 10; ++i) Send({std::to_string(i), "set", 1});
  ASSERT_TRUE(WaitUntil([&] { return num_answers == 1; }));
  std::thread releaser([&] { release.set_value(); });
  server.reset();  // must not hang
  releaser.join();
  EXPECT_LE(num_answers, 10);
}

TEST_F(RpcTest, AsksAgainUntilTheReplyArrives) {
  std::atomic<int> num_requests = 0;
  const Subscription forgetful = bus_.Subscribe<ProblemRequestMessage>(
      channel::kProblemRequest, [&](const ProblemRequestMessage& request) {
        if (++num_requests < 3) return;  // as if the reply had been lost
        ProblemMessage reply = Reply(request);
        reply.request_id = "of another caller";
        bus_.Publish(channel::kProblem, reply);
        reply.request_id = request.request_id;
        bus_.Publish(channel::kProblem, reply);
      });
  const auto reply = client_.Call({"id", "set", 1}, kRetry, kTestPatience);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->request_id, "id");
  EXPECT_GE(num_requests, 3);
}

TEST_F(RpcTest, TimesOut) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(client_.Call({"id", "set", 1}, kRetry, milliseconds(100)));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(100));
}

TEST_F(RpcTest, GivesUpWhenTold) {
  MessageCollector<ProblemRequestMessage> requests(&bus_, channel::kProblemRequest);
  EXPECT_FALSE(client_.Call({"id", "set", 1}, kRetry, hours(1),
                            [&] { return requests.messages().size() >= 2; }));
}

TEST_F(RpcTest, ReplyThatComesAfterTheTimeoutIsForgotten) {
  EXPECT_FALSE(client_.Call({"id", "set", 1}, kRetry, milliseconds(1)));
  ProblemMessage late = Reply({"id", "set", 1});
  late.request_id = "id";
  MessageCollector<ProblemMessage> replies(&bus_, channel::kProblem);
  bus_.Publish(channel::kProblem, late);
  ASSERT_EQ(replies.WaitFor(1).size(), 1u);
  EXPECT_FALSE(client_.Call({"id", "set", 1}, kRetry, milliseconds(1)));
}

}  // namespace
}  // namespace planbench
