#include "common/enum_names.h"

#include <gmock/gmock.h>

namespace planbench {

namespace {
enum class Colour { kRed, kLightGreen, kBlue };
enum class Side { kLeft, kRight };
}  // namespace

template <>
struct EnumNames<Colour> {
  static constexpr auto kNames = std::to_array<std::string_view>({"red", "light green", "blue"});
};
template <>
struct EnumNames<Side> {
  static constexpr auto kNames = std::to_array<std::string_view>({"left", "right"});
};

namespace {

TEST(EnumNamesTest, NamesReadBack) {
  EXPECT_EQ(EnumName(Colour::kLightGreen), "light green");
  EXPECT_EQ(kNumEnumValues<Colour>, 3);
  EXPECT_THAT(EnumValues<Colour>(),
              testing::ElementsAre(Colour::kRed, Colour::kLightGreen, Colour::kBlue));
  for (const Colour colour : EnumValues<Colour>()) {
    EXPECT_EQ(ParseEnum<Colour>(EnumName(colour)), colour);
  }
}

TEST(EnumNamesTest, OtherNamesAreNone) {
  for (const std::string_view name : {"", "re", "red ", "Red", "green"}) {
    EXPECT_EQ(ParseEnum<Colour>(name), std::nullopt) << name;
  }
}

TEST(EnumNamesTest, OtherValuesHaveNoName) {
  EXPECT_THROW(EnumName(static_cast<Colour>(3)), std::out_of_range);
  EXPECT_THROW(EnumName(static_cast<Colour>(-1)), std::out_of_range);
}

TEST(EnumNamesTest, ChoicesReadAsASentence) {
  EXPECT_EQ(EnumChoices<Colour>(), "red, light green or blue");
  EXPECT_EQ(EnumChoices<Side>(), "left or right");
}

}  // namespace
}  // namespace planbench
