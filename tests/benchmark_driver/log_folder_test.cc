#include "benchmark_driver/log_folder.h"

#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

TEST(LogFolderTest, IsMadeOnce) {
  const TemporaryFolder temporary;
  const auto session = temporary / "session";
  EXPECT_TRUE(MakeLogFolder(session));
  EXPECT_FALSE(MakeLogFolder(session));
  RequireWritableLogs(session);
  EXPECT_TRUE(std::filesystem::is_empty(session / "logs"));
}

TEST(LogFolderTest, WhereItCannotBeMadeOrWrittenIsTheCause) {
  const TemporaryFolder temporary;
  temporary.Write("session/logs", "a file");
  ExpectInputError([&] { MakeLogFolder(temporary / "session"); },
                   {(temporary / "session").string(), "Not a directory"});
  ExpectInputError([&] { RequireWritableLogs(temporary / "session"); },
                   {(temporary / "session").string(), "cannot be written"});
}

}  // namespace
}  // namespace planbench
