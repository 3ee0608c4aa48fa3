#include "report/answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "planning/told_warnings.h"
#include "results/session_plan.h"
#include "tests/report/report_fixture.h"

namespace planbench {
namespace {

TEST_F(ReportTest, WhatCannotBeComparedIsTold) {
  const TemporaryFolder folder;
  WriteSession(folder / "old", {{.contestant = "A"}}, ExampleSession());
  std::vector<StoredSession> sessions = ReadSessions(folder / "old").sessions;
  sessions.push_back(sessions.front());
  sessions[0].runs[0].scene_id = "a";
  sessions[1].runs[0].scene_id = "b";
  sessions[1].file = folder / "new" / "results.sqlite";
  const auto cautions = Cautions(ComparedSessions(sessions));
  EXPECT_EQ(cautions.at(0),
            "shelf (new): other scenes than those of the set of this name before; nothing is "
            "compared with them.");
  sessions[1].runs[0].scene_id = "a";
  sessions[1].runs[0].time_limit_s = 2;
  EXPECT_THAT(Cautions(ComparedSessions(sessions)).at(0),
              testing::HasSubstr("shelf: time limits differ (2.00 to 10.0 s)"));
  const ComparedSessions compared(sessions);
  EXPECT_THAT(LimitsNote(compared), testing::StartsWith("Time limits differ on shelf."));
  EXPECT_EQ(LimitsNote(compared_), "");
  int num_noted = 0;
  for (const Table& table : AllTables(compared, ComparePairs(compared))) {
    num_noted += table.note.find(kLimitsNote) != std::string::npos;
  }
  EXPECT_EQ(num_noted, 2) << "times, and pairs; there is nothing to tell of changes";
  sessions[1].runs[0].time_limit_s = 0;
  EXPECT_EQ(LimitsNote(ComparedSessions(sessions)), "");
  EXPECT_THAT(Cautions(ComparedSessions(sessions)),
              testing::Not(testing::Contains(testing::HasSubstr("time limits"))))
      << "one is not known, and nobody needs it";
  for (StoredSession& session : sessions) {
    session.runs[0].time_limit_s = 0;
    session.runs[0].status = PlanStatus::kTimedOut;
  }
  EXPECT_THAT(Cautions(ComparedSessions(sessions)).at(0),
              testing::HasSubstr("shelf: time limits are not known"));
}

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

TEST_F(ReportTest, ProblemsThatWereLeftOutAreTold) {
  const TemporaryFolder folder;
  SessionMessage session = ExampleSession();
  session.left_out = {{"shelf 3", "scene0003.yaml:7: world: is odd"}, {"shelf 9", "is even"}};
  WriteSession(folder / "example", {{.contestant = "A"}}, session);
  const auto cautions = Cautions(ComparedSessions(ReadSessions(folder / "example").sessions));
  EXPECT_EQ(cautions.at(1),
            "example: 2 problems left out, since the scene server refused them: shelf 3, shelf 9 "
            "(shelf 3: scene0003.yaml:7: world: is odd).");
}

TEST_F(ReportTest, TheBusIsTold) {
  const TemporaryFolder folder;
  WriteSession(folder / "example", {{.contestant = "A"}}, ExampleSession());
  const auto cautions = [&] {
    return Cautions(ComparedSessions(ReadSessions(folder / "example").sessions));
  };
  EXPECT_EQ(cautions().size(), 1u);  // no run.json: nothing is known
  folder.Write("example/run.json", R"({"sessions": []})");
  EXPECT_EQ(cautions().at(1), "example: no message was lost on the bus, as far as the logger saw.");
  folder.Write("example/run.json",
               R"({"bus": {"malformed_packets": 0, "lost_messages": 3, "dropped_messages": 1,
                           "contradictions": [{"count": 2}, {"count": 5}]}})");
  EXPECT_TRUE(cautions().at(1).starts_with(
      "example: on the bus 3 messages did not reach the logger, 1 message was more than it could "
      "keep up with, 7 messages told otherwise"))
      << cautions().at(1);
  folder.Write("example/run.json", R"({"bus": {"logs_not_told_of": 1}})");
  EXPECT_EQ(cautions().size(), 1u);
  folder.Write("example/run.json", R"({"bus": {"logs_not_told_of": 1, "lost_messages": 1}})");
  EXPECT_TRUE(cautions().at(1).starts_with(
      "example: on the bus 1 message did not reach the logger; of 1 part it is not known; runs"))
      << cautions().at(1);
  folder.Write("example/run.json", "{\"sessions\": [");
  EXPECT_THROW(cautions(), InputError);
}

TEST_F(ReportTest, ImpossibleTimesAreTold) {
  const ComparedSessions compared =
      Read({{.contestant = "A", .counters = {{"told_time", 300}}}, {.contestant = "B"}});
  EXPECT_EQ(Cautions(compared).size(), 2u);
  EXPECT_EQ(
      Cautions(compared).at(1),
      "A: 1 of 1 runs were told to have taken more time than passed until the answer came, up "
      "to 300 s: the round trip counts in its place.");
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

TEST_F(ReportTest, WhoCallsAGoalInvalidThatAPathReachesIsNamed) {
  MadeRun blocked = {.contestant = "A", .status = PlanStatus::kGoalInvalid};
  const auto line = testing::Contains(
      "A: called start or goal invalid on 1 problem of which a path is confirmed "
      "by the same collision model (shelf 1).");
  EXPECT_THAT(Cautions(Read({blocked, {.contestant = "B"}})), line);
  blocked.settings["first_path_of"] = "b";
  EXPECT_THAT(Cautions(Read({blocked, {.contestant = "B"}})), testing::Not(line));
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
  EXPECT_THAT(answer_of(1, {"A", "B"}),
              StartsWith("Too few problems to test whether A is faster than B: 1, 6 would do; "));
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

TEST_F(ReportTest, RunsThatWereNotAskedForAreMissing) {
  const MadeRun not_asked = {.contestant = "B",
                             .status = PlanStatus::kNoAnswer,
                             .reason = "given up: it died",
                             .asked = false};
  MadeRun of_another = not_asked;
  of_another.contestant = "C";
  const TemporaryFolder folder;
  WriteSession(folder / "example",
               {{.contestant = "A"},
                {.contestant = "B", .problem = 2, .status = PlanStatus::kNoAnswer},
                not_asked,
                of_another},
               ExampleSession());
  std::vector<StoredSession> sessions = ReadSessions(folder / "example").sessions;
  const ComparedSessions compared(sessions);
  EXPECT_EQ(compared.pooled().at("B").num_runs(), 1) << "that of which it died";
  const std::string line =
      "example: 2 more runs could not be asked for or judged (mostly: given up: it died): "
      "counted as missing, not as failed; --resume makes them.";
  std::vector<std::string> cautions = Cautions(compared);
  EXPECT_THAT(cautions, testing::Contains(line));
  EXPECT_THAT(cautions, testing::Contains("C: no run counts."));
  EXPECT_THAT(cautions, testing::Not(testing::Contains(testing::HasSubstr("recorded"))));
  sessions[0].finished = false;
  cautions = Cautions(ComparedSessions(sessions));
  EXPECT_THAT(cautions, testing::Contains("example: did not finish: 2 of 4 runs are recorded."));
  EXPECT_THAT(cautions, testing::Contains(line));
  sessions[0].finished = true;
  sessions[0].num_runs = 5;
  EXPECT_THAT(Cautions(ComparedSessions(sessions)),
              testing::Contains("example: 1 of 5 runs are not recorded."));
}

TEST_F(ReportTest, RunsThatNoResumedSessionMakesAreTold) {
  const TemporaryFolder folder;
  MadeRun too_fine = {.contestant = "A",
                      .problem = 2,
                      .status = PlanStatus::kNoAnswer,
                      .reason = "too fine",
                      .asked = false,
                      .unjudgeable = true};
  WriteSession(folder / "example", {{.contestant = "A"}, too_fine}, ExampleSession());
  const std::vector<StoredSession> sessions = ReadSessions(folder / "example").sessions;
  EXPECT_THAT(Cautions(ComparedSessions(sessions)),
              testing::Contains("example: 1 more run could not be asked for or judged (mostly: too "
                                "fine): counted as missing, not as failed; a new session with a "
                                "larger --referee-step makes it."));
}

TEST_F(ReportTest, PlannersThatWereStartedAnewAreTold) {
  const TemporaryFolder folder;
  SessionMessage session = ExampleSession();
  for (const char* problems : {"", "10"}) {
    session.settings["problems-per-process"] = problems;
    const std::string name = fmt::format("example{}", problems);
    WriteSession(folder / name, {{.contestant = "A"}}, session);
    const std::vector<StoredSession> sessions = ReadSessions(folder / name).sessions;
    const std::vector<std::string> cautions = Cautions(ComparedSessions(sessions));
    EXPECT_EQ(std::count(cautions.begin(), cautions.end(),
                         name + ": the planners were started anew after so many problems "
                                "(--problems-per-process 10)."),
              *problems == '\0' ? 0 : 1);
  }
}

TEST_F(ReportTest, WhatWasOddAboutRobotsAndProblemsIsTold) {
  const TemporaryFolder folder;
  SessionMessage session = ExampleSession();
  NodeStatusMessage& server = session.nodes.emplace_back();
  server.kind = NodeKind::kSceneServer;
  TellWarnings(kProblemWarning, {"request0001.yaml: is odd"}, &server.settings);
  TellWarnings(kRobotWarning, {"arm.urdf: is odd", "judge: it is bent"}, &server.settings);
  session.nodes.push_back(server);  // as another part of the session has it
  WriteSession(folder / "it", {{.contestant = "A"}}, session);
  std::vector<std::string> told = Cautions(ComparedSessions(ReadSessions(folder / "it").sessions));
  std::erase_if(told, [](const std::string& line) { return !line.starts_with("it: "); });
  EXPECT_THAT(told, testing::IsSupersetOf({"it: arm.urdf: is odd", "it: judge: it is bent",
                                           "it: request0001.yaml: is odd"}));
  EXPECT_EQ(std::ranges::count(told, "it: judge: it is bent"), 1);
}

TEST_F(ReportTest, RepeatsThatAreOwedAreTold) {
  const TemporaryFolder folder;
  SessionMessage session = ExampleSession();
  session.settings["repeat-disturbed"] = "true";
  WriteSession(folder / "example",
               {{.contestant = "A", .counters = {{"disturbed", 1}, {"repeats", 1}}},
                {.contestant = "A", .problem = 2, .counters = {{"disturbed", 1}, {"repeats", 2}}},
                {.contestant = "A", .problem = 3, .counters = {{"disturbed", 0}}}},
               session);
  std::vector<StoredSession> sessions = ReadSessions(folder / "example").sessions;
  sessions[0].finished = false;
  EXPECT_THAT(Cautions(ComparedSessions(sessions)),
              testing::Contains("example: did not finish: 3 of 3 runs are recorded, 1 of them "
                                "still to be made again (--resume)."));
  sessions[0].flags["repeat-disturbed"] = "false";
  EXPECT_THAT(Cautions(ComparedSessions(sessions)),
              testing::Contains("example: did not finish: 3 of 3 runs are recorded."));
}

TEST_F(ReportTest, ARecordOfWhomTheSessionDoesNotHaveIsNamedAndNoContestant) {
  const TemporaryFolder folder;
  SessionMessage session = ExampleSession();
  const std::vector<MadeRun> runs = {{.contestant = "A"},
                                     {.contestant = "B"},
                                     {.contestant = "B", .problem = 2},
                                     {.contestant = "C"}};
  WriteSession(folder / "whoever", runs, session);
  EXPECT_EQ(ComparedSessions(ReadSessions(folder / "whoever").sessions).contestants().size(), 3u)
      << "who takes part is not told";
  for (const char* name : {"A", "B"}) {
    session.conditions.contestants.emplace_back().planner = name;
    session.conditions.contestants.back().name = name;
  }
  WriteSession(folder / "example", runs, session);
  const ComparedSessions compared(ReadSessions(folder / "example").sessions);
  EXPECT_EQ(compared.contestants().size(), 2u);
  const std::vector<std::string> cautions = Cautions(compared);
  EXPECT_THAT(cautions, testing::Contains(
                            "example: 1 more record of 'C', which the session does not have as a "
                            "contestant: damaged, and counted as missing."));
  EXPECT_THAT(cautions, testing::Not(testing::Contains(testing::HasSubstr("recorded"))));
}

TEST_F(ReportTest, AttemptsThatAwaitTheOtherDirectionAreMissing) {
  const TemporaryFolder folder;
  SessionMessage session = ExampleSession();
  session.settings[kPlanSetting] =
      PlanText({{{{"shelf", {1, 2}}}, {{"planner", Directions::kAuto}}, {}}});
  WriteSession(folder / "example",
               {{.contestant = "A", .status = PlanStatus::kTimedOut},
                {.contestant = "A", .direction = Direction::kBackward},
                {.contestant = "A", .problem = 2, .status = PlanStatus::kTimedOut},
                {.contestant = "B", .status = PlanStatus::kTimedOut}},
               session);
  std::vector<StoredSession> sessions = ReadSessions(folder / "example").sessions;
  for (StoredRun& run : sessions[0].runs) run.request_id = "id/shelf/1/planner/forward/1";
  sessions[0].finished = false;
  sessions[0].num_runs = 6;
  const ComparedSessions compared(sessions);
  EXPECT_EQ(Texts(SuccessTable(compared), 0)[3], "1");
  const std::vector<std::string> cautions = Cautions(compared);
  ASSERT_EQ(cautions.size(), 3u);
  EXPECT_EQ(cautions[0], "example: did not finish: 2 of 6 runs are recorded.");
  EXPECT_THAT(cautions[1], testing::HasSubstr("2 more runs found nothing in one"));
  EXPECT_EQ(cautions[2], "B: no run counts.");
  sessions[0].finished = true;
  EXPECT_EQ(Cautions(ComparedSessions(sessions)).at(0), "example: 2 of 6 runs are not recorded.")
      << "those that await others are recorded";
}

TEST_F(ReportTest, WhatPathsAreWorthOnTheMeshesDependsOnWhatTheyWerePlannedWith) {
  const auto told = [](const std::vector<CollisionModel>& models) {
    std::vector<MadeRun> runs;
    for (const CollisionModel model : models) {
      runs.push_back({.contestant = "by " + std::string(EnumName(model)), .model = model});
    }
    return WithoutMeshRobot(Read(runs));
  };
  using testing::HasSubstr;
  EXPECT_THAT(told({CollisionModel::kSpheres, CollisionModel::kVoxels}),
              HasSubstr("those of all are worth on the true geometry is not known"));
  EXPECT_THAT(told({CollisionModel::kMeshes}),
              AllOf(HasSubstr("Of all it is the robot's own meshes"), Not(HasSubstr("not known"))));
  EXPECT_THAT(told({CollisionModel::kMeshes, CollisionModel::kEnclosing, CollisionModel::kSpheres}),
              AllOf(HasSubstr("Of by meshes it is"), HasSubstr("Of by enclosing it is"),
                    HasSubstr("those of by spheres are")));
}

}  // namespace
}  // namespace planbench
