#include "messaging/program.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <csignal>
#include <cstdlib>

#include "common/command_line.h"
#include "messaging/lcm_url.h"

namespace planbench {
namespace {

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void IgnoreSignalsThatWritingRaises() {
  // A reader of our output that has gone must not kill a benchmark.
  std::signal(SIGPIPE, SIG_IGN);
  // Nor a file that may not grow any more: writing it fails, and that is told.
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

std::function<bool()> AwaitStopSignals() {
  struct sigaction action = {};
  action.sa_handler = [](int) { stop_requested = true; };
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // The terminal was closed, or the connection to it lost. Under nohup that is no reason to end.
  struct sigaction hangup = {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  return [] { return stop_requested.load(); };
}

Program::Program(const std::string& name, const std::string& description)
    : name_(name), app_(description, name) {
  AddVersionFlag(&app_);
  app_.add_option("--lcm-url", lcm_url_flag_,
                  "LCM bus; default $LCM_DEFAULT_URL, else " + LcmUrl());
  app_.get_formatter()->column_width(40);
}

std::string Program::lcm_url() const { return ResolveLcmUrl(lcm_url_flag_); }

int Program::Run(int argc, char** argv, const std::function<int()>& work) {
  // https://no-color.org; without it colours are for terminals alone.
  const char* no_color = std::getenv("NO_COLOR");
  const bool plain = no_color != nullptr && *no_color != '\0';
  const auto log = spdlog::stderr_color_mt(
      name_, plain ? spdlog::color_mode::never : spdlog::color_mode::automatic);
  log->set_pattern("%H:%M:%S.%e %n %^%l%$: %v");
  spdlog::set_default_logger(log);
  return RunCommand(&app_, argc, argv, [&] {
    IgnoreSignalsThatWritingRaises();
    return work();
  });
}

}  // namespace planbench
