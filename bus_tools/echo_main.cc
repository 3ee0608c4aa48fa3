#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <limits>
#include <mutex>
#include <regex>
#include <string>
#include <thread>

#include "bus_tools/echo.h"
#include "bus_tools/traffic.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "common/standard_output.h"
#include "messaging/bus.h"
#include "messaging/program.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;

std::regex ChannelPattern(const std::string& text) {
  try {
    return std::regex(text);
  } catch (const std::regex_error& error) {
    throw InputError(fmt::format("'{}' is no regular expression: {}", text, error.what()));
  }
}

int Main(int argc, char** argv) {
  Program program("bus_echo",
                  "Prints what is said on the bus: every message, or those of some channels, field "
                  "by field. Ctrl-C ends it.");
  std::string channels = ".*";
  EchoFormat format;
  bool brief = false;
  bool full = false;
  bool rates = false;
  int count = 0;
  program.app().add_option("channels", channels,
                           "regular expression for the channels; default: all");
  program.app().add_flag("--brief", brief, "one line a message");
  program.app()
      .add_flag(
          "--full", full,
          fmt::format("all fields, however long; default: {} lines a message, of {} characters",
                      format.max_lines, format.max_line_length))
      ->excludes("--brief");
  program.app()
      .add_flag("--rates", rates, "no messages: once a second how many come on each channel")
      ->excludes("--brief")
      ->excludes("--full");
  program.app()
      .add_option("--count", count, "ends after so many messages, or tables of rates")
      ->check(CLI::Range(1, std::numeric_limits<int>::max()));
  return program.Run(argc, argv, [&] {
    const std::regex pattern = ChannelPattern(channels);
    format.fields = !brief;
    if (full) format.max_lines = format.max_line_length = 0;
    const int last = count > 0 ? count : std::numeric_limits<int>::max();
    std::mutex mutex;
    Traffic traffic;
    std::atomic<int> num_shown = 0;

    Bus bus(program.lcm_url());
    const Subscription subscription = bus.SubscribeToAll(
        [&](const ReceivedMessage& message) {
          if (!std::regex_match(message.channel, pattern)) return;
          if (rates) {
            const std::scoped_lock lock(mutex);
            traffic.Add(message);
          } else if (num_shown < last) {
            WriteOut(EchoText(message, format));
            std::fflush(stdout);
            ++num_shown;
          }
        },
        kQueueCapacity);
    bus.Start();
    const auto stop = AwaitStopSignals();
    for (Clock::time_point then = Clock::now();
         !stop() && num_shown < last && std::ferror(stdout) == 0;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const double seconds = std::chrono::duration<double>(Clock::now() - then).count();
      if (!rates || seconds < 1) continue;
      then = Clock::now();
      const std::scoped_lock lock(mutex);
      WriteOut(fmt::format("{}\n", traffic.Rates(seconds, bus.counters())));
      std::fflush(stdout);
      ++num_shown;
    }
    return kExitOk;
  });
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) { return planbench::Main(argc, argv); }
