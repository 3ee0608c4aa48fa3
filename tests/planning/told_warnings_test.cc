#include "planning/told_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ToldWarningsTest, AreToldInOrderEachOnce) {
  std::map<std::string, std::string> settings = {{"robot", "arm"}};
  TellWarnings(kRobotWarning, {"z", "a"}, &settings);
  TellWarnings(kRobotWarning, {"a", "m"}, &settings);
  EXPECT_THAT(ToldWarnings(kRobotWarning, settings), ElementsAre("z", "a", "m"));
  EXPECT_THAT(ToldWarnings(kProblemWarning, settings), IsEmpty());
  EXPECT_EQ(settings.at("robot warning 02"), "a");
}

TEST(ToldWarningsTest, OfManyTheLastSaysThatThereAreMore) {
  std::map<std::string, std::string> settings;
  for (std::size_t i = 1; i <= 50; ++i) {
    TellWarnings(kProblemWarning, {std::to_string(i)}, &settings);
    const auto told = ToldWarnings(kProblemWarning, settings);
    EXPECT_EQ(told.size(), std::min<std::size_t>(i, 41));
    EXPECT_EQ(told.back(),
              i <= 40 ? std::to_string(i) : "there are more warnings; see the scene server's log");
  }
}

}  // namespace
}  // namespace planbench
