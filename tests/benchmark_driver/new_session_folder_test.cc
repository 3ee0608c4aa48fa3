#include "benchmark_driver/new_session_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <optional>

#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

TEST(NewSessionFolderTest, GoesAgainUnlessTheSessionBegins) {
  const TemporaryFolder temporary;
  const auto outer = temporary / "outer";
  {
    const NewSessionFolder folder(outer / "s");
    EXPECT_TRUE(std::filesystem::is_directory(outer / "s" / "logs"));
    temporary.Write("outer/s/s.lcmlog", "x");
  }
  EXPECT_FALSE(std::filesystem::exists(outer));
  {
    NewSessionFolder folder(outer / "s");
    temporary.Write("outer/s/s.lcmlog", "x");
    folder.Keep();
  }
  EXPECT_TRUE(std::filesystem::exists(outer / "s" / "s.lcmlog"));
}

TEST(NewSessionFolderTest, LeavesWhatWasThereBefore) {
  const TemporaryFolder temporary;
  const auto note = temporary.Write("s/note.txt", "x");
  {
    const NewSessionFolder folder(temporary / "s");
    temporary.Write("s/results.sqlite", "x");
    temporary.Write("s/lcmtypes/a.lcm", "x");
  }
  EXPECT_TRUE(std::filesystem::exists(note));
  EXPECT_FALSE(std::filesystem::exists(temporary / "s" / "results.sqlite"));
  EXPECT_FALSE(std::filesystem::exists(temporary / "s" / "lcmtypes"));
}

TEST(NewSessionFolderTest, AnotherSessionsIsRefusedAndLeftAlone) {
  const TemporaryFolder temporary;
  for (const char* name : {"s/results.sqlite", "t/other.lcmlog"}) {
    const auto file = temporary.Write(name, "x");
    ExpectInputError([&] { NewSessionFolder folder(file.parent_path()); },
                     {file.parent_path().string(), file.filename().string(), "--out", "--resume"});
    EXPECT_TRUE(std::filesystem::exists(file));
  }
}

TEST(NewSessionFolderTest, OfTwoDriversOneGetsItAndTheOtherLeavesItAlone) {
  const TemporaryFolder temporary;
  const auto s = temporary / "outer" / "s";
  std::optional<NewSessionFolder> first(s);
  const auto log = temporary.Write("outer/s/logs/logger.log", "x");
  ExpectInputError([&] { NewSessionFolder second(s); }, {s.string(), "logs", "--out", "--resume"});
  EXPECT_TRUE(std::filesystem::exists(log));
  first.reset();
  EXPECT_FALSE(std::filesystem::exists(temporary / "outer"));
  EXPECT_NO_THROW(NewSessionFolder second(s));
}

TEST(NewSessionFolderTest, ParentsStayForTheSessionsOfOthers) {
  const TemporaryFolder temporary;
  const auto outer = temporary / "outer";
  std::optional<NewSessionFolder> failing(outer / "inner" / "a");
  NewSessionFolder other(outer / "b");
  const auto log = temporary.Write("outer/b/b.lcmlog", "x");
  other.Keep();
  failing.reset();
  EXPECT_FALSE(std::filesystem::exists(outer / "inner"));
  EXPECT_TRUE(std::filesystem::exists(log));
}

TEST(NewSessionFolderTest, StaysWhileALoggerWritesToIt) {
  const TemporaryFolder temporary;
  std::optional<NewSessionFolder> folder(temporary / "s");
  const auto results = temporary.Write("s/results.sqlite", "x");
  const int lock = open(temporary.Write("s/logger.lock", "4711").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
  folder.reset();
  EXPECT_TRUE(std::filesystem::exists(results));
  close(lock);
}

TEST(NewSessionFolderTest, WhereNoneCanBeIsTheCause) {
  const TemporaryFolder temporary;
  temporary.Write("file", "x");
  ExpectInputError([&] { NewSessionFolder folder(temporary / "file"); },
                   {(temporary / "file").string(), "Not a directory"});
  ExpectInputError([] { NewSessionFolder folder("/proc/none/s"); }, {"/proc/none/s"});
}

}  // namespace
}  // namespace planbench
