#include "benchmark_driver/tables.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "benchmark_driver/text_table.h"
#include "results/reason_count.h"
#include "tests/benchmark_driver/example_tables.h"

namespace planbench {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(TablesTest, SuccessCountsClaimedAndConfirmed) {
  const std::string text = Brief(FourProblems());
  EXPECT_EQ(Table(text, kSuccess).at(0),
            "contestant runs claimed confirmed % [95 %] fwd bwd failed blocked");
  EXPECT_EQ(Row(text, kSuccess, "ARA*"), "4 2 2 50.0 [15.0, 85.0] 1 1 1 1");
  EXPECT_EQ(Row(text, kSuccess, "RRT-Connect"), "2 2 1 50.0 [9.5, 90.5] 1 0 0 0");
}

TEST(TablesTest, TimesIncludeFailedAttempts) {
  const std::string text = Brief(FourProblems());
  EXPECT_EQ(Table(text, kTimes).at(0), "contestant solved median [95 %] mean 95 % penalised mean");
  // 0.1 s, and 60 s of failure before 0.04 s; two of four runs count as 600 s.
  EXPECT_EQ(Row(text, kTimes, "ARA*"), "2 30070 30070 57043 315035");
  EXPECT_EQ(Row(text, kTimes, "RRT-Connect"), "1 5.123 5.123 5.123 300003");
}

TEST(TablesTest, DirectionsAreToldApartInTheFullTables) {
  const std::string text = Full(FourProblems());
  EXPECT_EQ(Row(text, kDirections, "ARA* fwd"), "4 1 1 100.0 100.0 100.0 100.0 100.0");
  EXPECT_EQ(Row(text, kDirections, "ARA* bwd"), "4 2 2 30.0 30.0 25.0 35.0 39.0");
  EXPECT_EQ(Row(text, kDirections, "RRT-Connect fwd"), "2 1 1 5.123 5.123 5.123 5.123 5.123");
  EXPECT_EQ(Row(text, kDirections, "RRT-Connect bwd"), "");
}

TEST(TablesTest, OfAttemptsAProblemCountsOnceHoweverManyTrialsItHas) {
  std::vector<RunRecordMessage> records;
  for (int trial = 1; trial <= 3; ++trial) {
    records.push_back(AttemptOf(PlanStatus::kSolved, trial));
    records.back().trial = trial;
  }
  records.push_back(OfProblem(2, AttemptOf(PlanStatus::kSolved, 10)));
  EXPECT_EQ(Row(Full(records), kDirections, "ARA* fwd"), "4 4 2 6000 6000 4000 8000 9600");
}

TEST(TablesTest, PairsAreComparedProblemByProblem) {
  const std::string text = Brief(FourProblems());
  // RRT-Connect comes first in the line-up. ARA* takes 0.1 s against 0.0051234 s, and is alone in
  // solving the second.
  EXPECT_EQ(Row(text, kPairs, "ARA* RRT-Connect"), "2 50.0 1 19.5 1.0000");
}

TEST(TablesTest, ARatioTellsOnHowManyProblemsItRests) {
  // ARA* solves both problems by one of two trials and by two of two.
  std::vector<RunRecordMessage> records;
  for (const int problem : {1, 2}) {
    records.push_back(OfProblem(problem, OfRrtConnect(AttemptOf(PlanStatus::kSolved, 1))));
    for (const int trial : {1, 2}) {
      const bool fails = problem == 1 && trial == 1;
      records.push_back(
          OfProblem(problem, AttemptOf(fails ? PlanStatus::kTimedOut : PlanStatus::kSolved, 4)));
      records.back().trial = trial;
    }
  }
  std::string text = Brief(records);
  EXPECT_EQ(Table(text, kPairs).at(0),
            "contestant against problems won % both time ratio [95 %] p (Holm)");
  EXPECT_THAT(Row(text, kTimes, "ARA*"), StartsWith("2 "));
  EXPECT_THAT(Row(text, kPairs, "ARA* RRT-Connect"), StartsWith("2 0.0 1 4 "));
  text = std::regex_replace(text, std::regex("\\s+"), " ");  // lines are broken
  EXPECT_THAT(text, HasSubstr("solved: problems with a confirmed path in one trial at least;"));
  EXPECT_THAT(text, HasSubstr("A problem is solved here, in the median, if more than half of its"));
  EXPECT_THAT(text, HasSubstr("both: those that both solved, in more than 0 ms."));
}

TEST(TablesTest, PValuesAreAdjustedForAllPairsOfTheSet) {
  std::vector<RunRecordMessage> records;
  for (int problem = 1; problem <= 8; ++problem) {
    const double time_s = 1 + problem / 10.0;
    records.push_back(OfProblem(problem, OfRrtConnect(AttemptOf(PlanStatus::kSolved, time_s))));
    records.push_back(OfProblem(problem, AttemptOf(PlanStatus::kSolved, 2 * time_s)));
    records.push_back(OfProblem(problem, AttemptOf(PlanStatus::kSolved, 3 * time_s)));
    records.back().contestant = "third";
  }
  // 2 / 2^8 each, of three pairs, though the brief table shows two.
  for (const std::string& text : {Brief(records), Full(records)}) {
    EXPECT_EQ(Row(text, kPairs, "ARA* RRT-Connect"), "8 0.0 8 2 [2, 2] 0.0234");
    EXPECT_EQ(Row(text, kPairs, "third RRT-Connect"), "8 0.0 8 3 [3, 3] 0.0234");
  }
}

TEST(TablesTest, RatiosThatProcessesMayMakeAreMarkedAndDoNotReadOne) {
  const auto text_of = [](double ratio) {
    std::vector<RunRecordMessage> records;
    for (int problem = 1; problem <= 8; ++problem) {
      records.push_back(OfProblem(problem, OfRrtConnect(AttemptOf(PlanStatus::kSolved, problem))));
      records.push_back(OfProblem(problem, AttemptOf(PlanStatus::kSolved, ratio * problem)));
    }
    return std::regex_replace(Brief(records), std::regex("\\s+"), " ");  // lines are broken
  };
  const std::string near = "may be of these processes rather than of the planners";
  EXPECT_THAT(text_of(1.004), HasSubstr(" 8 1.004 [1.004, 1.004] "));
  for (const double ratio : {1.004, 0.96}) EXPECT_THAT(text_of(ratio), HasSubstr(near)) << ratio;
  for (const double ratio : {1.06, 0.94})
    EXPECT_THAT(text_of(ratio), Not(HasSubstr(near))) << ratio;
}

TEST(TablesTest, PairsFitOnATerminal) {
  std::vector<RunRecordMessage> records;
  for (int problem = 1; problem <= 8; ++problem) {
    records.push_back(OfProblem(problem, OfRrtConnect(AttemptOf(PlanStatus::kSolved, 1))));
    const double time_s = 0.00353 * std::pow(19.3, problem % 2 == 0 ? 1 : -1);
    records.push_back(OfProblem(problem, AttemptOf(PlanStatus::kSolved, time_s)));
    records.back().contestant = "RRT-Connect (canonical)";  // the longest of the default line-up
  }
  std::istringstream lines(Brief(records));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), kTextWidth) << line;
  EXPECT_THAT(Row(lines.str(), kPairs, "RRT-Connect (canonical) RRT-Connect"),
              HasSubstr(" 8 0.00353 [0.000"));
}

TEST(TablesTest, ContestantsWithoutACommonProblemAreNoPair) {
  const std::vector<RunRecordMessage> records = {
      OfProblem(1, AttemptOf(PlanStatus::kSolved, 1)),
      OfProblem(2, OfRrtConnect(AttemptOf(PlanStatus::kSolved, 1)))};
  EXPECT_TRUE(Table(Full(records), kPairs).empty());
}

TEST(TablesTest, AFailureWhoseOtherDirectionIsMissingIsMissing) {
  RunRows rows;
  rows.Add(OfProblem(1, AttemptOf(PlanStatus::kTimedOut, 60)), true);
  rows.Add(OfProblem(1, Backward(PlanStatus::kSolved, 1)));
  rows.Add(OfProblem(2, AttemptOf(PlanStatus::kTimedOut, 60)), true);
  rows.Add(OfProblem(3, AttemptOf(PlanStatus::kTimedOut, 60)));
  const std::string text = MakeTables(Conditions(), rows, {}, 1).brief;
  EXPECT_THAT(Row(text, kSuccess, "ARA*"), StartsWith("2 1 1 50.0 ["));
  EXPECT_THAT(text, StartsWith("1 OF 5 RUNS ARE MISSING"));
  EXPECT_THAT(text, HasSubstr("1 more found nothing"));
  RunRows alone;
  alone.Add(AttemptOf(PlanStatus::kTimedOut, 60), true);
  EXPECT_THAT(MakeTables(Conditions(), alone, {}, 1).brief, EndsWith("No runs.\n"));
}

TEST(TablesTest, ARunThatWasNotAskedForIsMissing) {
  const auto not_asked = [](RunRecordMessage record) {
    record.roundtrip_time_s = 0;
    record.message = "given up: it died";
    return record;
  };
  RunRows rows;
  rows.Add(OfProblem(1, AttemptOf(PlanStatus::kSolved, 1)));
  rows.Add(not_asked(OfProblem(2, AttemptOf(PlanStatus::kNoAnswer, 0))));
  rows.Add(OfProblem(3, AttemptOf(PlanStatus::kTimedOut, 60)), true);
  rows.Add(not_asked(OfProblem(3, Backward(PlanStatus::kNoAnswer, 0))));
  rows.Add(OfProblem(4, AttemptOf(PlanStatus::kNoAnswer, 1)));  // it died of it
  const SessionTables tables = MakeTables(Conditions(), rows, {}, 1);
  EXPECT_THAT(Row(tables.brief, kSuccess, "ARA*"), StartsWith("2 1 1 50.0 ["));
  EXPECT_THAT(tables.brief, StartsWith("3 OF 6 RUNS ARE MISSING"));
  const std::vector<std::string> failed = Table(tables.full, kFailed);
  EXPECT_EQ(
      std::count_if(failed.begin(), failed.end(),
                    [](const std::string& line) { return line.find("NO_ANSWER") != line.npos; }),
      1);
  std::string in_one_line = tables.brief;
  std::replace(in_one_line.begin(), in_one_line.end(), '\n', ' ');
  EXPECT_THAT(in_one_line,
              HasSubstr("2 of them could not be asked for or judged (mostly: given up: it "
                        "died). 1 more found nothing in one direction"));
  EXPECT_THAT(in_one_line, Not(HasSubstr("before it was resumed")));
  std::string resumed = MakeTables(Conditions(), rows, {}, 1, {}, 2).brief;
  std::replace(resumed.begin(), resumed.end(), '\n', ' ');
  EXPECT_THAT(resumed, HasSubstr("died). 2 of them the session was to make before it was resumed, "
                                 "with other planners, sets, problems or trials. 1 more"));
  RunRows none;
  none.Add(not_asked(AttemptOf(PlanStatus::kNoAnswer, 0)));
  EXPECT_THAT(MakeTables(Conditions(), none).brief, StartsWith("1 OF 1 RUNS ARE MISSING"));
}

TEST(TablesTest, AllPairsAreInTheFullTables) {
  auto records = FourProblems();
  auto more = OfProblem(1, AttemptOf(PlanStatus::kSolved, 1));
  more.contestant = "third";  // of an earlier part of the session
  records.push_back(more);
  EXPECT_NE(Row(Full(records), kPairs, "third ARA*"), "");
  EXPECT_EQ(Row(Brief(records), kPairs, "third ARA*"), "");
  EXPECT_NE(Row(Brief(records), kPairs, "third RRT-Connect"), "");
}

TEST(TablesTest, FailuresAreListedWithProblemAndReason) {
  const std::string brief = Brief(FourProblems());
  EXPECT_THAT(brief, HasSubstr("  box, RRT-Connect: 1 INVALID_PATH, problem 2\n"
                               "    mostly: elbow hits board\n"));
  EXPECT_THAT(brief, HasSubstr("  box, ARA*: 2 TIMED_OUT, problems 2 3\n"));
  EXPECT_THAT(brief, HasSubstr("  box, ARA*: 2 GOAL_INVALID, problem 4\n"));
  EXPECT_EQ(Row(Full(FourProblems()), kFailed, "2 RRT-Connect forward 1 INVALID_PATH"),
            "elbow hits board");
}

TEST(TablesTest, ALongReasonInTheListOfFailuresGoesOnBelow) {
  auto records = FourProblems();
  records.back().message = "waypoint 1: joint 'elbow' at 7.5 rad is outside its limits [-2, 2]";
  EXPECT_THAT(Full(records),
              HasSubstr(fmt::format("INVALID_PATH  waypoint 1: joint 'elbow' at 7.5 rad is\n"
                                    "{:56}outside its limits [-2, 2]\n",
                                    "")));
}

TEST(TablesTest, ALongReasonOfFailuresIsBrokenNotCut) {
  RunRecordMessage record = AttemptOf(PlanStatus::kTimedOut, 60);
  const std::string before = "no scene: object[5].shape[0].mesh_resource:";
  const std::string file = fmt::format("/{:d>80}.obj:3: no", "");
  record.message = fmt::format("{} {}", before, file);
  EXPECT_THAT(Brief({record}), HasSubstr(fmt::format("    mostly: {}\n    {}\n", before, file)));
}

TEST(TablesTest, NothingFailedIsNotMentioned) {
  const std::vector<RunRecordMessage> records = {AttemptOf(PlanStatus::kSolved, 1)};
  EXPECT_THAT(Brief(records), Not(HasSubstr(kFailed)));
  EXPECT_THAT(Full(records), Not(HasSubstr(kFailed)));
}

TEST(TablesTest, NothingSolvedIsNoTime) {
  const std::vector<RunRecordMessage> records = {AttemptOf(PlanStatus::kTimedOut, 60)};
  EXPECT_EQ(Row(Brief(records), kTimes, "ARA*"), "0 - - - 600000");
  EXPECT_THAT(Row(Full(records), kEffort, "ARA*"), testing::MatchesRegex("-( -)*"));
}

TEST(TablesTest, TrialsAreRunsOfOneProblem) {
  std::vector<RunRecordMessage> records;
  for (int trial = 1; trial <= 3; ++trial) {
    records.push_back(AttemptOf(trial == 3 ? PlanStatus::kTimedOut : PlanStatus::kSolved, trial));
    records.back().trial = trial;
  }
  EXPECT_THAT(Row(Brief(records), kSuccess, "ARA*"), StartsWith("3 2 2 66.7 ["));
  EXPECT_THAT(Brief(records), Not(HasSubstr("make one trial")));
  auto with_other = records;
  with_other.push_back(OfRrtConnect(AttemptOf(PlanStatus::kSolved, 1)));
  EXPECT_THAT(Brief(with_other), HasSubstr("make one trial"));
  EXPECT_EQ(Row(Brief(records), kTimes, "ARA*"), "1 1500 1500 1500 201000");
}

TEST(TablesTest, WhoLearnedFromTheSetItselfIsMarked) {
  auto session = FourProblems();
  const std::string set = session.front().problem_set;
  EXPECT_THAT(Brief(session), Not(HasSubstr("(trained)")));
  for (RunRecordMessage& record : session) {
    record.settings["learned_from"] =
        record.contestant == "ARA*" ? "other, " + set : "not_" + set + ", " + set + "_either";
  }
  const std::string text = Brief(session);
  EXPECT_THAT(Row(text, kSuccess, "ARA* (trained)"), StartsWith("4 2 2 50.0 ["));
  EXPECT_THAT(Row(text, kSuccess, "RRT-Connect"), StartsWith("2 2 1 50.0 ["));
  EXPECT_THAT(text, HasSubstr("no test"));
  EXPECT_THAT(text, HasSubstr("\n  ARA* (trained): what ARA* is"));
  EXPECT_THAT(text, HasSubstr("\n  RRT-Connect: what RRT-Connect is"));
  EXPECT_THAT(Full(session), HasSubstr("\n  ARA* (trained): what ARA* is"));
  auto of_two_sets = session;
  of_two_sets.push_back(OfProblem(1, session.front()));
  of_two_sets.back().problem_set = "elsewhere";
  EXPECT_THAT(Brief(of_two_sets), HasSubstr("\n  ARA* (trained on " + set + "): what ARA* is"));
  EXPECT_NE(Row(text, kTimes, "ARA* (trained)"), "");
  EXPECT_THAT(text.substr(text.find("Problem by problem")), HasSubstr("ARA* (trained)"));

  // Where scenes are told they decide, whatever sets are called.
  for (RunRecordMessage& record : session) {
    record.request.scene_id = "0123456789abcdef";
    record.settings["learned_from"] = record.contestant == "ARA*" ? set : "a copy";
    record.settings["learned_scenes"] =
        record.contestant == "ARA*" ? "76543210" : "76543210 01234567";
  }
  EXPECT_EQ(Row(Brief(session), kSuccess, "ARA* (trained)"), "");
  EXPECT_NE(Row(Brief(session), kSuccess, "RRT-Connect (trained)"), "");
}

TEST(TablesTest, APlannerWhoseTimesAreOddIsNamedOnce) {
  std::vector<RunRecordMessage> records = FourProblems();
  EXPECT_THAT(Brief(records), Not(HasSubstr("more time")));
  int num_told = 0;
  for (RunRecordMessage& record : records) {
    if (record.contestant == "ARA*") record.result.result.counters[kToldTime] = 100 * ++num_told;
  }
  const std::string text = Brief(records);
  EXPECT_THAT(text, HasSubstr(fmt::format("ARA*: {0} of {0} runs were told to have taken more time",
                                          num_told)));
  EXPECT_THAT(text, HasSubstr(fmt::format("up to {}", 100 * num_told)));
  EXPECT_EQ(text.find("more time"), text.rfind("more time"));
  records.front().result.result.counters[kContradictoryTime] = 2;
  EXPECT_THAT(Brief(records), HasSubstr("times of which a part is longer than the total"));
  records.front().result.result.counters[kUntoldTime] = 2;
  EXPECT_THAT(Brief(records), HasSubstr("answered after the time limit"));
}

TEST(TablesTest, AnswersThatCameMuchLaterThanTheyTellAreNamed) {
  std::vector<RunRecordMessage> records;
  for (int i = 1; i <= 3; ++i) {
    records.push_back(OfProblem(i, AttemptOf(PlanStatus::kSolved, 0.001)));
    records.push_back(OfProblem(i, OfRrtConnect(AttemptOf(PlanStatus::kSolved, 0.002))));
  }
  EXPECT_THAT(Brief(records), Not(HasSubstr("too short")));
  records[0].roundtrip_time_s = 0.301;
  EXPECT_THAT(Brief(records), Not(HasSubstr("too short"))) << "a single run was held up";
  records[2].roundtrip_time_s = 0.301;
  const std::string note = "ARA*: its answers tell of 1 ms, and 300 ms more passed until they came";
  EXPECT_THAT(Brief(records), HasSubstr(note));
  EXPECT_THAT(Full(records), HasSubstr(note));
  EXPECT_THAT(Brief(records), Not(HasSubstr("RRT-Connect: its answers")));
}

TEST(TablesTest, WhoCallsAGoalInvalidThatAPathReachesIsNamed) {
  std::vector<RunRecordMessage> records = FourProblems();
  EXPECT_THAT(Brief(records), Not(HasSubstr("called start")));
  records.push_back(OfProblem(4, OfRrtConnect(AttemptOf(PlanStatus::kSolved, 1))));
  EXPECT_THAT(Brief(records), HasSubstr("ARA*: called start or goal invalid on 1 problem of"));
  SessionConditions conditions = Conditions();
  conditions.contestants.back().first_path_of = "RRT-Connect";
  EXPECT_THAT(MakeTables(conditions, Rows(records)).brief, Not(HasSubstr("called start")))
      << "it may be the other's word";
}

TEST(TablesTest, LongTextsAreShortened) {
  std::vector<RunRecordMessage> records = FourProblems();
  for (const std::string& reason :
       {std::string(1'000'000, 'x'), std::string(999, 'x') + "\u00e4"}) {
    for (RunRecordMessage& record : records) record.message = reason;
    std::istringstream lines(Full(records));
    for (std::string line; std::getline(lines, line);) EXPECT_LT(line.size(), 400u);
  }
  EXPECT_EQ(Shortened("12345\u00e4678901", 10), "12345 ...") << "whole characters";
}

TEST(TablesTest, OrderOfRecordsDoesNotMatter) {
  auto session = FourProblems();
  const SessionTables tables = MakeTables(Conditions(), Rows(session));
  std::reverse(session.begin(), session.end());
  EXPECT_EQ(MakeTables(Conditions(), Rows(session)).brief, tables.brief);
  EXPECT_EQ(MakeTables(Conditions(), Rows(session)).full, tables.full);
}

TEST(TablesTest, ReasonsThatDifferInFiguresAloneAreOne) {
  ReasonCount count;
  EXPECT_EQ(count.Summary(), "");
  count.Add("start is in collision: 'link2' and 'can', 0.0120 m deep");
  count.Add("start is in collision: 'link3' and 'can', 0.0120 m deep");
  count.Add("start is in collision: 'link3' and 'can', 0.0310 m deep");
  EXPECT_EQ(count.Summary(), "mostly: start is in collision: 'link3' and 'can', 0.0120 m deep");
}

TEST(TablesTest, AReasonOfFewRunsIsNoneOfMost) {
  ReasonCount count;
  for (const char* reason : {"no way", "no answer", "no way", "no sense", "no time"}) {
    count.Add(reason);
  }
  EXPECT_EQ(count.Summary(), "among others: no way");
}

TEST(TablesTest, WhatWasLeftOutStandsAboveTheTables) {
  const SessionTables tables =
      MakeTables(Conditions(), Rows(FourProblems()), {}, 0,
                 {{"box 7", "scene0007.yaml:3: world: is odd"}, {"box 9", "is even"}});
  for (const std::string& text : {tables.brief, tables.full}) {
    EXPECT_THAT(text, testing::StartsWith("2 PROBLEMS ARE LEFT OUT"));
    EXPECT_THAT(text, HasSubstr("  box 7: scene0007.yaml:3: world: is odd\n"));
    EXPECT_THAT(text, HasSubstr("  box 9: is even\n"));
  }
  EXPECT_THAT(Brief(FourProblems()), Not(HasSubstr("LEFT OUT")));
}

TEST(TablesTest, ContestantsAreExplained) {
  const std::string text = Brief(FourProblems());
  EXPECT_THAT(text, StartsWith("Contestants\n  RRT-Connect: what RRT-Connect is [spheres, edges "
                               "fixed at 0.02 m]\n  ARA*: what ARA* is [spheres, edges fixed at "
                               "0.02 m]\n\nSuccess\n"));
  auto records = FourProblems();
  records.back().settings["longest_valid_segment_fraction"] = "0.01";
  records[records.size() - 2].settings = records.back().settings;
  std::string line = Brief(records);
  line = line.substr(0, line.find("  ARA*"));
  line = std::regex_replace(line, std::regex("\\s+"), " ");  // it is broken
  EXPECT_THAT(line, HasSubstr("[spheres, edges fixed, own sampling: longest_valid_segment_fraction "
                              "0.01]"));
  SessionConditions conditions = Conditions();
  EXPECT_THAT(text, Not(HasSubstr("UNDER LOAD")));
  conditions.parallel = true;
  EXPECT_THAT(MakeTables(conditions, Rows(FourProblems())).brief, HasSubstr("UNDER LOAD"));
  EXPECT_THAT(text, Not(HasSubstr("started anew")));
  EXPECT_THAT(MakeTables(conditions, Rows(FourProblems()), {}, 0, {}, 0, 0, 10).brief,
              HasSubstr("started anew after so many problems (--problems-per-process 10)."));
}

TEST(TablesTest, DisturbedRunsAreCounted) {
  auto records = FourProblems();
  EXPECT_THAT(Brief(records), Not(HasSubstr("DISTURBED")));
  records[0].result.result.counters = {{"disturbed", 1}, {"repeats", 0}};
  records[1].result.result.counters = {{"disturbed", 0}, {"repeats", 0}};
  EXPECT_THAT(Brief(records),
              HasSubstr(fmt::format("1 of {} runs were DISTURBED", records.size())));
  EXPECT_THAT(Brief(records), HasSubstr("--repeat-disturbed"));
  const auto interrupted = [&] {
    return MakeTables(Conditions(), Rows(records), {}, 0, {}, 0, 1).brief;
  };
  EXPECT_THAT(interrupted(), HasSubstr("; 1 of them"));
  EXPECT_THAT(interrupted(), Not(HasSubstr("--repeat-disturbed")));
  records[1].result.result.counters["repeats"] = 2;
  EXPECT_THAT(Brief(records), HasSubstr("; 1 had been, and"));
}

TEST(TablesTest, ContestantsOfSeveralClassesHaveTheirs) {
  auto records = FourProblems();
  for (RunRecordMessage& record : records) record.planner_class = "sampling-guided";
  EXPECT_THAT(Brief(records), Not(HasSubstr("sampling-guided")));
  for (RunRecordMessage& record : records) {
    if (record.contestant == "ARA*") record.planner_class = "search-and-sample";
  }
  const std::string text = Brief(records);
  EXPECT_THAT(text, HasSubstr("  RRT-Connect, sampling-guided: what RRT-Connect is"));
  EXPECT_THAT(text, HasSubstr("  ARA*, search-and-sample: what ARA* is"));
  for (RunRecordMessage& record : records) {
    if (record.contestant == "ARA*") record.planner_class = "";
  }
  EXPECT_THAT(Brief(records), HasSubstr("  ARA*: what ARA* is"));
}

TEST(TablesTest, BriefOnesFitATerminal) {
  auto records = FourProblems();
  for (int i = 10; i < 400; ++i)
    records.push_back(OfProblem(i, AttemptOf(PlanStatus::kTimedOut, 1)));
  for (RunRecordMessage& record : records) {
    record.problem_set = "shelf_height_rot_test";
    if (record.contestant == "ARA*") record.contestant = "RRT-Connect (canonical)";
    if (!record.message.empty()) record.message = std::string(30, 'a') + std::string(90, ' ') + "b";
  }
  std::istringstream lines(Brief(records));
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), kTextWidth) << line;
    EXPECT_TRUE(line.empty() || line.back() != ' ') << line;
  }
}

TEST(TablesTest, FullOnesFitATerminal) {
  auto records = FourProblems();
  for (RunRecordMessage& record : records) {
    record.problem_set = "shelf_height_rot_test";
    if (record.contestant == "ARA*") record.contestant = "RRT-Connect (canonical)";
    record.result.result.counters = {{"edges_checked", 1e5}, {"configurations_checked", 1e7}};
    if (record.status != PlanStatus::kSolved) {
      record.message = "collision on segment 3 at 0.250: 'gripper_link' and 'left_side_board'\n";
    }
  }
  std::istringstream lines(Full(records));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), kTextWidth) << line;
}

TEST(TablesTest, PublishedFiguresStandBesideWhoAsksForThem) {
  SessionConditions conditions = Conditions();
  conditions.contestants[1].published = "ARA*";
  auto session = FourProblems();
  for (RunRecordMessage& record : session) record.problem_set = "shelf_height_rot_test";
  std::string text = MakeTables(conditions, Rows(session)).brief;
  EXPECT_EQ(Row(text, kSuccess, "published ARA*"), "100 86 - 86.0 [77.9, 91.5] 43 43 6 8");
  EXPECT_EQ(Row(text, kTimes, "of the solving attempt"), "2 70.0 70.0 97.0 -");
  EXPECT_EQ(Row(text, kTimes, "published ARA*"), "86 ~170.0 - - -");
  EXPECT_EQ(Row(text, kSuccess, "published RRT-Connect"), "");
  EXPECT_THAT(text, HasSubstr("arXiv 2406.09623"));
  text = MakeTables(conditions, Rows(FourProblems())).brief;  // not a set of the study's
  EXPECT_THAT(text, Not(HasSubstr("published ARA*")));
}

TEST(TablesTest, ReferencesStandBesideOnTheSessionsProblems) {
  std::vector<Attempt> references;
  for (int problem = 1; problem <= 9; ++problem) {
    references.push_back({"box", problem, "published", 1, Direction::kForward, PlanStatus::kSolved,
                          true, 1.0 * problem, 60});
  }
  const std::string text = MakeTables(Conditions(), Rows(FourProblems()), references).brief;
  EXPECT_EQ(Row(text, kSuccess, "published"), "4 4 - 100.0 [51.0, 100.0] 4 0 0 0");
  EXPECT_EQ(Row(text, kTimes, "published"), "4 2500 2500 3850 2500");
  EXPECT_NE(Row(text, kPairs, "published RRT-Connect"), "");
}

TEST(TablesTest, NoRuns) { EXPECT_EQ(Brief({}), "No runs.\n"); }

TEST(TablesTest, SayHowManyRunsAreMissing) {
  const SessionTables tables = MakeTables(Conditions(), Rows(FourProblems()), {}, 3);
  EXPECT_THAT(tables.brief, testing::StartsWith("3 OF "));
  EXPECT_THAT(tables.full, testing::StartsWith("3 OF "));
  EXPECT_THAT(MakeTables(Conditions(), {}, {}, 3).brief, HasSubstr("3 OF 3 RUNS ARE MISSING"));
  EXPECT_THAT(MakeTables(Conditions(), Rows(FourProblems())).brief,
              testing::Not(HasSubstr("MISSING")));
}

}  // namespace
}  // namespace planbench
