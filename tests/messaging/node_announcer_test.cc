#include "messaging/node_announcer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>

#include "common/utime.h"
#include "messaging/channels.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/message_collector.h"
#include "tests/support/private_bus.h"

namespace planbench {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kMinuteUs = 60'000'000;

class NodeAnnouncerTest : public testing::Test {
 protected:
  NodeAnnouncerTest() { bus_.Start(); }

  /// Waits until the bus thread has been through all that was published so far.
  void Settle() {
    MessageCollector<ProblemRequestMessage> barrier(&bus_, "BARRIER");
    bus_.Publish("BARRIER", ProblemRequestMessage{"barrier", "set", 0});
    ASSERT_EQ(barrier.WaitFor(1).size(), 1u);
  }
  void Hear(const NodeStatusMessage& status) {
    bus_.Publish(channel::kNodeStatus, status);
    Settle();
  }
  /// Hears it twice, as one that lives and is asked.
  void HearLiving(NodeStatusMessage status) {
    Hear(status);
    ++status.utime;
    Hear(status);
  }
  /// Another process of the node's name, begun `age_us` before it.
  NodeStatusMessage Other(std::int64_t age_us) const {
    NodeStatusMessage other = self_;
    other.instance = "other";
    other.pid = self_.pid + 1;
    other.start_utime = self_.start_utime - age_us;
    other.utime = NowUtime();
    return other;
  }

  Bus bus_{"memq://"};
  const NodeStatusMessage self_ = MakeNodeStatus("ara", NodeKind::kPlanner);
};

TEST_F(NodeAnnouncerTest, StatusSaysWhoThisProcessIs) {
  EXPECT_EQ(self_.name, "ara");
  EXPECT_EQ(self_.kind, NodeKind::kPlanner);
  EXPECT_EQ(self_.pid, getpid());
  EXPECT_FALSE(self_.host.empty());
  EXPECT_FALSE(self_.version.empty());
  EXPECT_FALSE(self_.commit.empty());
  EXPECT_NEAR(static_cast<double>(self_.start_utime), static_cast<double>(NowUtime()), 60e6);
  ExpectInputError([] { MakeNodeStatus("no name", NodeKind::kLogger); }, {"no name"});
}

TEST_F(NodeAnnouncerTest, AnnouncesUnaskedAndAgainAndAgain) {
  MessageCollector<NodeStatusMessage> statuses(&bus_, channel::kNodeStatus);
  const NodeAnnouncer announcer(&bus_, [&] { return self_; });
  const auto heard = statuses.WaitFor(4);  // one or two come of the announcer's own question
  ASSERT_GE(heard.size(), 4u);
  EXPECT_EQ(heard[3].name, "ara");
  EXPECT_GE(heard[3].utime, self_.start_utime);
}

TEST_F(NodeAnnouncerTest, AnswersDiscover) {
  std::atomic<int> num_also = 0;
  const NodeAnnouncer announcer(
      &bus_, [&] { return self_; }, [&] { ++num_also; });
  Settle();
  MessageCollector<NodeStatusMessage> statuses(&bus_, channel::kNodeStatus);
  const int before = num_also;
  for (int i = 0; i < 5; ++i) bus_.Publish(channel::kDiscover, DiscoverMessage{"test"});
  EXPECT_GE(statuses.WaitFor(5).size(), 5u);
  EXPECT_TRUE(WaitUntil([&] { return num_also == before + 5; })) << num_also;
}

TEST_F(NodeAnnouncerTest, AnnouncesTheStatusOfTheMoment) {
  std::atomic<bool> busy = false;
  MessageCollector<NodeStatusMessage> statuses(&bus_, channel::kNodeStatus);
  NodeAnnouncer announcer(&bus_, [&] {
    NodeStatusMessage status = self_;
    status.busy = busy;
    return status;
  });
  ASSERT_FALSE(statuses.WaitFor(1).empty());
  EXPECT_FALSE(statuses.messages()[0].busy);
  busy = true;
  announcer.Announce();
  EXPECT_TRUE(statuses.WaitForOne([](const NodeStatusMessage& status) { return status.busy; }));
}

TEST_F(NodeAnnouncerTest, OfTwoOfANameTheOlderStays) {
  NodeStatusMessage newer = self_;
  newer.start_utime = self_.start_utime + 1;
  newer.instance = "newer";
  NodeAnnouncer old_one(&bus_, [&] { return self_; });
  const NodeAnnouncer new_one(&bus_, [&] { return newer; });
  ASSERT_TRUE(WaitUntil([&] {
    try {
      new_one.ThrowIfDisplaced();
      return false;
    } catch (const InputError&) {
      return true;
    }
  }));
  ExpectInputError([&] { new_one.ThrowIfDisplaced(); },
                   {"another session is on this LCM port", "the planner 'ara' is live already",
                    "pid " + std::to_string(getpid()), "--name", "--lcm-url"});
  Settle();
  EXPECT_NO_THROW(old_one.ThrowIfDisplaced());
}

TEST_F(NodeAnnouncerTest, NamesCountWhateverTheKind) {
  const NodeAnnouncer announcer(&bus_, [&] { return self_; });
  NodeStatusMessage other = Other(kMinuteUs);
  other.kind = NodeKind::kLogger;
  HearLiving(other);
  ExpectInputError([&] { announcer.ThrowIfDisplaced(); }, {"the logger 'ara'"});
}

TEST_F(NodeAnnouncerTest, OthersDisplaceNobody) {
  const NodeAnnouncer announcer(&bus_, [&] { return self_; });
  NodeStatusMessage namesake = Other(kMinuteUs);
  namesake.name = "rrtc";
  HearLiving(namesake);
  HearLiving(Other(-1));  // newer
  HearLiving(self_);      // itself
  EXPECT_NO_THROW(announcer.ThrowIfDisplaced());
}

TEST_F(NodeAnnouncerTest, ProcessesOfTheSameMomentAgreeOnWhoStays) {
  const NodeAnnouncer announcer(&bus_, [&] { return self_; });
  NodeStatusMessage other = Other(0);
  other.instance = "x";  // after any of ours
  HearLiving(other);
  EXPECT_NO_THROW(announcer.ThrowIfDisplaced());
  other.instance = "!";
  HearLiving(other);
  EXPECT_THROW(announcer.ThrowIfDisplaced(), InputError);
}

TEST_F(NodeAnnouncerTest, OneStatusThatNothingFollowsDisplacesNobody) {
  const NodeAnnouncer announcer(&bus_, [&] { return self_; });
  MessageCollector<DiscoverMessage> questions(&bus_, channel::kDiscover);
  const NodeStatusMessage forged = Other(kMinuteUs);
  Hear(forged);
  EXPECT_GE(questions.WaitFor(1).size(), 1u);  // it is asked for
  Hear(forged);                                // the same datagram again
  EXPECT_NO_THROW(announcer.ThrowIfDisplaced());
}

TEST_F(NodeAnnouncerTest, WhoIsAtWorkIsDisplacedByNobody) {
  const NodeAnnouncer announcer(
      &bus_, [&] { return self_; }, nullptr, std::chrono::milliseconds(0));
  HearLiving(Other(kMinuteUs));
  EXPECT_NO_THROW(announcer.ThrowIfDisplaced());
  EXPECT_EQ(bus_.contradictions().count(), 2);
  EXPECT_THAT(bus_.contradictions().entries().at(0).what,
              AllOf(HasSubstr("the planner 'ara'"), HasSubstr("--name"), HasSubstr("--lcm-url")));
}

TEST_F(NodeAnnouncerTest, WhoWaitsForItsPlaceDoesSoOnlyWhileARivalMayLive) {
  const NodeAnnouncer announcer(
      &bus_, [&] { return self_; }, nullptr, kTestPatience);
  EXPECT_NO_THROW(announcer.AwaitPlace()) << "nobody has been heard";
  HearLiving(Other(kMinuteUs));
  EXPECT_THROW(announcer.AwaitPlace(), InputError);
}

/// Rivals whose clocks tell another time, on a bus where everybody has a sender of his own.
class ClocksOfRivalsTest : public testing::Test {
 protected:
  ClocksOfRivalsTest() { bus_.Start(); }

  /// Says that a process of that name announces itself, which has been up for longer than this one;
  /// its clock is `ahead_us` ahead, and goes `speed` times as fast.
  void Announce(const std::string& name, std::int64_t ahead_us, std::int64_t speed = 1) {
    NodeStatusMessage other = self_;
    other.name = other.instance = name;
    other.utime = self_.start_utime + ahead_us + speed * (NowUtime() - self_.start_utime);
    other.start_utime += ahead_us - kMinuteUs;
    rivals_bus_.Publish(channel::kNodeStatus, other);
  }
  static bool IsDisplaced(const NodeAnnouncer& announcer) {
    try {
      announcer.ThrowIfDisplaced();
      return false;
    } catch (const InputError&) {
      return true;
    }
  }

  const std::string url_ = PrivateUdpUrl();
  Bus bus_{url_}, rivals_bus_{url_};
  const NodeStatusMessage self_ = MakeNodeStatus("ara", NodeKind::kPlanner);
};

TEST_F(ClocksOfRivalsTest, WhoHasBeenUpForLongerStays) {
  for (const std::int64_t ahead_us : {-60 * kMinuteUs, -kMinuteUs / 10, 60 * kMinuteUs}) {
    const NodeAnnouncer announcer(
        &bus_, [&] { return self_; }, nullptr, kTestPatience);
    EXPECT_TRUE(WaitUntil([&] {
      Announce("ara", ahead_us);
      return IsDisplaced(announcer);
    })) << ahead_us;
  }
}

TEST_F(ClocksOfRivalsTest, WhoHasBeenUpForLessGoesWhateverItsClock) {
  const NodeAnnouncer announcer(
      &bus_, [&] { return self_; }, nullptr, std::chrono::seconds(1));
  EXPECT_TRUE(WaitUntil([&] {
    NodeStatusMessage younger = self_;
    younger.instance = "younger";
    younger.utime = NowUtime() - 60 * kMinuteUs;
    younger.start_utime = younger.utime - 1;
    rivals_bus_.Publish(channel::kNodeStatus, younger);
    return bus_.contradictions().count() > 0;  // this process is established
  }));
  EXPECT_FALSE(IsDisplaced(announcer));
}

TEST_F(ClocksOfRivalsTest, AReplayDisplacesNobody) {
  const NodeAnnouncer announcer(
      &bus_, [&] { return self_; }, nullptr, std::chrono::seconds(1));
  EXPECT_TRUE(WaitUntil([&] {
    Announce("ara", -60 * kMinuteUs);
    Announce("rrtc", -60 * kMinuteUs);
    return bus_.contradictions().count() > 0;  // this process is established
  }));
  EXPECT_FALSE(IsDisplaced(announcer));
}

TEST_F(ClocksOfRivalsTest, NorDoesOneOfASingleProcessAtAnotherSpeed) {
  const NodeAnnouncer announcer(
      &bus_, [&] { return self_; }, nullptr, std::chrono::seconds(1));
  EXPECT_TRUE(WaitUntil([&] {
    Announce("ara", -60 * kMinuteUs, 4);
    return bus_.contradictions().count() > 0;  // this process is established
  }));
  EXPECT_FALSE(IsDisplaced(announcer));
}

}  // namespace
}  // namespace planbench
