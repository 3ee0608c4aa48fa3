#include "messaging/event_log.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <lcm/lcm-cpp.hpp>

#include "common/error.h"
#include "common/read_text.h"
#include "messaging/event_log_files.h"
#include "messaging/event_log_reader.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

struct Event {
  std::int64_t number;
  std::int64_t utime;
  std::string channel;
  std::string data;
  bool operator==(const Event&) const = default;
};

void PrintTo(const Event& event, std::ostream* out) {
  *out << event.number << ' ' << event.utime << ' ' << event.channel << ' ' << event.data;
}

std::vector<Event> ReadEvents(const std::filesystem::path& file) {
  lcm::LogFile log(file, "r");
  std::vector<Event> events;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    events.push_back({event->eventnum, event->timestamp, event->channel,
                      std::string(static_cast<const char*>(event->data),
                                  static_cast<std::size_t>(event->datalen))});
  }
  return events;
}

ReceivedMessage Message(const std::string& channel, const std::string& data, std::int64_t utime) {
  return {channel, {data.begin(), data.end()}, utime};
}

TEST(EventLog, IsReadByLcm) {
  const TemporaryFolder folder;
  {
    EventLog log(folder / "a.lcmlog", EventLog::Mode::kNew);
    log.Write(Message("FIRST", "one", 10));
    log.Write(Message("SECOND", "", 20));
    log.Flush();
    EXPECT_EQ(ReadEvents(folder / "a.lcmlog").size(), 2);  // before it is closed
    log.Write(Message("THIRD", "three", 30));
  }
  const std::vector<Event> expected = {
      {0, 10, "FIRST", "one"}, {1, 20, "SECOND", ""}, {2, 30, "THIRD", "three"}};
  EXPECT_EQ(ReadEvents(folder / "a.lcmlog"), expected);
}

TEST(EventLog, NumbersGoOnWhenAppending) {
  const TemporaryFolder folder;
  for (int part = 0; part < 3; ++part) {
    EventLog log(folder / "a.lcmlog", EventLog::Mode::kAppend);
    log.Write(Message("A", "a", part));
    log.Write(Message("B", "b", part));
  }
  const std::vector<Event> events = ReadEvents(folder / "a.lcmlog");
  ASSERT_EQ(events.size(), 6);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(events[static_cast<std::size_t>(i)].number, i);
}

TEST(EventLog, CutsOffATornLastEvent) {
  const std::vector<Event> expected = {{0, 1, "A", "whole"}, {1, 3, "C", "after"}};
  // From within the sync word that it begins with to within its data.
  for (const std::uintmax_t left : {1u, 3u, 4u, 20u, 30u}) {
    SCOPED_TRACE(left);
    const TemporaryFolder folder;
    const auto file = folder / "a.lcmlog";
    {
      EventLog log(file, EventLog::Mode::kNew);
      log.Write(Message("A", "whole", 1));
      log.Flush();
      const std::uintmax_t whole = std::filesystem::file_size(file);
      log.Write(Message("B", "this event will be torn", 2));
      log.Flush();
      std::filesystem::resize_file(file, whole + left);
    }
    EventLog(file, EventLog::Mode::kAppend).Write(Message("C", "after", 3));
    EXPECT_EQ(ReadEvents(file), expected);
  }
}

TEST(EventLog, GoesOnInNoFileThatIsNone) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  // The second as gzip leaves it.
  for (const std::string text : {"notes of mine", "\x1f\x8b\x08"}) {
    folder.Write("a.lcmlog", text);
    ExpectInputError([&] { EventLog(file, EventLog::Mode::kAppend); },
                     {"a.lcmlog", "no event of an LCM event log"});
    EXPECT_EQ(std::filesystem::file_size(file), text.size()) << "it stays as it was";
  }
  // All that a logger wrote before it was killed.
  for (const std::string text : {"", "\xed\xa1", "\xed\xa1\xda\x01 and a part of its event"}) {
    folder.Write("a.lcmlog", text);
    EventLog(file, EventLog::Mode::kAppend).Write(Message("A", "whole", 1));
    EXPECT_EQ(ReadEvents(file), (std::vector<Event>{{0, 1, "A", "whole"}}));
  }
}

/// Of an event on a channel of one letter.
constexpr std::uintmax_t kBeforeData = 28 + 1;

void SetByte(const std::filesystem::path& file, std::uintmax_t offset, int value) {
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekp(static_cast<std::streamoff>(offset));
  stream.put(static_cast<char>(value));
  ASSERT_TRUE(stream.flush()) << file;
}

/// What ReadEventLog makes of a file.
struct Reading {
  std::vector<std::string> texts;  ///< Data of the events.
  std::vector<std::string> passed_over;
};

Reading ReadAll(const std::filesystem::path& file) {
  Reading reading;
  reading.passed_over = ReadEventLog(file, [&](const ReceivedMessage& message) {
    reading.texts.emplace_back(message.bytes.begin(), message.bytes.end());
  });
  return reading;
}

TEST(EventLog, AWrongByteCostsItsOwnEventAloneAndIsTold) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  const std::vector<std::string> texts = {"first", "second", "third", "fourth"};
  const std::uintmax_t begin = kBeforeData + texts[0].size();
  const std::uintmax_t end = begin + kBeforeData + texts[1].size();
  for (std::uintmax_t at = begin; at < end; ++at) {
    for (const int value : {0x00, 0xff}) {
      SCOPED_TRACE(fmt::format("byte {} of the event is {}", at - begin, value));
      std::filesystem::remove(file);
      {
        EventLog log(file, EventLog::Mode::kNew);
        for (const std::string& text : texts) log.Write(Message("A", text, 1));
      }
      SetByte(file, at, value);
      const Reading reading = ReadAll(file);
      ASSERT_GE(reading.texts.size(), 3);
      EXPECT_EQ(reading.texts.front(), "first");
      EXPECT_EQ(reading.texts[reading.texts.size() - 2], "third");
      EXPECT_EQ(reading.texts.back(), "fourth");
      EXPECT_TRUE(at >= begin + 4 || reading.texts.size() == 3);  // the sync word
      if (reading.texts.size() == 3) {
        ASSERT_EQ(reading.passed_over.size(), 1);
        EXPECT_EQ(reading.passed_over[0],
                  fmt::format("{}: {} bytes from byte {} on are passed over: the file is damaged, "
                              "there is no whole event",
                              file.string(), end - begin, begin));
      }
      const bool is_number_or_time = at >= begin + 4 && at < begin + 20;
      EXPECT_TRUE(!is_number_or_time || reading.texts == texts);
    }
  }
}

TEST(EventLog, ALengthThatReachesToTheEndOfAnotherEventIsWrong) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  const std::vector<std::string> texts = {"first", "second", "third"};
  for (const std::size_t damaged : {0u, 1u}) {
    std::filesystem::remove(file);
    std::uintmax_t begin = 0;
    {
      EventLog log(file, EventLog::Mode::kNew);
      for (const std::string& text : texts) log.Write(Message("A", text, 1));
    }
    for (std::size_t i = 0; i < damaged; ++i) begin += kBeforeData + texts[i].size();
    SetByte(file, begin + kBeforeData - 2,
            static_cast<int>(texts[damaged].size() + kBeforeData + texts[damaged + 1].size()));
    const Reading reading = ReadAll(file);
    ASSERT_EQ(reading.texts.size(), 2);
    EXPECT_EQ(reading.texts[0], texts[1 - damaged]);
    EXPECT_EQ(reading.texts[1], "third");
    EXPECT_EQ(reading.passed_over.size(), 1);
  }
}

TEST(EventLog, ASyncWordWithinAMessageIsNoEvent) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  const std::string sync_word = "\xed\xa1\xda\x01";
  const std::vector<std::string> texts = {sync_word, sync_word + std::string(30, '\0'),
                                          sync_word + std::string(30, '\x7f'), sync_word};
  {
    EventLog log(file, EventLog::Mode::kNew);
    for (const std::string& text : texts) log.Write(Message("A", text, 1));
  }
  const Reading whole = ReadAll(file);
  EXPECT_EQ(whole.texts, texts);
  EXPECT_TRUE(whole.passed_over.empty());
  const std::uintmax_t second = kBeforeData + texts[0].size();
  SetByte(file, second, 0);
  SetByte(file, second + kBeforeData + texts[1].size(), 0);
  const Reading damaged = ReadAll(file);
  EXPECT_EQ(damaged.texts, (std::vector<std::string>{sync_word, sync_word}));
  EXPECT_EQ(damaged.passed_over.size(), 1);
}

TEST(EventLog, DamageInSeveralPlacesIsToldInALineOfItsFile) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  // Longer than what is kept in memory.
  const std::string long_text(100'000, 'x');
  const std::uintmax_t bytes = kBeforeData + long_text.size();
  {
    EventLog log(file, EventLog::Mode::kNew, 6 * bytes);
    for (int i = 0; i < 8; ++i) log.Write(Message("A", long_text, i));
  }
  for (const int damaged : {1, 3, 4}) SetByte(file, static_cast<unsigned>(damaged) * bytes, 0);
  std::filesystem::resize_file(folder / "a.lcmlog.01", 2 * bytes - 7);
  const Reading reading = ReadAll(file);
  EXPECT_EQ(reading.texts, std::vector<std::string>(4, long_text));
  ASSERT_EQ(reading.passed_over.size(), 2);
  EXPECT_TRUE(reading.passed_over[0].starts_with(
      fmt::format("{}: {} bytes in 2 places, the first from byte {} on, are passed over",
                  file.string(), 3 * bytes, bytes)))
      << reading.passed_over[0];
  EXPECT_TRUE(reading.passed_over[1].starts_with(
      fmt::format("{}.01: {} bytes after the last whole event are not read: from byte {} on",
                  file.string(), bytes - 7, bytes)))
      << reading.passed_over[1];
}

TEST(EventLog, WhatGoesOnBehindDamageCutsOffTheTornEndAlone) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  const std::uintmax_t bytes = kBeforeData + 4;
  {
    EventLog log(file, EventLog::Mode::kNew);
    for (int i = 0; i < 5; ++i) log.Write(Message("A", "data", i));
  }
  SetByte(file, bytes, 0);
  std::filesystem::resize_file(file, 5 * bytes - 2);
  EventLog(file, EventLog::Mode::kAppend).Write(Message("A", "after", 5));
  EXPECT_EQ(std::filesystem::file_size(file), 5 * bytes + 1);
  const Reading reading = ReadAll(file);
  EXPECT_EQ(reading.texts, (std::vector<std::string>{"data", "data", "data", "after"}));
  EXPECT_EQ(reading.passed_over.size(), 1);
  EXPECT_EQ(ReadEventLogFile(file, [](const ReceivedMessage&) {}).next_number, 5);
}

TEST(EventLog, WhetherAFileHoldsAnEvent) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  for (const char* text : {"", "x", "root:x:0:0:root:/root:/bin/bash\n", "\xed\xa1\xda\x01"}) {
    folder.Write("a.lcmlog", text);
    EXPECT_FALSE(HoldsEvent(file)) << text;
  }
  // In any of its files, whatever is before it.
  EventLog(folder / "b.lcmlog", EventLog::Mode::kNew).Write(Message("A", "data", 1));
  std::filesystem::rename(folder / "b.lcmlog", folder / "a.lcmlog.01");
  SetByte(folder / "a.lcmlog.01", kBeforeData + 4, 'x');
  EXPECT_TRUE(HoldsEvent(file));
  ExpectInputError([&] { HoldsEvent(folder / "none.lcmlog"); }, {"none.lcmlog"});
  ExpectInputError([&] { HoldsEvent(folder.path()); }, {folder.path().string(), "not a file"});
}

std::vector<Event> ReadEventsOfAll(const std::vector<std::filesystem::path>& files) {
  std::vector<Event> events;
  for (const std::filesystem::path& file : files) {
    for (const Event& event : ReadEvents(file)) events.push_back(event);
  }
  return events;
}

std::vector<Event> Numbered(int count) {
  std::vector<Event> events;
  for (int i = 0; i < count; ++i) events.push_back({i, i, "A", "data"});
  return events;
}

// Two of Numbered's events.
constexpr std::uintmax_t kTwoEvents = 2 * (28 + 1 + 4);

TEST(EventLog, IsSplitBySizeAndNumbersGoOn) {
  const TemporaryFolder folder;
  {
    EventLog log(folder / "a.lcmlog", EventLog::Mode::kNew, kTwoEvents);
    for (int i = 0; i < 6; ++i) log.Write(Message("A", "data", i));
    EXPECT_EQ(log.num_files(), 3);  // the third is full, a fourth is not begun without need
  }
  const std::vector<std::filesystem::path> files = {folder / "a.lcmlog", folder / "a.lcmlog.01",
                                                    folder / "a.lcmlog.02"};
  EXPECT_EQ(EventLogFiles(folder / "a.lcmlog"), files);
  EXPECT_EQ(ReadEvents(files[1]).size(), 2);
  EXPECT_EQ(ReadEventsOfAll(files), Numbered(6));
}

TEST(EventLog, GoesOnInItsLastFile) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  for (int i = 0; i < 5; ++i) {
    EventLog log(file, EventLog::Mode::kAppend, kTwoEvents);
    log.Write(Message("A", "data", i));
  }
  EXPECT_EQ(EventLogFiles(file).size(), 3);
  EXPECT_EQ(ReadEventsOfAll(EventLogFiles(file)), Numbered(5));
  // A logger that was killed when it had just begun a file, and one that tore an event.
  folder.Write("a.lcmlog.03", "");
  EventLog(file, EventLog::Mode::kAppend, kTwoEvents).Write(Message("A", "data", 5));
  EXPECT_EQ(ReadEventsOfAll(EventLogFiles(file)), Numbered(6));
  std::filesystem::resize_file(folder / "a.lcmlog.03", 20);
  EventLog(file, EventLog::Mode::kAppend, kTwoEvents).Write(Message("A", "data", 5));
  EXPECT_EQ(ReadEventsOfAll(EventLogFiles(file)), Numbered(6));
}

TEST(EventLog, ASplitLogIsReadAsOne) {
  const TemporaryFolder folder;
  const auto read = [](const std::filesystem::path& file) {
    std::vector<std::int64_t> times;
    ReadEventLog(file, [&](const ReceivedMessage& message) { times.push_back(message.utime); });
    return times;
  };
  {
    EventLog log(folder / "a.lcmlog", EventLog::Mode::kNew, 1);
    for (int i = 0; i < 12; ++i) log.Write(Message("A", "data", i));
  }
  folder.Write("a.lcmlog.part", "");
  folder.Write("a.lcmlog.1", "");
  folder.Write("b.lcmlog.01", "");
  EXPECT_EQ(read(folder / "a.lcmlog"),
            (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(read(folder / "a.lcmlog.07"), (std::vector<std::int64_t>{7}));
  // As lcm-logger begins.
  std::filesystem::rename(folder / "a.lcmlog", folder / "a.lcmlog.00");
  EXPECT_EQ(read(folder / "a.lcmlog.00").size(), 12);
  std::filesystem::remove(folder / "a.lcmlog.03");
  ExpectInputError([&] { read(folder / "a.lcmlog.00"); }, {"a.lcmlog.03 is missing"});
}

TEST(EventLog, MessagesCanBeReadAnewWhereTheyAre) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  {
    EventLog log(file, EventLog::Mode::kNew, kTwoEvents);
    for (int i = 0; i < 5; ++i) log.Write(Message("A", fmt::format("data{}", i), i));
  }
  SetByte(file, 0, 0);  // what is passed over moves no other
  std::vector<LoggedMessage> messages;
  ReadEventLog(file, [&](const LoggedMessage& message) { messages.push_back(message); });
  ASSERT_EQ(messages.size(), 4u);
  for (const LoggedMessage& message : messages) {
    EXPECT_EQ(ReadEventBytes(message.place), message.bytes) << message.utime;
  }
  EXPECT_EQ(*messages[3].place.file, folder / "a.lcmlog.02");
  std::filesystem::resize_file(folder / "a.lcmlog.02", 30);
  ExpectInputError([&] { ReadEventBytes(messages[3].place); }, {"a.lcmlog.02", "was shortened"});
}

TEST(EventLog, AMessageIsReadAnewWithoutItsNeighbours) {
  // What this process had read from files so far.
  const auto bytes_read = [] {
    std::ifstream counts("/proc/self/io");
    std::string name;
    std::int64_t bytes = -1;
    counts >> name >> bytes;
    return name == "rchar:" ? bytes : -1;
  };
  if (bytes_read() <= 0) GTEST_SKIP() << "this kernel does not count";
  const TemporaryFolder folder;
  {
    EventLog log(folder / "a.lcmlog", EventLog::Mode::kNew);
    for (int i = 0; i < 20; ++i) log.Write(Message("A", std::string(5000, 'a'), i));
  }
  std::vector<EventPlace> places;
  ReadEventLog(folder / "a.lcmlog",
               [&](const LoggedMessage& message) { places.push_back(message.place); });
  const std::int64_t before = bytes_read();
  for (const EventPlace& place : places) EXPECT_EQ(ReadEventBytes(place).size(), 5000u);
  EXPECT_LT(bytes_read() - before, 20 * 10'000);
}

TEST(EventLog, AFileThatIsMissingAtTheEndIsNamed) {
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  const auto num_files = [&] { return EventLogFiles(file).size(); };
  {
    EventLog log(file, EventLog::Mode::kNew, 1);
    for (int i = 0; i < 4; ++i) log.Write(Message("A", "data", i));
  }
  // A logger that was killed may have begun more than it told of.
  for (const char* told : {R"({"event_log_files": 4})", R"({"event_log_files": 3})", "{}", "[",
                           R"({"event_log_files": "many"})", R"({"event_log_files": -1})"}) {
    folder.Write("run.json", told);
    EXPECT_EQ(num_files(), 4) << told;
  }
  folder.Write("run.json", R"({"event_log_files": 4})");
  std::filesystem::remove(folder / "a.lcmlog.03");
  const std::vector<std::string> said = {"a.lcmlog.03 is missing", "has 4 files",
                                         (folder / "run.json").string()};
  ExpectInputError([&] { ReadEventLog(file, [](const ReceivedMessage&) {}); }, said);
  ExpectInputError([&] { EventLog(file, EventLog::Mode::kAppend); }, said);
  std::filesystem::remove(folder / "a.lcmlog.02");
  ExpectInputError([&] { num_files(); }, {"a.lcmlog.02 is missing"});
  // run.json does not tell of a part by itself, nor of which log among several.
  EXPECT_EQ(EventLogFiles(folder / "a.lcmlog.01").size(), 1);
  folder.Write("whole.lcmlog", "");
  EXPECT_EQ(num_files(), 2);
}

TEST(EventLog, NeverOverwrites) {
  const TemporaryFolder folder;
  folder.Write("a.lcmlog", "precious");
  EXPECT_THROW(EventLog(folder / "a.lcmlog", EventLog::Mode::kNew), InputError);
  EXPECT_EQ(ReadText(folder / "a.lcmlog"), "precious");
  folder.Write("b.lcmlog.01", "precious");
  EXPECT_THROW(EventLog(folder / "b.lcmlog", EventLog::Mode::kNew), InputError);
}

TEST(EventLog, RefusesAFolderThatIsNotThere) {
  const TemporaryFolder folder;
  EXPECT_THROW(EventLog(folder / "none" / "a.lcmlog", EventLog::Mode::kNew), InputError);
}

TEST(EventLog, SaysWhenTheDiskIsFull) {
  // Every write to this device fails with ENOSPC.
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  const TemporaryFolder folder;
  const auto file = folder / "a.lcmlog";
  {
    EventLog log(file, EventLog::Mode::kNew);
    log.Write(Message("A", "a", 1));
    log.Flush();
  }
  std::filesystem::remove(file);
  std::filesystem::create_symlink("/dev/full", file);
  EventLog log(file, EventLog::Mode::kAppend);
  try {
    log.Write(Message("B", "b", 2));
    log.Flush();
    FAIL() << "the full disk went unnoticed";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("a.lcmlog"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace planbench
