#include "common/write_file.h"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/read_text.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

std::ptrdiff_t NumFilesIn(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), {});
}

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
  EXPECT_EQ(NumFilesIn(folder.path()), 1) << "nothing beside it";
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

TEST(WriteFileTest, NoOtherFileIsTouched) {
  const TemporaryFolder folder;
  folder.Write("file.part", "another's");
  WriteFile(folder / "file", "text");
  WriteFile(folder / "file", "text again");
  EXPECT_EQ(ReadText(folder / "file"), "text again");
  EXPECT_EQ(ReadText(folder / "file.part"), "another's");
  EXPECT_EQ(NumFilesIn(folder.path()), 2);
}

TEST(WriteFileTest, NamesMayBeAsLongAsTheyCan) {
  const TemporaryFolder folder;
  const fs::path file = folder / std::string(255, 'x');
  WriteFile(file, "text");
  EXPECT_EQ(ReadText(file), "text");
}

TEST(WriteFileTest, WhereALinkLeadsToNothingTheFileIsMade) {
  const TemporaryFolder folder;
  fs::create_symlink("file", folder / "link");
  WriteFile(folder / "link", "text");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(ReadText(folder / "file"), "text");
}

/// Ends with how many could not be written, and why on stderr.
[[noreturn]] void WriteAndExit(const std::vector<fs::path>& files) {
  int num_failed = 0;
  for (const fs::path& file : files) {
    try {
      WriteFile(file, "text");
    } catch (const InputError& error) {
      std::cerr << error.what();
      ++num_failed;
    }
  }
  std::_Exit(num_failed);
}

TEST(WriteFileTest, RightsAreThoseOfTheFileAndNotOfItsFolder) {
  const TemporaryFolder folder;
  const fs::path file = folder.Write("closed/file", "what was there");
  const fs::path kept = folder.Write("kept", "protected");
  fs::permissions(folder / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  fs::permissions(kept, fs::perms::owner_read);
  const auto write = [&] {
    __user_cap_header_struct header = {_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct none[2] = {};
    syscall(SYS_capset, &header, none);  // root is held to permissions, too
    WriteAndExit({file, kept});
  };
  EXPECT_EXIT(write(), testing::ExitedWithCode(1), "kept: Permission denied");
  fs::permissions(folder / "closed", fs::perms::owner_all);
  EXPECT_EQ(ReadText(file), "text");
  EXPECT_EQ(ReadText(kept), "protected");
}

TEST(WriteFileTest, AFileThatIsMountedByItselfIsWrittenTo) {
  const TemporaryFolder folder;
  const fs::path outside = folder.Write("outside", "what was there");
  const fs::path inside = folder.Write("inside", "");
  constexpr int kNotMounted = 9;
  const auto write = [&] {
    const bool is_mounted = unshare(CLONE_NEWNS) == 0 &&
                            mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                            mount(outside.c_str(), inside.c_str(), nullptr, MS_BIND, nullptr) == 0;
    if (!is_mounted) std::_Exit(kNotMounted);  // needs root
    WriteAndExit({inside});
  };
  const auto is_expected = [](int status) {
    return testing::ExitedWithCode(0)(status) || testing::ExitedWithCode(kNotMounted)(status);
  };
  EXPECT_EXIT(write(), is_expected, "");
  if (ReadText(outside) == "what was there") GTEST_SKIP() << "needs the right to mount";
  EXPECT_EQ(ReadText(outside), "text");
  EXPECT_EQ(NumFilesIn(folder.path()), 2) << "nothing beside them";
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
