#include "messaging/inbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace planbench {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

class InboxTest : public testing::Test {
 protected:
  /// Keeps the channels of the messages that it gets, its name before each.
  std::shared_ptr<Subscriber> Subscribe(const std::string& name, const std::string& channel) {
    auto subscriber = std::make_shared<Subscriber>();
    subscriber->channel = channel;
    subscriber->handler = [this, name](const ReceivedMessage& message) {
      handled_.push_back(name + message.channel);
    };
    inbox_.Add(subscriber);
    return subscriber;
  }
  void Take(const std::string& channel, bool at_once) { inbox_.Take({channel, {1}}, at_once); }

  Inbox inbox_;
  std::vector<std::string> handled_;
};

TEST_F(InboxTest, HandlesAtOnceWhatNeedNotWait) {
  Subscribe("1", "A");
  Subscribe("2", "A");
  Take("B", true);  // nobody's
  Take("A", true);
  EXPECT_THAT(handled_, ElementsAre("1A", "2A"));
  Take("A", false);
  Take("A", true);  // behind the other
  EXPECT_EQ(handled_.size(), 2u);
  inbox_.HandleOne(milliseconds(0));
  inbox_.HandleOne(milliseconds(0));
  EXPECT_EQ(handled_.size(), 6u);
  Take("A", true);
  EXPECT_EQ(handled_.size(), 8u);
}

TEST_F(InboxTest, ASubscriberToAllIsNotWaitedFor) {
  Subscribe("1", "A");
  Subscribe("all", "");
  Take("A", true);
  Take("B", true);
  EXPECT_TRUE(handled_.empty());
  inbox_.HandleOne(milliseconds(0));
  inbox_.HandleOne(milliseconds(0));
  EXPECT_THAT(handled_, ElementsAre("1A", "allA", "allB"));
}

TEST_F(InboxTest, OneWithTooManyMessagesGetsNoMoreWhileOthersDo) {
  Subscribe("1", "A")->capacity = 1;
  Subscribe("2", "A");
  for (int i = 0; i < 3; ++i) Take("A", false);
  EXPECT_EQ(inbox_.num_dropped(), 2);
  for (int i = 0; i < 3; ++i) inbox_.HandleOne(milliseconds(0));
  EXPECT_THAT(handled_, ElementsAre("1A", "2A", "2A", "2A"));
  Take("A", true);
  EXPECT_EQ(inbox_.num_dropped(), 2);
  EXPECT_EQ(handled_.size(), 6u);
}

}  // namespace
}  // namespace planbench
