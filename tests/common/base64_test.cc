#include "common/base64.h"

#include <gtest/gtest.h>

namespace planbench {
namespace {

TEST(EncodeBase64, IsFilledUpToFourCharacters) {
  EXPECT_EQ(EncodeBase64({}), "");
  EXPECT_EQ(EncodeBase64({'f'}), "Zg==");
  EXPECT_EQ(EncodeBase64({'f', 'o'}), "Zm8=");
  EXPECT_EQ(EncodeBase64({'f', 'o', 'o'}), "Zm9v");
  EXPECT_EQ(EncodeBase64({0xfb, 0xff, 0x00, 0x80}), "+/8AgA==");
}

}  // namespace
}  // namespace planbench
