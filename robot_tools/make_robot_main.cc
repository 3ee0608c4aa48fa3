#include "common/command_line.h"
#include "common/exit_codes.h"
#include "robot_tools/make_robot.h"

int main(int argc, char** argv) {
  CLI::App app("Makes a robot folder from a robot's own files.", "make_robot");
  planbench::AddVersionFlag(&app);
  planbench::MakeRobotFlags flags;
  flags.AddTo(&app);
  return planbench::RunCommand(&app, argc, argv, [&] {
    planbench::MakeRobot(flags, planbench::PrintLine);
    return planbench::kExitOk;
  });
}
