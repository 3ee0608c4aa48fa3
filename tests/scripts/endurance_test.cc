#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

TEST(EnduranceTest, TellsWhyThereIsNoSession) {
  const TemporaryFolder folder;
  const fs::path driver = folder.Write(
      "bin/benchmark_driver", "#!/bin/sh\necho begins\necho 'session folder taken' >&2\nexit 2\n");
  fs::permissions(driver, fs::perms::owner_all);
  const std::string bin = folder / "bin", out = folder / "new/out";
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } cases[] = {
      {{bin, out}, "endurance: the driver ended with exit code 2: session folder taken\n"},
      {{bin, out, "many"}, "endurance: REQUESTS: a number is needed, found 'many'\n"},
      {{folder / "new", out},
       fmt::format("endurance: {}: there is no benchmark_driver in it\n",
                   (folder / "new").string())},
  };
  for (const auto& [arguments, message] : cases) {
    std::vector<std::string> command = {PLANBENCH_SOURCE_DIR "/benchmarks/endurance"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    ChildProcess endurance(command, folder / "endurance");
    EXPECT_EQ(endurance.Wait(), 2);
    EXPECT_EQ(endurance.Errors(), message);
  }
}

}  // namespace
}  // namespace planbench
