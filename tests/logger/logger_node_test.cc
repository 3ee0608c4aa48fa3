#include "logger/logger_node.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <condition_variable>
#include <fstream>
#include <future>
#include <lcm/lcm-cpp.hpp>
#include <mutex>
#include <set>

#include "common/error.h"
#include "logger/rebuild.h"
#include "messaging/channels.h"
#include "sample_messages.h"
#include "session_files.h"
#include "tests/support/message_collector.h"
#include "tests/support/private_bus.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using namespace std::chrono_literals;

std::multiset<std::string> LoggedChannels(const std::filesystem::path& file) {
  lcm::LogFile log(file, "r");
  std::multiset<std::string> channels;
  while (const lcm::LogEvent* event = log.readNextEvent()) channels.insert(event->channel);
  return channels;
}

std::int64_t CountRuns(const std::filesystem::path& file) {
  SqliteConnection connection(file, SqliteConnection::Mode::kReadOnly);
  return std::get<std::int64_t>(connection.QueryValue("SELECT count(*) FROM runs"));
}

bool Now() { return true; }

TEST(LoggerNode, RecordsWhatIsOnTheBus) {
  const TemporaryFolder temporary;
  Bus bus("memq://");
  LoggerNode logger(&bus, {.out = temporary / "s"});
  MessageCollector<AckMessage> run_acks(&bus, channel::kRunRecordAck);
  MessageCollector<AckMessage> session_acks(&bus, channel::kSessionAck);
  bus.Start();
  bus.Publish(channel::kSession, SampleSession());
  bus.Publish(channel::kRunRecord, SampleRecord("a"));
  bus.Publish(channel::kRunRecord, SampleRecord("b"));
  bus.Publish(channel::kRunRecord, SampleRecord("a"));
  const std::vector<AckMessage> acks = run_acks.WaitFor(3);
  ASSERT_EQ(acks.size(), 3);
  EXPECT_EQ(acks[0].id, "a");
  EXPECT_EQ(acks[1].id, "b");
  EXPECT_EQ(acks[2].id, "a");
  for (const AckMessage& ack : acks) {
    EXPECT_TRUE(ack.ok);
    EXPECT_EQ(ack.sender, "logger");
  }
  ASSERT_EQ(session_acks.WaitFor(1).size(), 1);
  EXPECT_TRUE(logger.Run(Now));
  EXPECT_EQ(CountRuns(temporary / "s" / "results.sqlite"), 2);
  const auto channels = LoggedChannels(temporary / "s" / "s.lcmlog");
  EXPECT_EQ(channels.count(channel::kRunRecord), 3);
  EXPECT_EQ(channels.count(channel::kSession), 1);
  EXPECT_GE(channels.count(channel::kNodeStatus), 1);
}

TEST(LoggerNode, AcknowledgesOnlyWhatIsOnDisk) {
  const TemporaryFolder temporary;
  Bus bus("memq://");
  LoggerNode logger(&bus, {.out = temporary / "s"});
  std::mutex mutex;
  std::condition_variable changed;
  int acks = 0;
  int stored_at_ack = 0;
  int logged_at_ack = 0;
  const Subscription subscription =
      bus.Subscribe<AckMessage>(channel::kRunRecordAck, [&](const AckMessage& ack) {
        SqliteConnection connection(temporary / "s" / "results.sqlite",
                                    SqliteConnection::Mode::kReadOnly);
        const bool stored = connection.QueryValue("SELECT 1 FROM runs WHERE request_id = '" +
                                                  ack.id + "'") == SqliteValue(std::int64_t{1});
        const auto logged = LoggedChannels(temporary / "s" / "s.lcmlog").count(channel::kRunRecord);
        const std::scoped_lock lock(mutex);
        ++acks;
        if (stored) ++stored_at_ack;
        if (static_cast<int>(logged) >= acks) ++logged_at_ack;
        changed.notify_all();
      });
  bus.Start();
  constexpr int kNumRuns = 20;
  for (int i = 0; i < kNumRuns; ++i) {
    bus.Publish(channel::kRunRecord, SampleRecord(std::to_string(i)));
  }
  std::unique_lock lock(mutex);
  ASSERT_TRUE(changed.wait_for(lock, 60s, [&] { return acks == kNumRuns; }));
  EXPECT_EQ(stored_at_ack, kNumRuns);
  EXPECT_EQ(logged_at_ack, kNumRuns);
}

TEST(LoggerNode, WorksBetweenTwoConnections) {
  const TemporaryFolder temporary;
  // A port of this process's own, since processes on one port hear each other whatever their group.
  const std::string url = "udpm://239.255.76.67:" + std::to_string(20'000 + getpid() % 20'000) +
                          "?ttl=0&recv_buf_size=4194304";
  std::unique_ptr<Bus> logger_bus;
  try {
    logger_bus = std::make_unique<Bus>(url);
  } catch (const InputError& error) {
    GTEST_SKIP() << "no multicast here: " << error.what();
  }
  LoggerNode logger(logger_bus.get(), {.out = temporary / "s"});
  logger_bus->Start();
  Bus driver(url);
  MessageCollector<AckMessage> acks(&driver, channel::kRunRecordAck);
  driver.Start();
  // A path of thousands of rows, larger than one datagram; repeated, since datagrams may be lost.
  RunRecordMessage record = SampleRecord();
  record.result.result.path.assign(5000, {0.25, 0.5});
  std::vector<AckMessage> received;
  for (int attempt = 0; attempt < 20 && received.empty(); ++attempt) {
    driver.Publish(channel::kRunRecord, record);
    std::this_thread::sleep_for(50ms);
    received = acks.WaitFor(attempt == 19 ? 1 : 0);
  }
  ASSERT_FALSE(received.empty());
  EXPECT_TRUE(received[0].ok);
  EXPECT_TRUE(logger.Run(Now));
  SqliteConnection connection(temporary / "s" / "results.sqlite",
                              SqliteConnection::Mode::kReadOnly);
  EXPECT_EQ(connection.QueryValue("SELECT count(*) FROM paths WHERE kind = 'raw'"),
            SqliteValue(std::int64_t{10'000}));
}

TEST(LoggerNode, NothingCountsAsLostThatIsSentWhileItOpensItsDatabase) {
  const TemporaryFolder temporary;
  std::filesystem::create_directories(temporary / "s");
  SqliteConnection locking(temporary / "s" / "results.sqlite",
                           SqliteConnection::Mode::kReadWriteCreate);
  locking.Execute("BEGIN EXCLUSIVE");
  const std::string url = PrivateUdpUrl();
  Bus logger_bus(url);
  auto opening = std::async(std::launch::async, [&] {
    return std::make_unique<LoggerNode>(&logger_bus,
                                        LoggerOptions{.out = temporary / "s", .resume = true});
  });
  // It has its folder, and waits for the database.
  ASSERT_TRUE(WaitUntil([&] { return std::filesystem::exists(temporary / "s" / "logger.lock"); }));
  Bus sender(url);
  const NodeStatusMessage status = MakeNodeStatus("driver", NodeKind::kDriver);
  sender.Publish(channel::kNodeStatus, status);
  sender.PublishBytes("OTHER", std::vector<std::uint8_t>(1));
  locking.Execute("ROLLBACK");
  const std::unique_ptr<LoggerNode> logger = opening.get();
  MessageCollector<NodeStatusMessage> statuses(&logger_bus, channel::kNodeStatus);
  logger_bus.Start();
  ASSERT_TRUE(WaitUntil([&] {
    sender.Publish(channel::kNodeStatus, status);
    return statuses.Count([](const auto& heard) { return heard.name == "driver"; }) > 0;
  }));
  EXPECT_EQ(logger_bus.counters().lost, 0);
}

TEST(LoggerNode, AnnouncesItselfWithItsFolder) {
  const TemporaryFolder temporary;
  Bus bus("memq://");
  MessageCollector<NodeStatusMessage> statuses(&bus, channel::kNodeStatus);
  LoggerNode logger(&bus, {.out = temporary / "s", .name = "scribe"});
  bus.Start();
  const std::vector<NodeStatusMessage> heard = statuses.WaitFor(1);
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard[0].name, "scribe");
  EXPECT_EQ(heard[0].kind, NodeKind::kLogger);
  EXPECT_EQ(heard[0].settings.at("out"), (temporary / "s").string());
}

TEST(LoggerNode, StoppedItRecordsWhatItHadReceived) {
  const TemporaryFolder temporary;
  Bus bus("memq://");
  std::atomic<int> heard = 0;
  constexpr int kNumRuns = 100;
  {
    LoggerNode logger(&bus, {.out = temporary / "s"});
    // Subscribed after the logger: when this has heard a message, the logger has it in its queue.
    const Subscription witness = bus.Subscribe<RunRecordMessage>(
        channel::kRunRecord, [&](const RunRecordMessage&) { ++heard; });
    bus.Start();
    for (int i = 0; i < kNumRuns; ++i) {
      bus.Publish(channel::kRunRecord, SampleRecord(std::to_string(i)));
    }
    EXPECT_TRUE(logger.Run([&] { return heard == kNumRuns; }));
  }
  EXPECT_EQ(CountRuns(temporary / "s" / "results.sqlite"), kNumRuns);
  EXPECT_FALSE(std::filesystem::exists(temporary / "s" / "results.sqlite-wal"));
}

TEST(LoggerNode, DropsAreCountedAndNoCleanEnd) {
  const TemporaryFolder temporary;
  Bus bus("memq://");
  LoggerNode logger(&bus, {.out = temporary / "s", .queue_bytes = 10'000});
  MessageCollector<AckMessage> acks(&bus, channel::kRunRecordAck);
  bus.Start();
  // Too large for the queue as a whole.
  bus.PublishBytes("LARGE", std::vector<std::uint8_t>(20'000));
  bus.Publish(channel::kRunRecord, SampleRecord());
  EXPECT_EQ(acks.WaitFor(1).size(), 1);
  EXPECT_EQ(logger.num_dropped(), 1);
  EXPECT_FALSE(logger.Run(Now));
  EXPECT_EQ(LoggedChannels(temporary / "s" / "s.lcmlog").count("LARGE"), 0);
}

TEST(LoggerNode, ARefusedRecordIsNoCleanEnd) {
  const TemporaryFolder temporary;
  Bus bus("memq://");
  LoggerNode logger(&bus, {.out = temporary / "s"});
  MessageCollector<AckMessage> acks(&bus, channel::kRunRecordAck);
  bus.Start();
  RunRecordMessage record = SampleRecord();
  record.trial = 0;
  bus.Publish(channel::kRunRecord, record);
  const std::vector<AckMessage> received = acks.WaitFor(1);
  ASSERT_EQ(received.size(), 1);
  EXPECT_FALSE(received[0].ok);
  EXPECT_FALSE(logger.Run(Now));
}

TEST(LoggerNode, AFolderThatCannotBeWrittenIsTold) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  const TemporaryFolder temporary;
  std::filesystem::create_directories(temporary / "s");
  std::filesystem::create_symlink("/dev/full", temporary / "s" / "s.lcmlog");
  Bus bus("memq://");
  LoggerNode logger(&bus, {.out = temporary / "s", .resume = true});
  std::atomic<int> acks = 0;
  const Subscription subscription =
      bus.Subscribe<AckMessage>(channel::kRunRecordAck, [&](const AckMessage&) { ++acks; });
  MessageCollector<NodeStatusMessage> statuses(&bus, channel::kNodeStatus);
  bus.Start();
  bus.Publish(channel::kRunRecord, SampleRecord());
  EXPECT_TRUE(statuses.WaitForOne([](const NodeStatusMessage& status) {
    return status.trouble.find("No space left") != std::string::npos;
  }));
  EXPECT_THROW(logger.Run(Now), std::runtime_error);
  EXPECT_EQ(acks, 0);
}

TEST(LoggerNode, GoesOnWhenTheFolderCanBeWrittenAgain) {
  const TemporaryFolder temporary;
  Bus bus("memq://");
  LoggerNode logger(&bus, {.out = temporary / "s"});
  MessageCollector<NodeStatusMessage> statuses(&bus, channel::kNodeStatus);
  MessageCollector<AckMessage> acks(&bus, channel::kRunRecordAck);
  bus.Start();
  std::filesystem::rename(temporary / "s", temporary / "elsewhere");
  bus.Publish(channel::kRunRecord, SampleRecord());
  EXPECT_TRUE(statuses.WaitForOne([](const NodeStatusMessage& status) {
    return status.trouble.find("was removed or moved") != std::string::npos;
  }));
  EXPECT_TRUE(acks.messages().empty());
  std::filesystem::rename(temporary / "elsewhere", temporary / "s");
  EXPECT_EQ(acks.WaitFor(1).size(), 1);
  EXPECT_TRUE(logger.Run(Now));
  EXPECT_EQ(CountRuns(temporary / "s" / "results.sqlite"), 1);
}

TEST(LoggerNode, WhatTheDatabaseTakesLaterIsLoggedOnce) {
  const TemporaryFolder temporary;
  const auto results = temporary / "s" / "results.sqlite";
  Bus bus("memq://");
  LoggerNode logger(&bus, {.out = temporary / "s"});
  MessageCollector<NodeStatusMessage> statuses(&bus, channel::kNodeStatus);
  MessageCollector<AckMessage> acks(&bus, channel::kRunRecordAck);
  bus.Start();
  SqliteConnection other(results, SqliteConnection::Mode::kReadWriteCreate);
  other.Execute("ALTER TABLE runs RENAME TO runs_elsewhere");
  bus.Publish(channel::kRunRecord, SampleRecord());
  EXPECT_TRUE(statuses.WaitForOne([](const NodeStatusMessage& status) {
    return status.trouble.find("no such table") != std::string::npos;
  }));
  EXPECT_TRUE(acks.messages().empty());
  other.Execute("ALTER TABLE runs_elsewhere RENAME TO runs");
  EXPECT_EQ(acks.WaitFor(1).size(), 1);
  EXPECT_TRUE(logger.Run(Now));
  EXPECT_EQ(CountRuns(results), 1);
  EXPECT_EQ(LoggedChannels(temporary / "s" / "s.lcmlog").count(channel::kRunRecord), 1);
}

TEST(LoggerNode, WhatTheDatabaseHasNotTakenAtTheEndIsInTheEventLog) {
  const TemporaryFolder temporary;
  Bus bus("memq://");
  constexpr int kNumRuns = 10;
  std::atomic<int> heard = 0;
  {
    LoggerNode logger(&bus, {.out = temporary / "s"});
    const Subscription witness = bus.Subscribe<RunRecordMessage>(
        channel::kRunRecord, [&](const RunRecordMessage&) { ++heard; });
    MessageCollector<AckMessage> acks(&bus, channel::kRunRecordAck);
    SqliteConnection other(temporary / "s" / "results.sqlite",
                           SqliteConnection::Mode::kReadWriteCreate);
    other.Execute("ALTER TABLE runs RENAME TO runs_elsewhere");
    bus.Start();
    for (int i = 0; i < kNumRuns; ++i) {
      bus.Publish(channel::kRunRecord, SampleRecord(std::to_string(i)));
    }
    EXPECT_THROW(logger.Run([&] { return heard == kNumRuns; }), SqliteError);
    EXPECT_TRUE(acks.messages().empty());
    other.Execute("ALTER TABLE runs_elsewhere RENAME TO runs");
  }
  const auto event_log = temporary / "s" / "s.lcmlog";
  EXPECT_EQ(LoggedChannels(event_log).count(channel::kRunRecord), kNumRuns);
  EXPECT_TRUE(RebuildSession(event_log, {.out = temporary / "rebuilt"}));
  EXPECT_EQ(CountRuns(temporary / "rebuilt" / "results.sqlite"), kNumRuns);
  EXPECT_EQ(CountRuns(temporary / "s" / "results.sqlite"), 0);
  Bus later("memq://");
  LoggerNode(&later, {.out = temporary / "s", .resume = true});
  EXPECT_EQ(CountRuns(temporary / "s" / "results.sqlite"), kNumRuns);
}

TEST(LoggerNode, TakesRecordsFromTheDriverAlone) {
  const TemporaryFolder temporary;
  const std::string url = PrivateUdpUrl();
  Bus logger_bus(url);
  LoggerNode logger(&logger_bus, {.out = temporary / "s"});
  logger_bus.Start();
  Bus driver_bus(url);
  Bus forger_bus(url);
  MessageCollector<AckMessage> acks(&driver_bus, channel::kRunRecordAck);
  driver_bus.Start();
  const NodeStatusMessage status = MakeNodeStatus("driver", NodeKind::kDriver);
  driver_bus.Publish(channel::kNodeStatus, status);
  RunRecordMessage forged = SampleRecord("a");
  forged.status = PlanStatus::kTimedOut;
  ASSERT_TRUE(WaitUntil([&] {
    forger_bus.Publish(channel::kRunRecord, forged);
    return logger_bus.contradictions().count() > 0;
  }));
  ASSERT_TRUE(WaitUntil([&] {
    driver_bus.Publish(channel::kNodeStatus, status);
    driver_bus.Publish(channel::kRunRecord, SampleRecord("b"));
    return !acks.messages().empty();
  }));
  logger.Run(Now);
  EXPECT_GE(LoggedChannels(temporary / "s" / "s.lcmlog").count("REFUSED_RUN_RECORD"), 1);
  std::ifstream file(temporary / "s" / "run.json");
  const std::string json{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(json.find("\"contradictions\""), std::string::npos) << json;
}

TEST(LoggerNode, RefusesABadNameOrFolder) {
  const TemporaryFolder temporary;
  Bus bus("memq://");
  EXPECT_THROW(LoggerNode(&bus, {.out = temporary / "s", .name = "bad name"}), InputError);
  EXPECT_FALSE(std::filesystem::exists(temporary / "s"));
  const LoggerNode first(&bus, {.out = temporary / "t"});
  EXPECT_THROW(LoggerNode(&bus, {.out = temporary / "t", .name = "second"}), InputError);
}

}  // namespace
}  // namespace planbench
