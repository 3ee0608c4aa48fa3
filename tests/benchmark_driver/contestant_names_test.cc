#include "benchmark_driver/contestant_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::Pair;

/// Of a line-up that names those of `own` itself, in a session that called its own as `given`.
std::map<std::string, std::string> NamesOf(const std::map<std::string, std::string>& algorithms,
                                           const std::map<std::string, std::string>& own = {},
                                           const std::map<std::string, std::string>& given = {}) {
  std::vector<LineUpEntry> line_up;
  std::map<std::string, NodeStatusMessage> planners;
  for (const auto& [planner, algorithm] : algorithms) {
    planners[planner].name = planner;
    planners[planner].algorithm = algorithm;
    line_up.emplace_back().contestant.planner = planner;
    const auto named = own.find(planner);
    if (named != own.end()) line_up.back().contestant.name = named->second;
  }
  return ContestantNames(line_up, planners, given);
}

TEST(ContestantNamesTest, OneThatCallsItsAlgorithmNothingHasItsNameOnTheBus) {
  EXPECT_THAT(NamesOf({{"a", ""}, {"b", "  "}, {"c", "RRT"}}),
              ElementsAre(Pair("a", "a"), Pair("b", "b"), Pair("c", "RRT")));
}

TEST(ContestantNamesTest, NamesThatLookAlikeAreToldApart) {
  EXPECT_THAT(NamesOf({{"a", "My  RRT "}, {"b", " My RRT"}}),
              ElementsAre(Pair("a", "My RRT [a]"), Pair("b", "My RRT [b]")));
  EXPECT_THAT(NamesOf({{"a", ""}, {"b", "a"}}),
              ElementsAre(Pair("a", "a [a]"), Pair("b", "a [b]")));
}

TEST(ContestantNamesTest, WhatTellsNamesApartMakesNoneThatIsAnothers) {
  EXPECT_THAT(NamesOf({{"a", "X"}, {"b", "X"}, {"c", "X [b]"}}),
              ElementsAre(Pair("a", "X [a]"), Pair("b", "X [b] [b]"), Pair("c", "X [b]")));
  EXPECT_THAT(NamesOf({{"a", "X"}, {"b", "X"}, {"c", "Y"}}, {{"c", "X [a]"}}),
              ElementsAre(Pair("a", "X [a] [a]"), Pair("b", "X [b]"), Pair("c", "X [a]")));
}

TEST(ContestantNamesTest, WhoHasOneInTheSessionKeepsItWhoeverElseTakesPart) {
  EXPECT_THAT(NamesOf({{"a", "X"}}, {}, {{"a", "X [a]"}, {"b", "X [b]"}}),
              ElementsAre(Pair("a", "X [a]"), Pair("b", "X [b]")));
  EXPECT_THAT(NamesOf({{"a", "X"}, {"b", "X"}}, {}, {{"b", "X"}}),
              ElementsAre(Pair("a", "X [a]"), Pair("b", "X")));
  EXPECT_THAT(NamesOf({{"a", "X"}}, {}, {{"b", "X"}}),
              ElementsAre(Pair("a", "X [a]"), Pair("b", "X")));
  EXPECT_THAT(NamesOf({{"a", "X"}}, {{"a", "Mine"}}, {{"a", "X"}}), ElementsAre(Pair("a", "Mine")));
}

TEST(ContestantNamesTest, OfASessionTheFirstCount) {
  std::vector<SessionMessage> earlier(2);
  earlier[0].conditions.contestants.resize(1);
  earlier[0].conditions.contestants[0].planner = "a";
  earlier[0].conditions.contestants[0].name = "X";
  earlier[1] = earlier[0];
  earlier[1].conditions.contestants.resize(2);
  earlier[1].conditions.contestants[0].name = "Y";
  earlier[1].conditions.contestants[1].planner = "b";
  earlier[1].conditions.contestants[1].name = "Z";
  EXPECT_THAT(NamesGiven(earlier), ElementsAre(Pair("a", "X"), Pair("b", "Z")));
}

TEST(ContestantNamesTest, AVeryLongOneIsCut) {
  const std::map<std::string, std::string> names =
      NamesOf({{"a", std::string(1000, 'x')}, {"b", std::string(1000, 'x')}});
  EXPECT_EQ(names.at("a"), std::string(40, 'x') + "...(960 bytes more) [a]");
  EXPECT_EQ(names.at("b"), std::string(40, 'x') + "...(960 bytes more) [b]");
}

}  // namespace
}  // namespace planbench
