#pragma once

#include <filesystem>
#include <string>

#include "common/error.h"

namespace planbench {

/// Where this process's program is; planbench's other programs are beside it.
inline std::filesystem::path ProgramFolder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

/// One of planbench's other programs. Throws InputError if it has not been built.
inline std::filesystem::path SiblingProgram(const std::string& name) {
  const std::filesystem::path program = ProgramFolder() / name;
  if (!std::filesystem::exists(program)) {
    throw InputError("the program " + program.string() + " is missing; build all of planbench");
  }
  return program;
}

}  // namespace planbench
