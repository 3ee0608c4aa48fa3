#include "messaging/bus.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "messaging/multicast_receiver.h"
#include "tests/messaging/stranger.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/message_collector.h"
#include "tests/support/own_network.h"
#include "tests/support/private_bus.h"

namespace planbench {
namespace {

using testing::HasSubstr;

void PublishNumber(Bus* bus, const std::string& channel, int number) {
  bus->Publish(channel, DiscoverMessage{std::to_string(number)});
}

TEST(BusTest, HandlersMayThrow) {
  Bus bus("memq://");
  const Subscription standard = bus.Subscribe<DiscoverMessage>(
      "CHANNEL", [](const DiscoverMessage&) { throw std::runtime_error("first"); });
  const Subscription other =
      bus.Subscribe<DiscoverMessage>("CHANNEL", [](const DiscoverMessage&) { throw 1; });
  MessageCollector<DiscoverMessage> collector(&bus, "CHANNEL");
  bus.Start();
  for (int i = 0; i < 3; ++i) PublishNumber(&bus, "CHANNEL", i);
  const auto received = collector.WaitFor(3);
  ASSERT_EQ(received.size(), 3u);
  EXPECT_EQ(received[2].sender, "2");
}

TEST(BusTest, WhatHandlersThrowIsToldOncePerChannelAndText) {
  auto written = std::make_shared<std::ostringstream>();
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(*written)));
  {
    Bus bus("memq://");
    const auto fail = [](const DiscoverMessage& message) {
      throw std::runtime_error(message.sender);
    };
    const Subscription one = bus.Subscribe<DiscoverMessage>("ONE", fail);
    const Subscription two = bus.Subscribe<DiscoverMessage>("TWO", fail);
    MessageCollector<DiscoverMessage> collector(&bus, "LAST");
    for (int i = 0; i < 8; ++i) PublishNumber(&bus, i % 2 == 0 ? "ONE" : "TWO", i / 4);
    for (int i = 0; i < 400; ++i) PublishNumber(&bus, "ONE", i);
    PublishNumber(&bus, "LAST", 0);
    bus.Start();
    EXPECT_EQ(collector.WaitFor(1).size(), 1u);
  }
  spdlog::set_default_logger(before);
  const std::string text = written->str();
  const auto times = [&](const std::string& part) {
    int count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(times("ONE dropped: 0 (told once)"), 1) << text;
  EXPECT_EQ(times("TWO dropped: 1 (told once)"), 1) << text;
  EXPECT_EQ(times("(told once)"), 256);
  EXPECT_EQ(times("only counted"), 1);
  EXPECT_EQ(times("408 messages on the bus could not be used"), 1) << text;
}

TEST(BusTest, ArrivalIsToldOnTheSteadyClock) {
  using Clock = std::chrono::steady_clock;
  Bus bus("memq://");
  std::promise<std::pair<Clock::time_point, Clock::time_point>> arrival_and_now;
  const Subscription subscription = bus.SubscribeFrom<DiscoverMessage>(
      "CHANNEL", [&](const DiscoverMessage&, const Origin& origin) {
        arrival_and_now.set_value({origin.arrival, Clock::now()});
      });
  const Clock::time_point before = Clock::now();
  PublishNumber(&bus, "CHANNEL", 1);
  bus.Start();
  const auto [at, now] = arrival_and_now.get_future().get();
  EXPECT_GE(at, before);
  EXPECT_LE(at, now);
}

TEST(BusTest, UndecodableMessagesGoToTheirHandlerOrAreDropped) {
  Bus bus("memq://");
  std::promise<std::string> refused;
  const Subscription with_refusal = bus.Subscribe<ProblemRequestMessage>(
      "CHANNEL", [](const ProblemRequestMessage&) { FAIL() << "not to be decoded"; },
      [&](const MessageError& error) {
        refused.set_value(error.request_id() + ": " + error.what());
      });
  const Subscription without = bus.Subscribe<ProblemRequestMessage>(
      "CHANNEL", [](const ProblemRequestMessage&) { FAIL() << "not to be decoded"; });
  MessageCollector<DiscoverMessage> alive(&bus, "ALIVE");
  bus.Start();
  bus.Publish("CHANNEL", ProblemRequestMessage{"the id", "set", -1});
  PublishNumber(&bus, "ALIVE", 1);
  EXPECT_EQ(alive.WaitFor(1).size(), 1u);
  const std::string said = refused.get_future().get();
  EXPECT_THAT(said, HasSubstr("the id: "));
  EXPECT_THAT(said, HasSubstr("CHANNEL"));
  EXPECT_THAT(said, HasSubstr("problem_index"));
}

TEST(BusTest, BadUrlIsAnInputErrorOfOneLine) {
  ExpectInputError([] { Bus("carrierpigeon://loft"); }, {"carrierpigeon://loft"});
  ExpectInputError([] { Bus("tcpq://127.0.0.1:7700"); }, {"tcpq://127.0.0.1:7700", "udpm://"});
  ExpectInputError([] { Bus("nothing like a URL"); }, {"nothing like a URL"});
  ExpectInputError([] { Bus("udpm://not-an-address"); }, {"udpm://not-an-address"});
  for (const char* option :
       {"recv_buf_size=999999999999", "recv_buf_size=abc", "recv_buf_size=-1", "recv_buf_size=5x",
        "recv_buf_size=", "recv_buf_size", "ttl=0x1", "ttl=256"}) {
    const std::string url = std::string("udpm://239.255.76.67:7667?ttl=0&") + option;
    ExpectInputError([&] { MulticastAddress::Parse(url); }, {url, "whole number from 0 to"});
  }
  EXPECT_EQ(MulticastAddress::Parse("udpm://?ttl=1&recv_buf_size=2147483647").receive_buffer_bytes,
            2147483647);
}

TEST(BusTest, WithoutMulticastRouteSaysHowToMendIt) {
  for (const int ttl : {0, 1}) {
    const std::optional<std::string> said = InOwnNetwork([&] {
      try {
        Bus bus(fmt::format("udpm://239.255.76.67:7667?ttl={}", ttl));
      } catch (const InputError& error) {
        return std::string(error.what());
      }
      return std::string("nothing was thrown");
    });
    if (!said) GTEST_SKIP() << "this process may not make a network of its own";
    EXPECT_THAT(*said, HasSubstr("multicast route"));
    EXPECT_THAT(*said, HasSubstr(ttl == 0 ? "ip route add 224.0.0.0/4 dev lo"
                                          : "ip route replace 224.0.0.0/4 dev INTERFACE"));
    EXPECT_EQ(said->find('\n'), std::string::npos) << *said;
  }
}

TEST(BusTest, IsHeardAgainWhenItsInterfaceWasAway) {
  const std::string make = fmt::format("{} && {}", kMakeWire, kRouteByWire);
  const std::optional<std::string> said = InOwnNetwork([&]() -> std::string {
    if (!RunsInShell(make)) return "no wire";
    Bus bus("udpm://239.255.76.67:7667?ttl=1");
    MessageCollector<DiscoverMessage> collector(&bus, "CHANNEL");
    bus.Start();
    const auto is_heard = [&] {
      const std::size_t before = collector.messages().size();
      return WaitUntil([&] {
        PublishNumber(&bus, "CHANNEL", 1);
        return collector.messages().size() > before;
      });
    };
    if (!is_heard()) return "not heard";
    // Once noticed while it is away, once not.
    for (const char* pause : {"sleep 0", "sleep 1.5"}) {
      if (!RunsInShell(fmt::format("ip link del wire && {} && {}", pause, make))) return "no wire";
      if (!is_heard()) return fmt::format("deaf after {}", pause);
    }
    return "heard";
  });
  if (!said || *said == "no wire") GTEST_SKIP() << "needs a network of its own";
  EXPECT_EQ(*said, "heard");
}

TEST(BusTest, LargeMessageArrivesWhole) {
  const std::string url = PrivateUdpUrl();
  Bus sender(url);
  Bus receiver(url);
  MessageCollector<DiscoverMessage> collector(&receiver, "LARGE");
  receiver.Start();
  std::string text(1'000'000, ' ');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>('a' + i % 23);
  // Where the kernel caps the receive buffer some are lost: that is what the repetitions of every
  // request are for.
  ASSERT_TRUE(WaitUntil([&] {
    sender.Publish("LARGE", DiscoverMessage{text});
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return !collector.messages().empty();
  }));
  EXPECT_TRUE(collector.messages().front().sender == text);
}

std::string SmallPacket(const std::string& after_header) {
  return std::string("LC02\0\0\0\1", 8) + after_header;
}

TEST(MulticastReceiverTest, LeavesToTheKernelWhatIsOnOtherChannels) {
  const std::string url = PrivateUdpUrl();
  std::mutex mutex;
  std::vector<std::string> received;
  MulticastReceiver receiver(MulticastAddress::Parse(url),
                             [&](const PacketSender&, std::span<const std::uint8_t> packet) {
                               const std::scoped_lock lock(mutex);
                               received.emplace_back(packet.begin(), packet.end());
                             });
  const Stranger stranger(url);
  const auto message = [](const std::string& channel) {
    return SmallPacket(channel + std::string("\0bytes", 6));
  };
  const std::vector<std::string> packets = {
      message("A"),     message("AB"),     message("ABC"),
      message("ABCD"),  message("ABCDE"),  message("ABCDEF"),
      message("ABCDX"), message("BABCDE"), message("X"),
      message(""),      "of no protocol",  std::string("LC03") + std::string(20, 'f')};
  const auto passed = [&](const std::optional<std::set<std::string>>& channels) {
    receiver.Hear(channels);
    for (const std::string& packet : packets) stranger.Send(packet);
    // Packets come in order: whatever is heard, this is the last.
    const std::string last = "the end";
    stranger.Send(last);
    const auto at_end = [&] {
      const std::scoped_lock lock(mutex);
      return !received.empty() && received.back() == last;
    };
    EXPECT_TRUE(WaitUntil(at_end));
    const std::scoped_lock lock(mutex);
    received.pop_back();
    return std::exchange(received, {});
  };
  EXPECT_EQ(passed(std::nullopt), packets);
  EXPECT_EQ(
      passed(std::set<std::string>{"AB", "ABCDE", "X", "XY"}),
      (std::vector<std::string>{packets[1], packets[4], packets[8], packets[10], packets[11]}));
  EXPECT_EQ(passed(std::set<std::string>{}), (std::vector<std::string>{packets[10], packets[11]}));
  // More than the kernel takes.
  std::set<std::string> many;
  for (int i = 1000; i < 2000; ++i) many.insert(std::string(40, 'A') + std::to_string(i));
  EXPECT_EQ(passed(many), packets);
}

/// A bus on the network that hears everything.
class OpenBusTest : public testing::Test {
 protected:
  OpenBusTest() { bus_.Start(); }
  /// Publishes a message; expects that it and no other arrives, in spite of what was sent before.
  void ExpectOnlyTheNext() {
    PublishNumber(&bus_, "CHANNEL", 1);
    EXPECT_EQ(collector_.WaitFor(1).size(), 1u);
    EXPECT_EQ(num_received_, 1);
  }

  const std::string url_ = PrivateUdpUrl();
  Bus bus_{url_};
  std::atomic<int> num_received_ = 0;
  const Subscription all_ =
      bus_.SubscribeToAll([this](const ReceivedMessage&) { ++num_received_; }, 0);
  MessageCollector<DiscoverMessage> collector_{&bus_, "CHANNEL"};
};

TEST_F(OpenBusTest, PacketsOfNoMeaningAreCountedAndHarmNobody) {
  const Stranger stranger(url_);
  const std::vector<std::string> packets = {
      "",
      "LC02",
      SmallPacket(""),
      SmallPacket("NO TERMINATING ZERO"),
      SmallPacket({"\0", 1}),
      SmallPacket(std::string(64, 'A') + std::string(1, '\0')),
      std::string(60000, '\xff'),
      std::string("LC03\0\0\0\1\xff\xff\xff\xff\0\0\0\0\0\0\xff\xff"
                  "A\0",
                  22)};
  for (const std::string& packet : packets) stranger.Send(packet);
  ExpectOnlyTheNext();
  EXPECT_EQ(bus_.counters().malformed, static_cast<std::int64_t>(packets.size()));
}

TEST_F(OpenBusTest, PacketsForAnotherGroupOrForTheHostAreNotSeen) {
  Stranger(url_, "127.0.0.1").Send(SmallPacket({"A\0", 2}));
  Stranger(url_, "239.255.76.68").Send(SmallPacket({"A\0", 2}));
  ExpectOnlyTheNext();
  EXPECT_EQ(bus_.counters().malformed, 0);
}

/// Publishes in lockstep with a lasting subscription, while others on the same channel come and go.
void LetSubscriptionsComeAndGo(Bus* bus) {
  constexpr int kMessages = 500;
  std::atomic<int> num_received = 0;
  const Subscription lasting =
      bus->Subscribe<DiscoverMessage>("CHANNEL", [&](const DiscoverMessage&) { ++num_received; });
  bus->Start();
  std::atomic<bool> done = false;
  std::thread publisher([&] {
    for (int i = 0; i < kMessages; ++i) {
      PublishNumber(bus, "CHANNEL", i);
      if (!WaitUntil([&] { return num_received > i; })) break;
    }
    done = true;
  });
  int num_rounds = 0;
  int num_late_calls = 0;
  while (!done) {
    // On the heap: a call after the end of the subscription is then seen by the sanitizers too.
    auto ended = std::make_unique<std::atomic<bool>>(false);
    std::vector<Subscription> passing;
    for (int i = 0; i < 4; ++i) {
      passing.push_back(bus->Subscribe<DiscoverMessage>(
          "CHANNEL", [&num_late_calls, flag = ended.get()](const DiscoverMessage&) {
            if (*flag) ++num_late_calls;
          }));
    }
    passing[1] = Subscription();
    passing[0] = std::move(passing[3]);
    passing.clear();
    *ended = true;
    ++num_rounds;
    const int seen = num_received;
    if (!WaitUntil([&] { return done || num_received > seen; })) break;
  }
  publisher.join();
  EXPECT_EQ(num_received, kMessages);
  EXPECT_EQ(num_late_calls, 0);
  EXPECT_GT(num_rounds, 0);
}

TEST(BusTest, SubscriptionsComeAndGoWhileMessagesFlow) {
  Bus bus("memq://");
  LetSubscriptionsComeAndGo(&bus);
}

TEST(BusTest, SubscriptionsComeAndGoWhileMessagesFlowOnTheNetwork) {
  Bus bus(PrivateUdpUrl());
  LetSubscriptionsComeAndGo(&bus);
}

TEST(BusTest, MessagesOnTheNetworkAreHandledInOrderOneAtATime) {
  Bus bus(PrivateUdpUrl());
  constexpr int kMessages = 300;
  std::atomic<int> num_running = 0;
  std::vector<std::string> received;
  std::atomic<int> num_received = 0;
  const Subscription subscription =
      bus.Subscribe<DiscoverMessage>("CHANNEL", [&](const DiscoverMessage& message) {
        EXPECT_EQ(++num_running, 1);
        // Large ones take another way through the bus than small ones.
        received.push_back(message.sender.substr(0, message.sender.find(' ')));
        if (received.size() % 50 == 1) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        --num_running;
        ++num_received;
      });
  bus.Start();
  std::vector<std::string> sent;
  for (int i = 0; i < kMessages; ++i) {
    sent.push_back(std::to_string(i));
    bus.Publish("CHANNEL",
                DiscoverMessage{sent.back() + std::string(i % 7 == 0 ? 100'000 : 1, ' ')});
    // As many as the smallest receive buffer of a kernel holds.
    ASSERT_TRUE(WaitUntil([&] { return num_received > i - 2; }));
  }
  ASSERT_TRUE(WaitUntil([&] { return num_received == kMessages; }));
  EXPECT_EQ(received, sent);
}

TEST(BusTest, EndOfSubscriptionWaitsForTheRunningHandler) {
  Bus bus("memq://");
  std::promise<void> entered;
  std::promise<void> release;
  std::atomic<bool> finished = false;
  auto subscription = std::make_unique<Subscription>(
      bus.Subscribe<DiscoverMessage>("CHANNEL", [&](const DiscoverMessage&) {
        entered.set_value();
        release.get_future().wait();
        finished = true;
      }));
  bus.Start();
  PublishNumber(&bus, "CHANNEL", 1);
  entered.get_future().wait();
  std::thread releaser([&] { release.set_value(); });
  subscription.reset();
  EXPECT_TRUE(finished);
  releaser.join();
}

TEST(BusTest, EndedSubscriptionLetsGoOfWhatItsHandlerHeld) {
  Bus bus("memq://");
  const auto held = std::make_shared<int>(0);
  Subscription subscription =
      bus.Subscribe<DiscoverMessage>("CHANNEL", [held](const DiscoverMessage&) {});
  EXPECT_EQ(held.use_count(), 2);
  subscription = Subscription();
  EXPECT_EQ(held.use_count(), 1);
}

TEST(BusTest, MessagesWaitWhileTheHandlerIsBusy) {
  Bus bus("memq://");
  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  std::atomic<int> num_received = 0;
  const Subscription unbounded = bus.Subscribe<DiscoverMessage>(
      "CHANNEL",
      [&](const DiscoverMessage&) {
        released.wait();
        ++num_received;
      },
      nullptr, /*queue_capacity=*/0);
  bus.Start();
  constexpr int kMessages = 3 * Bus::kDefaultQueueCapacity;
  for (int i = 0; i < kMessages; ++i) PublishNumber(&bus, "CHANNEL", i);
  release.set_value();
  EXPECT_TRUE(WaitUntil([&] { return num_received == kMessages; })) << num_received;
}

TEST(BusTest, GoesOnAfterSignals) {
  struct sigaction action = {};
  struct sigaction before = {};
  action.sa_handler = [](int) {};
  sigaction(SIGUSR1, &action, &before);
  {
    Bus bus(PrivateUdpUrl());
    MessageCollector<DiscoverMessage> collector(&bus, "CHANNEL");
    bus.Start();
    for (int i = 0; i < 20; ++i) {
      for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        const int id = std::stoi(task.path().filename());
        if (id != getpid()) syscall(SYS_tgkill, getpid(), id, SIGUSR1);
      }
      PublishNumber(&bus, "CHANNEL", i);
      ASSERT_EQ(collector.WaitFor(static_cast<std::size_t>(i) + 1).size(),
                static_cast<std::size_t>(i) + 1);
    }
  }
  sigaction(SIGUSR1, &before, nullptr);
}

}  // namespace
}  // namespace planbench
