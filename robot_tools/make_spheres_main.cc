#include "common/command_line.h"
#include "common/exit_codes.h"
#include "robot_tools/make_spheres.h"

int main(int argc, char** argv) {
  CLI::App app("Fits spheres to a robot's collision geometry: around it and within it.",
               "make_spheres");
  planbench::AddVersionFlag(&app);
  planbench::MakeSpheresFlags flags;
  flags.AddTo(&app);
  return planbench::RunCommand(&app, argc, argv, [&] {
    planbench::MakeSpheres(flags, planbench::PrintLine);
    return planbench::kExitOk;
  });
}
