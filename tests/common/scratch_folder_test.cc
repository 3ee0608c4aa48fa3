#include "common/scratch_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

TEST(ScratchFolderTest, IsNewAndGoesWithAllItHolds) {
  const TemporaryFolder temporary;
  std::filesystem::path path;
  {
    const ScratchFolder one(temporary / "deep/in/it-");
    const ScratchFolder other(temporary / "deep/in/it-");
    path = one.path();
    EXPECT_NE(path, other.path());
    EXPECT_TRUE(path.filename().string().starts_with("it-")) << path;
    std::filesystem::create_directories(path / "a/b");
  }
  EXPECT_TRUE(std::filesystem::exists(temporary / "deep/in"));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ScratchFolderTest, OneThatCannotBeMadeIsNamed) {
  const TemporaryFolder temporary;
  temporary.Write("file", "");
  ExpectInputError([&] { ScratchFolder(temporary / "file/it-"); }, {"file/it-", "ot a directory"});
}

TEST(ScratchFolderTest, TheFolderForTemporaryFilesIsNamedIfItIsMissing) {
  const TemporaryFolder temporary;
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  setenv("TMPDIR", temporary.path().c_str(), 1);
  EXPECT_EQ(TemporaryFiles(), temporary.path());
  setenv("TMPDIR", (temporary / "nowhere").c_str(), 1);
  ExpectInputError([] { TemporaryFiles(); }, {"TMPDIR", (temporary / "nowhere").string()});
  setenv("TMPDIR", "", 1);
  EXPECT_EQ(TemporaryFiles(), "/tmp");
  before == nullptr ? unsetenv("TMPDIR") : setenv("TMPDIR", kept.c_str(), 1);
}

}  // namespace
}  // namespace planbench
