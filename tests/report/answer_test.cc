#include "report/answer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/cautions.h"
#include "tests/report/report_fixture.h"

namespace planbench {
namespace {

TEST_F(ReportTest, PathsThatCameTooLateAreNoConfirmedOnes) {
  const TemporaryFolder folder;
  WriteSession(folder / "one", {{.contestant = "A"}, {.contestant = "A", .problem = 2}},
               ExampleSession());
  std::vector<StoredSession> sessions = ReadSessions(folder / "one").sessions;
  sessions[0].runs[1].status = PlanStatus::kTimedOut;
  EXPECT_THAT(
      Answer(ComparedSessions(sessions), {}).at(1),
      testing::HasSubstr("the referee confirmed the one path claimed in time, and 1 more came "
                         "after the time limit"));
  sessions[0].runs[0].status = PlanStatus::kInvalidPath;
  EXPECT_THAT(Answer(ComparedSessions(sessions), {}).at(0),
              testing::HasSubstr("the referee rejected the one path claimed in time, and 1 more"));
  sessions[0].runs[0].status = PlanStatus::kTimedOut;
  EXPECT_THAT(Answer(ComparedSessions(sessions), {}).at(0),
              testing::HasSubstr("; 2 paths came, after the time limit."));
}

TEST_F(ReportTest, TimesThatAreNotAccountedForAreToldOfWhoRanksFirst) {
  // Round trips are half a second longer than planning, of which simplification tells a half.
  const TemporaryFolder folder;
  std::vector<MadeRun> runs;
  for (int problem = 1; problem <= 7; ++problem) {
    runs.push_back({.contestant = "A", .problem = problem, .time_s = 0.001});
    runs.push_back({.contestant = "B", .problem = problem, .time_s = 0.1});
  }
  WriteSession(folder / "example", runs, ExampleSession());
  std::vector<StoredSession> sessions = ReadSessions(folder / "example").sessions;
  for (StoredRun& run : sessions[0].runs) {
    run.phases.simplification_s = 0;
    const bool honest = sessions[0].contestants[run.contestant].name == "B";
    run.roundtrip_time_s = honest ? 0.101 : 0.301;
  }
  const std::string doubt =
      "A: its answers tell of 1 ms, and 300 ms more passed until they came (others: 1 ms): its "
      "times may be too short. Medians over the confirmed runs, without waiting for a processor.";
  const ComparedSessions compared(sessions);
  const std::vector<std::string> answer = Answer(compared, ComparePairs(compared));
  EXPECT_THAT(answer.at(0), testing::HasSubstr("A ranks first"));
  EXPECT_EQ(answer.at(1), doubt);
  EXPECT_THAT(Cautions(compared), testing::Contains(doubt));
  for (StoredRun& run : sessions[0].runs) run.waiting_s = 0.3;
  EXPECT_EQ(Cautions(ComparedSessions(sessions)).size(), 1u) << "it waited for a processor";
}

TEST_F(ReportTest, TheAnswerIsThreeSentencesWithTheirUncertainty) {
  const std::vector<std::string> answer = Answer(compared_, pairs_);
  ASSERT_EQ(answer.size(), 3u);
  EXPECT_EQ(answer[0],
            fmt::format("Of 2 contestants {} ranks first by penalised mean time: it solved "
                        "100.0 % of the problems (95 % interval 82.4 to 100.0), in a median "
                        "of 1500 ms (1300 to 1800), over 18 problems of 2 sets.",
                        kTagName));
  EXPECT_TRUE(
      answer[1].starts_with(fmt::format("The next, {}, solved 83.3 % of the", kScriptName)));
  EXPECT_THAT(answer[1], testing::HasSubstr("on the 15 problems that both solved in the median"));
  EXPECT_NE(answer[2].find("ranks first in 2 of the 2 sets; the referee rejected 1 of 46 paths"),
            std::string::npos)
      << answer[2];
}

TEST_F(ReportTest, TheNextIsMarkedLikeTheFirst) {
  const std::map<std::string, std::string> settings = {{"learned_from", "shelf"}};
  const ComparedSessions compared =
      Read({{.contestant = "A"}, {.contestant = "B", .time_s = 2, .settings = settings}});
  const std::vector<std::string> answer = Answer(compared, ComparePairs(compared));
  ASSERT_EQ(answer.size(), 4u);
  EXPECT_THAT(answer[0], testing::HasSubstr("contestants A ranks first"));
  EXPECT_THAT(answer[1], testing::HasSubstr("The next, B (trained), solved"));
  EXPECT_THAT(answer[2], testing::StartsWith("B has learned from shelf"));
  EXPECT_THAT(answer[3], testing::HasSubstr("faster than B (trained)"));
}

TEST_F(ReportTest, TheAnswerKnowsWhenThereIsNone) {
  EXPECT_EQ(Answer(ComparedSessions({}), {}), std::vector<std::string>{"No runs are recorded."});
  StoredSession empty;
  empty.file = "example/results.sqlite";
  empty.num_runs = 36;
  EXPECT_EQ(Answer(ComparedSessions({empty}), {}),
            std::vector<std::string>{"No runs are recorded: 36 of 36 are missing."});
  const ComparedSessions alone = Read({{.contestant = "A"}});
  EXPECT_EQ(Answer(alone, {}).at(1),
            "There is nothing to compare it with; the referee confirmed the one path claimed.");
  const ComparedSessions apart =
      Read({{.contestant = "A"}, {.contestant = "B", .set = "table", .time_s = 2}});
  EXPECT_EQ(Answer(apart, ComparePairs(apart)),
            (std::vector<std::string>{
                "None of 2 contestants ranks first: there is no problem that all of them tried.",
                "Nobody tried a problem that another tried; the referee confirmed every one of 2 "
                "paths."}));
  EXPECT_EQ(Cautions(apart).front(),
            "The contestants tried different problems (A 1, B 1): none that all of them tried, so "
            "that none ranks first.");
  const ComparedSessions failed = Read({{.contestant = "A", .status = PlanStatus::kTimedOut},
                                        {.contestant = "B", .status = PlanStatus::kTimedOut}});
  EXPECT_EQ(Answer(failed, {}).at(0),
            "None of 2 contestants solved a problem; no path was claimed to the referee.");
}

TEST_F(ReportTest, TooFewProblemsAreNoSignOfEquality) {
  const auto answer_of = [](int num_problems, const std::vector<std::string>& contestants) {
    std::vector<MadeRun> runs;
    for (int problem = 1; problem <= num_problems; ++problem) {
      double time_s = 1;
      for (const std::string& name : contestants) {
        runs.push_back({.contestant = name, .problem = problem, .time_s = time_s});
        time_s *= 1.5;
      }
    }
    const ComparedSessions compared = Read(runs);
    return Answer(compared, ComparePairs(compared)).at(2);
  };
  using testing::StartsWith;
  EXPECT_THAT(
      answer_of(1, {"A", "B"}),
      StartsWith("With 1 problem it cannot be tested whether A is faster than B: 6 would do; "));
  EXPECT_THAT(answer_of(6, {"A", "B"}), StartsWith("Problem by problem A is faster than B"));
  // Of three pairs.
  EXPECT_THAT(answer_of(6, {"A", "B", "C"}),
              StartsWith("Too few problems to test whether A is faster than any of the 2 others: "
                         "7 would do"));
  EXPECT_THAT(answer_of(7, {"A", "B", "C"}),
              StartsWith("Problem by problem A is faster than each of the 2 others"));
}

TEST_F(ReportTest, WhatProcessesMayMakeIsNoProofOfAFasterPlanner) {
  const auto compared_of = [](double ratio) {
    std::vector<MadeRun> runs;
    for (int problem = 1; problem <= 8; ++problem) {
      runs.push_back({.contestant = "A", .problem = problem});
      runs.push_back({.contestant = "B", .problem = problem, .time_s = ratio});
    }
    return Read(runs);
  };
  const std::string near =
      "A is faster than B beyond chance (signed-rank test, 5 % level); B is within 5 % of it, "
      "which may be of the processes";
  for (const bool is_near : {true, false}) {
    const ComparedSessions compared = compared_of(is_near ? 1.04 : 1.06);
    const std::vector<ComparedPair> pairs = ComparePairs(compared);
    const auto is_told = [is_near](const std::string& text, const std::string& what) {
      EXPECT_EQ(text.find(what) != std::string::npos, is_near) << text;
    };
    is_told(Answer(compared, pairs).at(2), near);
    is_told(PairTable(pairs).note, "Ratios within 5 % of 1");
  }
}

TEST_F(ReportTest, EqualsAreToldToRankAlike) {
  // Times of A, B, C and so on, in s.
  const auto answer_of = [](const std::vector<double>& times_s) {
    std::vector<MadeRun> runs;
    for (int problem = 1; problem <= 10; ++problem) {
      for (std::size_t i = 0; i < times_s.size(); ++i) {
        runs.push_back({.contestant = std::string(1, static_cast<char>('A' + i)),
                        .problem = problem,
                        .time_s = times_s[i]});
      }
    }
    const ComparedSessions compared = Read(runs);
    return Answer(compared, ComparePairs(compared));
  };
  using testing::StartsWith;
  const std::vector<std::string> both = answer_of({1, 1});
  EXPECT_THAT(both.at(0), StartsWith("Of 2 contestants A and B rank alike by penalised mean time: "
                                     "A solved 100.0 %"));
  EXPECT_THAT(both.at(1), StartsWith("B solved 100.0 %"));
  EXPECT_THAT(
      answer_of({1, 2, 1}).at(0),
      StartsWith("Of 3 contestants A and C rank alike, before all others, by penalised mean "
                 "time: A solved"));
  EXPECT_THAT(answer_of({1, 1, 1, 1, 1, 1}).at(0),
              StartsWith("Of 6 contestants A, B, C, D and 2 more rank alike by"));
  const std::vector<std::string> next = answer_of({2, 1, 2});
  EXPECT_THAT(next.at(0), StartsWith("Of 3 contestants B ranks first by penalised mean time: it"));
  EXPECT_THAT(next.at(1), StartsWith("The next, A and C, rank alike: A solved"));
}

TEST_F(ReportTest, SetsInWhichOthersRankAlikeAreCounted) {
  std::vector<MadeRun> runs;
  for (const char* set : {"shelf", "table"}) {
    runs.push_back({.contestant = "A", .set = set});
    runs.push_back({.contestant = "B", .set = set, .time_s = set == runs[0].set ? 1.0 : 2.0});
  }
  const ComparedSessions compared = Read(runs);
  EXPECT_THAT(Answer(compared, ComparePairs(compared)).at(2),
              testing::HasSubstr("; it ranks first in 2 of the 2 sets, in 1 of them with others "
                                 "alike; "));
}

TEST_F(ReportTest, WhoTriedOtherProblemsRanksByTheCommonOnes) {
  std::vector<MadeRun> runs;
  for (int problem = 1; problem <= 7; ++problem) {
    runs.push_back({.contestant = "A", .problem = problem});
    runs.push_back({.contestant = "B", .problem = problem, .time_s = 2});
  }
  // What B alone tried is easy, what A alone tried is not.
  for (int problem = 8; problem <= 20; ++problem) {
    runs.push_back({.contestant = "B", .problem = problem, .time_s = 0.001});
  }
  runs.push_back({.contestant = "A", .problem = 21, .status = PlanStatus::kTimedOut});
  runs.push_back({.contestant = "A", .set = "table", .time_s = 9});
  const ComparedSessions compared = Read(runs);
  const std::vector<std::string> answer = Answer(compared, ComparePairs(compared));
  EXPECT_THAT(answer.at(0), testing::HasSubstr("A ranks first by penalised mean time: it solved "
                                               "100.0 % of the problems"));
  EXPECT_THAT(answer.at(0),
              testing::EndsWith("over the 7 problems of 1 set that all of them tried."));
  EXPECT_EQ(Cautions(compared).front(),
            "The contestants tried different problems (A 9, B 20): they rank by the 7 that all of "
            "them tried.");
}

}  // namespace
}  // namespace planbench
