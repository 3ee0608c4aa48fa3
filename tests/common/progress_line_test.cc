#include "common/progress_line.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What is on stderr after `done` of `total` pieces of work, `earlier` of them done before.
std::string Shown(int total, int earlier, int done, bool pieces_are_alike = true) {
  testing::internal::CaptureStderr();
  {
    ProgressLine line(total, earlier, pieces_are_alike);
    if (done > earlier) line.Show(done, "shelf");
  }
  return testing::internal::GetCapturedStderr();
}

TEST(ProgressLineTest, AClosedTerminalIsNoFailure) {
  const auto show = [] {
    close(STDERR_FILENO);
    ProgressLine(8, 0).Show(4, "shelf");
    _exit(0);
  };
  EXPECT_EXIT(show(), testing::ExitedWithCode(0), "");
}

TEST(ProgressLineTest, ShowsBarCountAndText) {
  EXPECT_THAT(Shown(8, 0, 4),
              HasSubstr("[##########..........] 4/8  0:00 (about 0:00 left)  shelf"));
  EXPECT_THAT(Shown(1, 0, 1), HasSubstr("[####################] 1/1"));
  EXPECT_THAT(Shown(0, 0, 0), HasSubstr("0/0"));
  EXPECT_EQ(Shown(8, 0, 4).back(), '\n');
}

TEST(ProgressLineTest, EstimatesWhatIsLeftByWhatItHasSeen) {
  EXPECT_THAT(Shown(8, 3, 4), HasSubstr("left)"));
  EXPECT_THAT(Shown(8, 4, 4), Not(HasSubstr("left)")));  // nothing seen
  EXPECT_THAT(Shown(8, 4, 8), Not(HasSubstr("left)")));  // nothing left
  EXPECT_THAT(Shown(8, 0, 4, /*pieces_are_alike=*/false), HasSubstr("4/8  0:00  shelf"));
}

TEST(ProgressLineTest, NeverExceedsTheTerminal) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0) GTEST_SKIP() << "no terminals";
  const int terminal = open(ptsname(master), O_RDWR | O_NOCTTY);
  ASSERT_GE(terminal, 0);
  winsize size = {};
  size.ws_col = 60;
  ASSERT_EQ(ioctl(terminal, TIOCSWINSZ, &size), 0);
  const int before = dup(STDERR_FILENO);
  dup2(terminal, STDERR_FILENO);
  {
    ProgressLine line(8);
    std::string text;
    for (int i = 0; i < 40; ++i) text += "\xC3\xB6";
    line.Show(4, text);
  }
  dup2(before, STDERR_FILENO);
  std::string shown(1000, '\0');
  shown.resize(static_cast<std::size_t>(read(master, shown.data(), shown.size())));
  for (const int file : {before, terminal, master}) close(file);
  const std::string begin = "\r\033[K";
  ASSERT_EQ(shown.rfind(begin, 0), 0u) << shown;
  const std::string line = shown.substr(begin.size(), shown.find('\r', 1) - begin.size());
  const auto num_characters =
      std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
  EXPECT_EQ(num_characters, 59);
  EXPECT_THAT(line, testing::EndsWith("\xC3\xB6"));  // no half character
}

}  // namespace
}  // namespace planbench
