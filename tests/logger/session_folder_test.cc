#include "logger/session_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/error.h"
#include "session_files.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(SessionFolder, CreatesTheFolderAndNamesItsFiles) {
  const TemporaryFolder temporary;
  for (const char* spelling : {"a/deep/session", "a/deep/other/"}) {
    const SessionFolder folder(temporary / spelling, false);
    EXPECT_TRUE(std::filesystem::is_directory(temporary / spelling));
    EXPECT_TRUE(folder.path().is_absolute());
    EXPECT_EQ(folder.event_log().stem(), folder.path().filename());
    EXPECT_EQ(folder.event_log().extension(), ".lcmlog");
    EXPECT_EQ(folder.results().filename(), "results.sqlite");
    EXPECT_EQ(folder.run_json().filename(), "run.json");
  }
}

TEST(SessionFolder, GoesOnWithTheLogOfAFolderThatWasRenamed) {
  const TemporaryFolder temporary;
  temporary.Write("old/old.lcmlog", "");
  std::filesystem::rename(temporary / "old", temporary / "new");
  EXPECT_EQ(SessionFolder(temporary / "new", true).event_log(), temporary / "new" / "old.lcmlog");
}

TEST(SessionFolder, HoldsTheMessageTypes) {
  const TemporaryFolder temporary;
  const SessionFolder folder(temporary / "s", false);
  int count = 0;
  const auto sources = std::filesystem::path(PLANBENCH_SOURCE_DIR) / "lcmtypes";
  for (const auto& entry : std::filesystem::directory_iterator(sources)) {
    if (entry.path().extension() != ".lcm") continue;
    EXPECT_EQ(TextOf(folder.path() / "lcmtypes" / entry.path().filename()), TextOf(entry.path()))
        << entry.path();
    ++count;
  }
  EXPECT_GT(count, 10);
}

TEST(SessionFolder, IsLockedForOthers) {
  const TemporaryFolder temporary;
  {
    const SessionFolder folder(temporary / "s", false);
    for (const bool resume : {false, true}) {
      EXPECT_THAT([&] { SessionFolder(temporary / "s", resume); },
                  ThrowsMessage<InputError>(AllOf(HasSubstr((temporary / "s").string()),
                                                  HasSubstr("pid " + std::to_string(getpid())))));
    }
  }
  EXPECT_NO_THROW(SessionFolder(temporary / "s", true));
}

TEST(SessionFolder, WithResultsIsOnlyTakenToResume) {
  const TemporaryFolder temporary;
  for (const char* file : {"results.sqlite", "s.lcmlog"}) {
    std::filesystem::create_directories(temporary / "s");
    WriteText(temporary / "s" / file, "x");
    EXPECT_THAT([&] { SessionFolder(temporary / "s", false); },
                ThrowsMessage<InputError>(AllOf(HasSubstr(file), HasSubstr("--resume"),
                                                HasSubstr((temporary / "s").string()))));
    EXPECT_EQ(TextOf(temporary / "s" / file), "x");
    EXPECT_NO_THROW(SessionFolder(temporary / "s", true));
    std::filesystem::remove_all(temporary / "s");
  }
}

TEST(SessionFolder, WhereNoneCanBeIsRefusedByName) {
  const TemporaryFolder temporary;
  WriteText(temporary / "file", "x");
  EXPECT_THAT([&] { SessionFolder(temporary / "file", false); },
              ThrowsMessage<InputError>(HasSubstr((temporary / "file").string())));
  EXPECT_THAT([&] { SessionFolder(temporary / "file/below", false); },
              ThrowsMessage<InputError>(HasSubstr((temporary / "file/below").string())));
  EXPECT_THROW(SessionFolder("/proc/none", false), InputError);
}

}  // namespace
}  // namespace planbench
