#include "logger/logger_node.h"
#include "logger/rebuild.h"
#include "messaging/program.h"

int main(int argc, char** argv) {
  using namespace planbench;
  Program program("logger",
                  "Records everything on the bus: an LCM event log and a results database.");
  LoggerOptions options;
  program.app()
      .add_option("--out", options.out, "Session folder; created if it does not exist")
      ->required();
  program.app().add_option("--name", options.name, "Name on the bus")->capture_default_str();
  program.app().add_flag("--resume", options.resume,
                         "Add to a session folder that holds results already");
  std::filesystem::path from;
  program.app().add_option("--from", from,
                           "LCM event log to record instead of a bus: builds the same database");
  int split_mb = 1024;
  program.app()
      .add_option("--split-mb", split_mb,
                  "Once a file of the event log has so many MB, begin another one; 0: never")
      ->check(CLI::Range(0, 1'000'000'000))
      ->capture_default_str();
  return program.Run(argc, argv, [&] {
    options.split_bytes.reset();
    if (split_mb > 0) options.split_bytes = static_cast<std::uintmax_t>(split_mb) << 20;
    if (!from.empty()) return RebuildSession(from, options) ? kExitOk : kExitFailed;
    const auto stop = AwaitStopSignals();  // before anything is on the disk that is to be closed
    Bus bus(program.lcm_url());
    LoggerNode logger(&bus, options);
    bus.Start();
    return logger.Run(stop) ? kExitOk : kExitFailed;
  });
}
