#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "common/error.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/mutator.h"
#include "tests/support/trials.h"

namespace planbench {
namespace {

/// No reader needs more; one that asks for more gets std::bad_alloc, which is no answer. Not under
/// sanitizers, which take terabytes of addresses.
constexpr rlim_t kMaxAddressSpace = rlim_t{4} << 30;

/// Where the input that is being read lies, should it end the process.
std::string CurrentFile(const FuzzTarget& target) {
  return fmt::format("{}planbench_fuzz_{}", testing::TempDir(), target.name);
}

class Fuzz : public testing::TestWithParam<FuzzTarget> {
 protected:
  static void SetUpTestSuite() {
    if (kSlowBuild) return;
    const rlimit limit{kMaxAddressSpace, kMaxAddressSpace};
    ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
  }

  /// False after the first input that does harm.
  static bool Read(const FuzzTarget& target, const Bytes& input) {
    std::filesystem::remove(CurrentFile(target));  // Overwriting would wait for the disk.
    std::ofstream(CurrentFile(target), std::ios::binary)
        .write(reinterpret_cast<const char*>(input.data()),
               static_cast<std::streamsize>(input.size()));
    try {
      target.read(input);
    } catch (const InputError&) {
    } catch (const std::exception& error) {
      ADD_FAILURE() << target.name << ": threw '" << error.what() << "' at what "
                    << CurrentFile(target) << " holds";
      return false;
    }
    return true;
  }
};

TEST_P(Fuzz, SeedsAreReadOrRefused) {
  for (const Bytes& seed : GetParam().seeds) Read(GetParam(), seed);
}

// PLANBENCH_FUZZ_INPUTS and PLANBENCH_FUZZ_SEED make it a longer one.
TEST_P(Fuzz, ChangedInputsAreReadOrRefused) {
  const FuzzTarget& target = GetParam();
  const char* inputs = std::getenv("PLANBENCH_FUZZ_INPUTS");
  const char* seed = std::getenv("PLANBENCH_FUZZ_SEED");
  const long num = inputs != nullptr ? std::atol(inputs) : Trials(target.num_inputs);
  std::mt19937_64 random(seed != nullptr ? std::strtoull(seed, nullptr, 10) : 1);
  for (long i = 0; i < num; ++i) {
    if (!Read(target, Mutated(target.seeds, &random))) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Fuzz, testing::ValuesIn(FuzzTargets()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace planbench
