#include "common/command_line.h"
#include "problem_generator/generator_flags.h"

int main(int argc, char** argv) {
  CLI::App app("Makes a set of motion-planning problems from a specification.", "make_problems");
  planbench::AddVersionFlag(&app);
  planbench::GeneratorFlags flags;
  flags.AddTo(&app);
  return planbench::RunCommand(&app, argc, argv, [&] { return planbench::RunGenerator(flags); });
}
