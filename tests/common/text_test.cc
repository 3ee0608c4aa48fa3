#include "common/text.h"

#include <gtest/gtest.h>

#include <array>

#include "common/error.h"

namespace planbench {
namespace {

TEST(Text, FindsWhatIsNoUtf8) {
  for (const char* good : {"", "abc", "caf\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\xa4\x96",
                           "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_FALSE(FindInvalidUtf8(good)) << good;
  }
  // Alone, cut off, overlong, surrogates, beyond the last character.
  for (const char* bad :
       {"ab\xe9", "ab\x80", "ab\xc3", "ab\xe2\x82", "ab\xc0\xaf", "ab\xe0\x80\x80",
        "ab\xed\xa0\x80", "ab\xf4\x90\x80\x80", "ab\xf5\x80\x80\x80", "ab\xff"}) {
    EXPECT_EQ(FindInvalidUtf8(bad), 2u);
  }
}

TEST(Text, PrintableIsOneLine) {
  EXPECT_EQ(Printable("caf\xc3\xa9 1"), "caf\xc3\xa9 1");
  EXPECT_EQ(Printable("a\nb\tc\x1b[31m\xe9"), "a\\nb\\tc\\x1b[31m\\xe9");
  EXPECT_EQ(Printable("a " + std::string(40000, 'f') + " b"),
            "a " + std::string(60, 'f') + "...(40000 bytes) b");
  std::string long_text;
  for (int i = 0; i < 1000; ++i) long_text += "word ";
  EXPECT_EQ(Printable(long_text).size(), 1003u);
  EXPECT_FALSE(FindInvalidUtf8(Printable(std::string(59, 'a') + std::string(300, '\xc3') +
                                         "\xc3\xa9" + std::string(2000, 'b'))));
  EXPECT_STREQ(InputError("a\nb").what(), "a\\nb");
}

TEST(Text, ControlCharactersAreUnicodesToo) {
  // Ends of lines and turns of direction, first and last of each range; then their neighbours.
  for (const std::string control :
       {"\x1f", "\x7f", "\xc2\x80", "\xc2\x9f", "\xd8\x9c", "\xe2\x80\x8e", "\xe2\x80\x8f",
        "\xe2\x80\xa8", "\xe2\x80\xae", "\xe2\x81\xa6", "\xe2\x81\xa9"}) {
    EXPECT_EQ(ControlLength(control + "a"), control.size());
    EXPECT_TRUE(HasControl("a" + control));
    EXPECT_EQ(Printable(control).size(), 4 * control.size());
  }
  for (const char* other : {"", " ", "~", "\xc2\xa0", "\xd8\x9b", "\xe2\x80\x8d", "\xe2\x80\x90",
                            "\xe2\x80\xa7", "\xe2\x80\xaf", "\xe2\x81\xa5", "\xe2\x81\xaa"}) {
    EXPECT_EQ(ControlLength(other), 0u);
    EXPECT_EQ(Printable(other), other);
  }
  EXPECT_FALSE(HasControl("a\nb\t", "\n\t"));
  EXPECT_TRUE(HasControl("a\nb\r", "\n\t"));
}

TEST(Text, AbridgedSaysHowMuchIsLeftOut) {
  EXPECT_EQ(Abridged(std::string(100, 'a'), 100), std::string(100, 'a'));
  EXPECT_EQ(Abridged(std::string(101, 'a'), 100), std::string(60, 'a') + "...(41 bytes more)");
  EXPECT_EQ(Abridged(std::string(59, 'a') + "\xc3\xa9" + std::string(60, 'b'), 100),
            std::string(59, 'a') + "...(62 bytes more)");
}

TEST(Text, NamesThatMessagesCannotCarry) {
  for (const char* good : {"", "a b", "caf\xc3\xa9", "-x%s"})
    EXPECT_FALSE(FindNameFault(good)) << good;
  EXPECT_EQ(FindNameFault("caf\xe9"), "is no UTF-8 text");
  for (const char* bad : {"a\tb", "a\nb", "\x7f", "a\x1b",
                          "mi\xe2\x80\xae"
                          "en",
                          "a\xe2\x80\xa8"
                          "b"}) {
    EXPECT_EQ(FindNameFault(bad), "must be one line without tabs and other control characters");
  }
}

TEST(Text, NearestName) {
  constexpr std::array<std::string_view, 4> kKnown = {"collision_objects", "octomap", "pose",
                                                      "primitive_poses"};
  EXPECT_EQ(NearestName("colision_objects", kKnown), "collision_objects");
  EXPECT_EQ(NearestName("CollisionObjects", kKnown), "collision_objects");
  EXPECT_EQ(NearestName("primitive_pose", kKnown), "primitive_poses");
  EXPECT_EQ(NearestName("psoe", kKnown), "pose");
  EXPECT_EQ(NearestName("collision", kKnown), "collision_objects");
  EXPECT_EQ(NearestName("octomap_data", kKnown), "octomap");
  EXPECT_EQ(NearestName("mesh", kKnown), "");
  EXPECT_EQ(NearestName("", kKnown), "");
}

}  // namespace
}  // namespace planbench
