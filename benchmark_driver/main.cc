#include "benchmark_driver/driver_flags.h"
#include "benchmark_driver/run_session.h"
#include "messaging/program.h"

int main(int argc, char** argv) {
  planbench::Program program("benchmark_driver",
                             "Runs motion planners over problem sets and compares them.");
  planbench::DriverOptions options;
  planbench::AddDriverFlags(&program.app(), &options);
  CLI::Option* const lcm_url = program.app().get_option("--lcm-url");
  lcm_url->description(lcm_url->get_description() + "; with --launch a port that is free");
  return program.Run(argc, argv, [&] {
    return planbench::RunSession(options, planbench::FlagsOf(program.app()), program.lcm_url(),
                                 program.lcm_url_given(), planbench::AwaitStopSignals());
  });
}
