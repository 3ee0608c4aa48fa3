#include "benchmark_driver/driver_flags.h"
#include "benchmark_driver/run_session.h"
#include "messaging/program.h"

int main(int argc, char** argv) {
  planbench::Program program("benchmark_driver",
                             "Runs motion planners over problem sets and compares them.");
  planbench::DriverFlags flags;
  flags.AddTo(&program.app());
  return program.Run(argc, argv, [&] {
    const planbench::DriverOptions options = flags.Parse();
    return planbench::RunSession(options, flags.AsSettings(options), program.lcm_url(),
                                 program.lcm_url_given(), planbench::StopRequested);
  });
}
