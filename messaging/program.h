#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "common/exit_codes.h"

namespace planbench {

/// What every main() has in common: --help, --version, --lcm-url, log set-up, and errors
/// as one line and an exit code. Usage: construct, add flags to `app()`, return Run(argc, argv,
/// work).
class Program {
 public:
  Program(const std::string& name, const std::string& description);

  CLI::App& app() { return app_; }
  /// The URL to use, after Run has parsed the flags.
  std::string lcm_url() const;
  /// True if --lcm-url was given on the command line.
  bool lcm_url_given() const { return !lcm_url_flag_.empty(); }

  /// RunCommand (common/command_line.h) with the log set up; failing writes raise no signals.
  int Run(int argc, char** argv, const std::function<int()>& work);

 private:
  std::string name_;
  CLI::App app_;
  std::string lcm_url_flag_;
};

/// SIGINT, SIGTERM and, unless it is ignored (nohup), SIGHUP end a process at once, whatever it
/// prepares; from this call on they only ask it to stop. Returns whether one of them has come.
std::function<bool()> AwaitStopSignals();

}  // namespace planbench
