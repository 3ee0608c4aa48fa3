#include "logger/message_queue.h"

#include <gtest/gtest.h>

#include <thread>

namespace planbench {
namespace {

using std::chrono::milliseconds;

TEST(MessageQueue, GivesMessagesInOrderWithChannelBytesAndTime) {
  MessageQueue queue(10'000);
  const std::vector<std::uint8_t> first = {1, 2, 3};
  EXPECT_TRUE(queue.Push({"A", first, 5}));
  EXPECT_TRUE(queue.Push({"B", {}, 6}));
  const auto a = queue.Pop(milliseconds(0));
  ASSERT_TRUE(a);
  EXPECT_EQ(a->channel, "A");
  EXPECT_EQ(a->bytes, first);
  EXPECT_EQ(a->utime, 5);
  EXPECT_EQ(queue.Pop(milliseconds(0))->channel, "B");
  EXPECT_FALSE(queue.Pop(milliseconds(0)));
  EXPECT_TRUE(queue.empty());
}

TEST(MessageQueue, DropsAndCountsWhatDoesNotFit) {
  MessageQueue queue(3000);
  const std::vector<std::uint8_t> big(1000);
  EXPECT_TRUE(queue.Push({"A", big, 0}));
  EXPECT_TRUE(queue.Push({"B", big, 0}));
  EXPECT_FALSE(queue.Push({"C", big, 0}));
  EXPECT_FALSE(queue.Push({"D", big, 0}));
  EXPECT_EQ(queue.num_dropped(), 2);
  // Room again once a message has been taken.
  EXPECT_EQ(queue.Pop(milliseconds(0))->channel, "A");
  EXPECT_TRUE(queue.Push({"E", big, 0}));
  EXPECT_EQ(queue.num_dropped(), 2);
  EXPECT_EQ(queue.Pop(milliseconds(0))->channel, "B");
  EXPECT_EQ(queue.Pop(milliseconds(0))->channel, "E");
}

TEST(MessageQueue, BoundsEmptyMessagesToo) {
  MessageQueue queue(1000);
  int kept = 0;
  while (kept < 1000 && queue.Push({"A", {}, 0})) ++kept;
  EXPECT_LT(kept, 1000);
}

TEST(MessageQueue, ClosedStillGivesWhatItHolds) {
  MessageQueue queue(1000);
  queue.Push({"A", {}, 0});
  queue.Close();
  EXPECT_TRUE(queue.closed());
  EXPECT_FALSE(queue.Push({"B", {}, 0}));
  EXPECT_TRUE(queue.Pop(milliseconds(0)));
  EXPECT_FALSE(queue.Pop(std::chrono::hours(1)));  // does not wait
}

TEST(MessageQueue, PopWaitsForAMessageOfAnotherThread) {
  MessageQueue queue(1000);
  std::thread sender([&] { queue.Push({"A", {}, 0}); });
  EXPECT_TRUE(queue.Pop(std::chrono::minutes(1)));
  sender.join();
}

}  // namespace
}  // namespace planbench
