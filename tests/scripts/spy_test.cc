#include <gmock/gmock.h>

#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

// Bad use, found before anything is installed or built.
TEST(Spy, RefusesBadUseInOneLine) {
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } cases[] = {
      {{"--player"}, "spy: --player: one event log is needed"},
      {{"--player", "nowhere.lcmlog"}, "nowhere.lcmlog: there is no such file"},
      {{"a.lcmlog"}, "lcm-spy takes no file; --player plays one"},
      {{"--lcm-url"}, "--lcm-url: which?"},
      {{"--nonsense"}, "Usage: ./spy"},
  };
  for (const auto& [arguments, message] : cases) {
    TemporaryFolder folder;
    std::vector<std::string> command = {PLANBENCH_SOURCE_DIR "/spy"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    ChildProcess spy(command, folder.path() / "spy");
    EXPECT_EQ(spy.Wait(), 2);
    EXPECT_THAT(spy.Errors(), testing::HasSubstr(message));
    EXPECT_EQ(spy.Output(), "");
  }
}

}  // namespace
}  // namespace planbench
