#include "messaging/program.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <csignal>
#include <iostream>

#include "common/error.h"
#include "common/text.h"
#include "common/version.h"
#include "geometry/mesh_loader.h"
#include "messaging/lcm_url.h"

namespace planbench {
namespace {

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void OnSignal(int) { stop_requested = true; }

void InstallSignalHandlers() {
  struct sigaction action = {};
  action.sa_handler = OnSignal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A reader of our output that has gone must not kill a benchmark.
  std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace

bool StopRequested() { return stop_requested; }

Program::Program(const std::string& name, const std::string& description)
    : name_(name), app_(description, name) {
  app_.set_version_flag("--version", name + " " + Version() + " (" + Commit() + ")");
  app_.add_option("--lcm-url", lcm_url_flag_,
                  "LCM bus; default $LCM_DEFAULT_URL, else " + LcmUrl());
  app_.get_formatter()->column_width(40);
}

std::string Program::lcm_url() const { return ResolveLcmUrl(lcm_url_flag_); }

int Program::Run(int argc, char** argv, const std::function<int()>& work) {
  const auto log = spdlog::stderr_color_mt(name_);
  log->set_pattern("%H:%M:%S.%e %n %^%l%$: %v");
  spdlog::set_default_logger(log);
  try {
    // What is given goes into messages, databases and JSON.
    for (int i = 1; i < argc; ++i) {
      if (FindInvalidUtf8(argv[i])) throw InputError(std::string(argv[i]) + ": is no UTF-8 text");
    }
    app_.parse(argc, argv);
    InstallSignalHandlers();
    return work();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_.exit(error);  // --help, --version
    std::cerr << name_ << ": " << error.what() << " (see " << name_ << " --help)\n";
    return kExitBadInput;
  } catch (const InputError& error) {
    std::cerr << name_ << ": " << error.what() << "\n";
    return kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << name_ << ": failed: " << error.what() << "\n";
    return kExitFailed;
  }
}

void AddPackagePathFlag(CLI::App* app, std::vector<std::string>* arguments) {
  app->add_option("--package-path", *arguments,
                  "NAME=DIR: folder that package://NAME/ stands for; repeatable")
      ->allow_extra_args(false);
}

std::map<std::string, std::filesystem::path> ParsePackagePaths(
    const std::vector<std::string>& arguments) {
  std::map<std::string, std::filesystem::path> packages;
  for (const std::string& argument : arguments) packages.insert(ParsePackagePath(argument));
  return packages;
}

}  // namespace planbench
