#include "benchmark_driver/session_folder.h"

#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

TEST(EventLogOfTest, IsTheOnlyLogOfTheFolder) {
  const TemporaryFolder folder;
  folder.Write("results.sqlite", "");
  folder.Write("logs/other.lcmlog", "");
  const std::filesystem::path log = folder.Write("session.lcmlog", "");
  EXPECT_EQ(EventLogOf(folder.path()), log);
}

TEST(EventLogOfTest, MissingFolderLogOrChoiceIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  ExpectInputError([&] { EventLogOf(path + "/missing"); }, {"--resume", path + "/missing"});
  ExpectInputError([&] { EventLogOf(path); }, {"--resume", path, "no .lcmlog"});
  folder.Write("a.lcmlog", "");
  folder.Write("b.lcmlog", "");
  ExpectInputError([&] { EventLogOf(path); }, {"--resume", path, "several"});
}

}  // namespace
}  // namespace planbench
