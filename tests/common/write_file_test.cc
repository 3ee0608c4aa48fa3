#include "common/write_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <iterator>
#include <string>

#include "common/read_text.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

TEST(WriteFileTest, WhatCannotBeWrittenWhollyLeavesTheFileAsItWas) {
  const TemporaryFolder folder;
  const fs::path page = folder.Write("page.html", "the page before");
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit full = before;
  full.rlim_cur = 100'000;  // as a disk that has room for so much
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  for (const fs::path& file : {page, folder / "new.html"}) {
    ExpectInputError([&] { WriteFile(file, std::string(200'000, 'x')); },
                     {"cannot write " + file.string() + ": File too large"});
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(ReadText(page), "the page before");
  const auto num_files = std::distance(fs::directory_iterator(folder.path()), {});
  EXPECT_EQ(num_files, 1) << "nothing beside it";
}

TEST(WriteFileTest, ReplacesTheFileAndNotALinkToIt) {
  const TemporaryFolder folder;
  const fs::path file = folder.Write("file", "longer than what comes");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("file", folder / "link");
  WriteFile(folder / "link", "text");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(ReadText(file), "text");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  WriteFile(folder / "new", "new");
  EXPECT_EQ(ReadText(folder / "new"), "new");
}

TEST(WriteFileTest, WhatIsNoFileIsWrittenToAsItIs) {
  const TemporaryFolder folder;
  fs::create_symlink("/dev/full", folder / "full");
  ExpectInputError([&] { WriteFile(folder / "full", "text"); }, {"full: No space left on device"});
  EXPECT_TRUE(fs::is_character_file(folder / "full"));
  ExpectInputError([&] { WriteFile(folder.path(), "text"); }, {"Is a directory"});
  ExpectInputError([&] { WriteFile(folder / "none/file", "text"); }, {"none/file: No such file"});
}

}  // namespace
}  // namespace planbench
