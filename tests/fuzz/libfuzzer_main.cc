// libFuzzer with the target that PLANBENCH_FUZZ_TARGET names and its seeds.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "common/error.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

const FuzzTarget& Target() {
  static const FuzzTarget* target = [] {
    const char* name = std::getenv("PLANBENCH_FUZZ_TARGET");
    for (const FuzzTarget& one : FuzzTargets()) {
      if (name != nullptr && one.name == name) return &one;
    }
    std::fprintf(stderr, "PLANBENCH_FUZZ_TARGET must name one of:");
    for (const FuzzTarget& one : FuzzTargets()) std::fprintf(stderr, " %s", one.name.c_str());
    std::fprintf(stderr, "\n");
    std::exit(2);
  }();
  return *target;
}

}  // namespace
}  // namespace planbench

/// Adds a folder with the seeds to those that the command names.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  using namespace planbench;
  static const TemporaryFolder folder;
  const std::vector<Bytes>& seeds = Target().seeds;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    folder.Write(fmt::format("seed{}", i), std::string(seeds[i].begin(), seeds[i].end()));
  }
  static std::string seed_folder = folder.path().string();
  static std::vector<char*> arguments(*argv, *argv + *argc);
  arguments.push_back(seed_folder.data());
  *argc = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  *argv = arguments.data();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    planbench::Target().read({data, size});
  } catch (const planbench::InputError&) {
  }
  return 0;
}
