#include "bus_tools/echo.h"

#include <gmock/gmock.h>

#include "bus_tools/traffic.h"
#include "messaging/codec.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// 2026-01-02 03:04:05.678 UTC.
constexpr std::int64_t kUtime = 1767323045678901;

ReceivedMessage Discover(const std::string& sender) {
  return {"DISCOVER", Encode(DiscoverMessage{.sender = sender}), kUtime};
}

TEST(EchoText, ShowsWhenWhereWhatAndTheFields) {
  const ReceivedMessage message = Discover("me");
  const std::string text = EchoText(message, {});
  EXPECT_THAT(text, StartsWith("03:04:05.678  DISCOVER  lcmt_discover, " +
                               std::to_string(message.bytes.size()) + " bytes\n  utime: "));
  EXPECT_THAT(text, HasSubstr("\n  sender: \"me\"\n"));
}

TEST(EchoText, TellsTimesBeyondTheYear2262) {
  constexpr std::int64_t k2370 = 12'622'780'800'000'000;
  ReceivedMessage message = Discover("me");
  message.utime = k2370 + 3'723'004'000;
  EXPECT_THAT(EchoText(message, {}), StartsWith("01:02:03.004  DISCOVER"));
}

TEST(EchoText, IsOneLineWithoutFields) {
  const std::string text = EchoText(Discover("me"), {.fields = false});
  EXPECT_THAT(text, StartsWith("03:04:05.678  DISCOVER  lcmt_discover, "));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
}

TEST(EchoText, CutsLongLinesByCharactersAndCountsLinesLeftOut) {
  const std::string text = EchoText(Discover("aääää"), {.max_line_length = 11});
  EXPECT_THAT(text, HasSubstr("  sender: \"aä...\n"));
  ReceivedMessage many;
  many.channel = "PROBLEM_SETS";
  ProblemSetsMessage sets;
  for (int i = 0; i < 30; ++i) {
    sets.sets.push_back({"set" + std::to_string(i), {1}, std::string(32, 'a')});
  }
  many.bytes = Encode(sets);
  const std::string whole = EchoText(many, {.max_lines = 0});
  const std::string cut = EchoText(many, {.max_lines = 10});
  EXPECT_THAT(whole, HasSubstr("set29"));
  EXPECT_THAT(cut, Not(HasSubstr("set29")));
  const auto num_lines = std::count(whole.begin(), whole.end(), '\n') - 1;
  EXPECT_THAT(cut, HasSubstr("  ... " + std::to_string(num_lines - 10) + " more lines\n"));
}

TEST(EchoText, SaysWhatItCannotRead) {
  EXPECT_THAT(EchoText({"FOREIGN", std::vector<std::uint8_t>(20, 7), kUtime}, {}),
              HasSubstr("FOREIGN  of no type that this version knows, 20 bytes\n"));
  ReceivedMessage damaged = Discover("me");
  damaged.bytes.pop_back();
  EXPECT_THAT(EchoText(damaged, {}),
              testing::AllOf(HasSubstr("DISCOVER  damaged, "), HasSubstr("lcmt_discover")));
  EXPECT_THAT(EchoText({"A\x1b[2J", {}, kUtime}, {}), Not(HasSubstr("\x1b")));
}

TEST(Traffic, CountsMessagesAndBytesOfEachChannel) {
  Traffic traffic;
  for (int i = 0; i < 5; ++i) traffic.Add({"A", std::vector<std::uint8_t>(1000, 0), kUtime});
  traffic.Add({"LONG_CHANNEL", {1, 2}, kUtime});
  EXPECT_EQ(traffic.Rates(2, {.malformed = 1, .lost = 3, .dropped = 2}),
            "channel       messages/s        kB/s    messages\n"
            "A                    2.5         2.5           5\n"
            "LONG_CHANNEL         0.5         0.0           1\n"
            "lost: 3, came faster than they were read: 2, no packets of LCM: 1\n");
  EXPECT_THAT(traffic.Rates(1, {}), HasSubstr("A                    0.0         0.0           5"));
}

}  // namespace
}  // namespace planbench
