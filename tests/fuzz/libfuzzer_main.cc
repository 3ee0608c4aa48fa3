#include <cstdio>
#include <cstdlib>
#include <string>

#include "common/error.h"
#include "tests/fuzz/fuzz_target.h"

// libFuzzer with the target that PLANBENCH_FUZZ_TARGET names.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const planbench::FuzzTarget* target = [] {
    const char* name = std::getenv("PLANBENCH_FUZZ_TARGET");
    for (const planbench::FuzzTarget& one : planbench::FuzzTargets()) {
      if (name != nullptr && one.name == name) return &one;
    }
    std::fprintf(stderr, "PLANBENCH_FUZZ_TARGET must name one of:");
    for (const planbench::FuzzTarget& one : planbench::FuzzTargets()) {
      std::fprintf(stderr, " %s", one.name.c_str());
    }
    std::fprintf(stderr, "\n");
    std::exit(2);
  }();
  try {
    target->read({data, size});
  } catch (const planbench::InputError&) {
  }
  return 0;
}
