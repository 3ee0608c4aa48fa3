#include "report/cautions.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

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

TEST_F(ReportTest, WhoCallsAGoalInvalidThatAPathReachesIsNamed) {
  MadeRun blocked = {.contestant = "A", .status = PlanStatus::kGoalInvalid};
  const auto line = testing::Contains(
      "A: called start or goal invalid on 1 problem of which a path is confirmed "
      "by the same collision model (shelf 1).");
  EXPECT_THAT(Cautions(Read({blocked, {.contestant = "B"}})), line);
  blocked.settings["first_path_of"] = "b";
  EXPECT_THAT(Cautions(Read({blocked, {.contestant = "B"}})), testing::Not(line));
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

TEST_F(ReportTest, WhatWasOddAboutRobotsProblemsAndPlannersIsTold) {
  const TemporaryFolder folder;
  SessionMessage session = ExampleSession();
  NodeStatusMessage& server = session.nodes.emplace_back();
  server.kind = NodeKind::kSceneServer;
  TellWarnings(kProblemWarning, {"request0001.yaml: is odd"}, &server.settings);
  TellWarnings(kRobotWarning, {"arm.urdf: is odd", "judge: it is bent"}, &server.settings);
  TellWarnings(kPlannerWarning, {"'ara' has moved"}, &server.settings);
  session.nodes.push_back(server);  // as another part of the session has it
  WriteSession(folder / "it", {{.contestant = "A"}}, session);
  std::vector<std::string> told = Cautions(ComparedSessions(ReadSessions(folder / "it").sessions));
  std::erase_if(told, [](const std::string& line) { return !line.starts_with("it: "); });
  EXPECT_THAT(told, testing::IsSupersetOf({"it: arm.urdf: is odd", "it: judge: it is bent",
                                           "it: request0001.yaml: is odd", "it: 'ara' has moved"}));
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
