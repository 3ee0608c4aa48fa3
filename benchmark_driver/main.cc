#include "benchmark_driver/driver_flags.h"
#include "benchmark_driver/run_session.h"
#include "messaging/program.h"

int main(int argc, char** argv) {
  planbench::Program program("benchmark_driver",
                             "Runs motion planners over problem sets and compares them.");
  planbench::DriverOptions options;
  planbench::AddDriverFlags(&program.app(), &options);
  return program.Run(argc, argv, [&] {
    return planbench::RunSession(options, planbench::FlagsOf(program.app()), program.lcm_url(),
                                 program.lcm_url_given(), planbench::AwaitStopSignals());
  });
}
