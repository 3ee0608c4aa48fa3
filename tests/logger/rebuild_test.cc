#include "logger/rebuild.h"

#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "logger/session_recorder.h"
#include "messaging/channels.h"
#include "messaging/event_log_reader.h"
#include "results/bus_json.h"
#include "sample_messages.h"
#include "session_files.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

class RebuildTest : public testing::Test {
 protected:
  /// Records messages as they come from a bus; returns the event log.
  std::filesystem::path Live(const std::vector<ReceivedMessage>& messages,
                             std::optional<std::uintmax_t> split_bytes = {}) {
    SessionRecorder recorder(
        temporary_ / "live", false, "logger", [](const std::string&, const AckMessage&) {},
        &contradictions_, split_bytes);
    for (const ReceivedMessage& message : messages) recorder.Record(message);
    recorder.Flush();
    recorder.Report();
    return recorder.folder().event_log();
  }
  LoggerOptions Options() const {
    LoggerOptions options;
    options.out = temporary_ / "rebuilt";
    return options;
  }

  TemporaryFolder temporary_;
  Contradictions contradictions_;
};

TEST_F(RebuildTest, TheSameMessagesMakeTheSameDatabase) {
  const auto log = Live({Received(channel::kSession, SampleSession()),
                         {"SOMETHING_ELSE", {1, 2, 3}, 7},
                         Received(channel::kRunRecord, SampleRecord()),
                         Received(channel::kRunRecord, SampleRecord()),
                         Received(channel::kRunRecord, UnansweredRecord()),
                         Received(channel::kSession, FinishedSession())});
  EXPECT_TRUE(RebuildSession(log, Options()));
  EXPECT_EQ(DumpDatabase(temporary_ / "rebuilt" / "results.sqlite"),
            DumpDatabase(temporary_ / "live" / "results.sqlite"));
  EXPECT_EQ(TextOf(temporary_ / "rebuilt" / "run.json"), TextOf(temporary_ / "live" / "run.json"));
  EXPECT_EQ(TextOf(temporary_ / "rebuilt" / "rebuilt.lcmlog"), TextOf(log));
}

TEST_F(RebuildTest, ASplitEventLogIsOne) {
  const std::vector<ReceivedMessage> messages = {Received(channel::kSession, SampleSession()),
                                                 Received(channel::kRunRecord, SampleRecord()),
                                                 Received(channel::kRunRecord, UnansweredRecord()),
                                                 Received(channel::kSession, FinishedSession())};
  const auto log = Live(messages, 1);
  EXPECT_TRUE(std::filesystem::exists(log.string() + ".03"));
  EXPECT_NE(TextOf(temporary_ / "live" / "run.json").find("\"event_log_files\": 4"),
            std::string::npos);
  EXPECT_TRUE(RebuildSession(log, Options()));
  EXPECT_EQ(DumpDatabase(temporary_ / "rebuilt" / "results.sqlite"),
            DumpDatabase(temporary_ / "live" / "results.sqlite"));
  EXPECT_NE(TextOf(temporary_ / "rebuilt" / "run.json").find("\"event_log_files\": 1"),
            std::string::npos);
}

TEST_F(RebuildTest, WhatWasLostOnTheBusIsAsTheLogsFolderTellsOrNotTold) {
  const auto log = Live({Received(channel::kSession, SampleSession())});
  const auto bus_of = [&](const std::filesystem::path& file) {
    LoggerOptions options = Options();
    std::filesystem::remove_all(options.out);
    EXPECT_TRUE(RebuildSession(file, options));
    return ReadBusJson(options.out / "run.json");
  };
  EXPECT_EQ(bus_of(log), "") << "nothing was";
  WriteBusJson(temporary_ / "live" / "run.json", R"({"lost_messages":3})");
  EXPECT_EQ(bus_of(log), R"({"lost_messages":3})");
  std::filesystem::copy_file(log, temporary_ / "copy.lcmlog");
  EXPECT_EQ(bus_of(temporary_ / "copy.lcmlog"), kBusNotTold);
  std::filesystem::copy_file(temporary_ / "live" / "run.json", temporary_ / "run.json");
  EXPECT_EQ(bus_of(temporary_ / "copy.lcmlog"), R"({"lost_messages":3})");
  std::filesystem::copy_file(log, temporary_ / "another.lcmlog");
  EXPECT_EQ(bus_of(temporary_ / "copy.lcmlog"), kBusNotTold) << "it may be the other's";
}

TEST_F(RebuildTest, ATornLastEventIsLeftOut) {
  const auto log = Live({Received(channel::kRunRecord, SampleRecord()),
                         Received(channel::kRunRecord, UnansweredRecord())});
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 5);
  EXPECT_TRUE(RebuildSession(log, Options()));
  ResultsDatabase rebuilt(temporary_ / "rebuilt" / "results.sqlite");
  EXPECT_EQ(rebuilt.Store(SampleRecord()), ResultsDatabase::Outcome::kAlreadyStored);
  EXPECT_EQ(rebuilt.Store(UnansweredRecord()), ResultsDatabase::Outcome::kStored);
}

TEST_F(RebuildTest, OfADamagedLogACleanOneIsMade) {
  const auto log = Live({Received(channel::kSession, SampleSession()),
                         Received(channel::kRunRecord, SampleRecord()),
                         Received(channel::kRunRecord, UnansweredRecord())});
  std::fstream(log, std::ios::binary | std::ios::in | std::ios::out).put(0);
  EXPECT_TRUE(RebuildSession(log, Options()));
  ResultsDatabase rebuilt(temporary_ / "rebuilt" / "results.sqlite");
  EXPECT_EQ(rebuilt.Store(SampleRecord()), ResultsDatabase::Outcome::kAlreadyStored);
  EXPECT_EQ(rebuilt.Store(UnansweredRecord()), ResultsDatabase::Outcome::kAlreadyStored);
  int num_events = 0;
  const auto passed_over = ReadEventLog(temporary_ / "rebuilt" / "rebuilt.lcmlog",
                                        [&](const ReceivedMessage&) { ++num_events; });
  EXPECT_EQ(num_events, 2);
  EXPECT_TRUE(passed_over.empty());
}

TEST_F(RebuildTest, WhatCannotBeStoredIsAFailure) {
  EXPECT_FALSE(RebuildSession(Live({{channel::kRunRecord, {1, 2, 3}, 7}}), Options()));
}

TEST_F(RebuildTest, ALogIsNotAddedToItself) {
  const auto log = Live({Received(channel::kSession, SampleSession())}, 1);
  const std::string before = TextOf(log);
  LoggerOptions options = Options();
  options.out = temporary_ / "live" / "";
  options.resume = true;
  std::filesystem::create_symlink(log, temporary_ / "link.lcmlog");
  for (const auto& file : {log, temporary_ / "link.lcmlog"}) {
    ExpectInputError([&] { RebuildSession(file, options); }, {file.string(), "--out itself"});
  }
  EXPECT_EQ(TextOf(log), before);
  options.out = temporary_ / "new";  // with --resume all the same
  EXPECT_TRUE(RebuildSession(log, options));
}

TEST_F(RebuildTest, BadUseMakesNoFolder) {
  ExpectInputError([&] { RebuildSession(temporary_ / "none.lcmlog", Options()); },
                   {"none.lcmlog", "no such event log"});
  for (const char* text : {"", "root:x:0:0:root:/root:/bin/bash\n"}) {
    WriteText(temporary_ / "passwd", text);
    ExpectInputError([&] { RebuildSession(temporary_ / "passwd", Options()); },
                     {(temporary_ / "passwd").string(), "no event of an LCM event log"});
  }
  const auto log = Live(
      {Received(channel::kSession, SampleSession()), Received(channel::kRunRecord, SampleRecord()),
       Received(channel::kRunRecord, UnansweredRecord())},
      1);
  std::filesystem::remove(log.string() + ".02");
  ExpectInputError([&] { RebuildSession(log, Options()); }, {"live.lcmlog.02 is missing"});
  EXPECT_FALSE(std::filesystem::exists(temporary_ / "rebuilt"));
}

}  // namespace
}  // namespace planbench
