#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>

namespace planbench {

/// What make_problems is told on its command line.
struct GeneratorFlags {
  std::filesystem::path spec;
  std::filesystem::path robot;
  std::filesystem::path out;
  int count = 100;
  std::uint64_t seed = 1;
  bool replace = false;
  int threads = 0;  ///< 0: as many as the machine has.
  bool certify = false;
  double certify_time_s = 60;  ///< Of each attempt of each planner.
  int certify_rounds = 5;

  void AddTo(CLI::App* app);
};

/// Makes and writes a problem set, says what was made and what rejected on stdout. Returns the exit
/// code; throws InputError.
int RunGenerator(const GeneratorFlags& flags);

}  // namespace planbench
