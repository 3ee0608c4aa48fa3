#include "bus_tools/diagnosis.h"
#include "common/exit_codes.h"
#include "common/standard_output.h"
#include "messaging/program.h"

namespace planbench {
namespace {

int Main(int argc, char** argv) {
  Program program(
      "bus_doctor",
      "Looks at the bus: multicast route, receive buffer, who else is on the port, versions, "
      "robots, loss on the way from others and within this machine; and says how to "
      "mend what is wrong. Exit code 1 if something is.");
  return program.Run(argc, argv, [&] {
    bool healthy = true;
    for (const Finding& finding : Diagnose({.lcm_url = program.lcm_url()})) {
      WriteOut(FindingText(finding));
      healthy = healthy && finding.kind != Finding::Kind::kFault;
    }
    return healthy ? kExitOk : kExitFailed;
  });
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) { return planbench::Main(argc, argv); }
