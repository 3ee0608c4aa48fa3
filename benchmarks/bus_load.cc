// How much a logger takes: sends numbered messages at a steady rate, or counts in an event log
// those that arrived.
//
//   logger --lcm-url URL --out DIR &  bus_load --lcm-url URL --rate 20000 --bytes 200 --seconds 60
//   bus_load --count DIR/NAME.lcmlog
//
// Sending prints how many messages went out and how fast; counting how many there are and how many
// are missing up to the last number.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "common/command_line.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "messaging/bus.h"
#include "messaging/event_log_reader.h"
#include "messaging/lcm_url.h"

namespace {

constexpr char kChannel[] = "BUS_LOAD";

void Send(const std::string& url, double rate, std::size_t num_bytes, double seconds) {
  using Clock = std::chrono::steady_clock;
  planbench::Bus bus(url);
  std::vector<std::uint8_t> bytes(num_bytes);
  std::int64_t number = 0;
  const auto begin = Clock::now();
  double elapsed = 0;
  // As many as are due, then a short sleep: small bursts, as processes make them.
  while ((elapsed = std::chrono::duration<double>(Clock::now() - begin).count()) < seconds) {
    const auto due = static_cast<std::int64_t>(elapsed * rate);
    for (; number < due; ++number) {
      std::memcpy(bytes.data(), &number, sizeof number);
      bus.PublishBytes(kChannel, bytes);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  fmt::print("{} messages of {} bytes in {:.1f} s: {:.0f}/s, {:.1f} MB/s\n", number, num_bytes,
             elapsed, static_cast<double>(number) / elapsed,
             static_cast<double>(number) * static_cast<double>(num_bytes) / elapsed * 1e-6);
}

void Count(const std::string& event_log) {
  std::int64_t count = 0;
  std::int64_t last = -1;
  const auto take = [&](const planbench::ReceivedMessage& message) {
    std::int64_t number = 0;
    if (message.channel != kChannel || message.bytes.size() < sizeof number) return;
    std::memcpy(&number, message.bytes.data(), sizeof number);
    last = std::max(last, number);
    ++count;
  };
  for (const std::string& line : planbench::ReadEventLog(event_log, take)) {
    fmt::print(stderr, "{}\n", line);
  }
  fmt::print("{} messages, {} missing\n", count, last + 1 - count);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Loads a bus, and counts what a logger has of it.", "bus_load");
  std::string url;
  std::string event_log;
  double rate = 20000;
  std::size_t num_bytes = 200;
  double seconds = 60;
  app.add_option("--lcm-url", url, "bus; default $LCM_DEFAULT_URL, else " + planbench::LcmUrl());
  app.add_option("--rate", rate, "messages a second")->capture_default_str();
  app.add_option("--bytes", num_bytes, "of a message")
      ->check(CLI::Range(sizeof(std::int64_t), std::size_t{1} << 24U))
      ->capture_default_str();
  app.add_option("--seconds", seconds, "how long")->capture_default_str();
  app.add_option("--count", event_log, "event log to count in; sends nothing");
  return planbench::RunCommand(&app, argc, argv, [&] {
    if (event_log.empty()) {
      Send(planbench::ResolveLcmUrl(url), rate, num_bytes, seconds);
    } else {
      Count(event_log);
    }
    return planbench::kExitOk;
  });
}
