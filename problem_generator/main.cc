#include <CLI/CLI.hpp>
#include <iostream>

#include "common/error.h"
#include "common/exit_codes.h"
#include "common/version.h"
#include "problem_generator/generator_flags.h"

int main(int argc, char** argv) {
  CLI::App app("Makes a set of motion-planning problems from a specification.", "make_problems");
  app.set_version_flag("--version",
                       "make_problems " + planbench::Version() + " (" + planbench::Commit() + ")");
  planbench::GeneratorFlags flags;
  flags.AddTo(&app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::cerr << "make_problems: " << error.what() << " (see make_problems --help)\n";
    return planbench::kExitBadInput;
  }
  try {
    return planbench::RunGenerator(flags);
  } catch (const planbench::InputError& error) {
    std::cerr << "make_problems: " << error.what() << "\n";
    return planbench::kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "make_problems: failed: " << error.what() << "\n";
    return planbench::kExitFailed;
  }
}
