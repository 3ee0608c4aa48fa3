#include "common/yaml_text.h"

#include <gtest/gtest.h>

#include "common/yaml.h"

namespace planbench {
namespace {

TEST(YamlText, IsPlainForNamesAndReadsBackAsItWas) {
  EXPECT_EQ(YamlText("left_arm.link/2"), "left_arm.link/2");
  for (const std::string text :
       {"yes", "Null", "", "a b", "1e3", "- x", "q\"uote\\", "line\n2", "#"}) {
    EXPECT_EQ(YamlText(text).front(), '"') << text;
    EXPECT_EQ(YamlNode::Parse("key: " + YamlText(text), "test").At("key").String(), text);
  }
}

TEST(YamlText, ControlCharactersAreEscaped) {
  EXPECT_EQ(YamlText("a\x1b\x7f"), "\"a\\x1b\\x7f\"");
  EXPECT_EQ(YamlText("\xc2\x9b\xe2\x80\xae\xc3\xa9"), "\"\\x9b\\u202e\xc3\xa9\"");
}

TEST(YamlNumber, ReadsBackAsTheSameDouble) {
  EXPECT_EQ(YamlNumber(-0.0), "0");
  for (const double value : {0.1, 1.0 / 3, -2.5e-17, 1e300}) {
    EXPECT_EQ(YamlNode::Parse("key: " + YamlNumber(value), "test").At("key").Double(), value);
  }
}

}  // namespace
}  // namespace planbench
