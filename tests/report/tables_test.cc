#include "report/tables.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "report/answer.h"
#include "report/cautions.h"
#include "report/figures.h"
#include "report/session_tables.h"
#include "tests/report/report_fixture.h"

namespace planbench {
namespace {

// Sets come by name: "a<i>set</i>" before "shelf". kTagName ranks first.
TEST_F(ReportTest, Success) {
  const Table table = SuccessTable(compared_);
  ASSERT_EQ(table.rows.size(), 4u);
  // Wilson's interval of 5 of 6 and 10 of 12 by its closed form.
  const auto wilson = [](double p, double n) {
    const double z = 1.959963984540054, center = p + z * z / (2 * n);
    const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
    return fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100 * p, 100 * (center - half) / (1 + z * z / n),
                       100 * (center + half) / (1 + z * z / n));
  };
  EXPECT_EQ(Texts(table, 1), (Row{"a<i>set</i>", kScriptName, "6", "6", "6", "5",
                                  wilson(5 / 6.0, 6), "5", "0", "0", "0", "1", "0", "0"}));
  EXPECT_EQ(Texts(table, 2)[3], "24");
  EXPECT_EQ(Texts(table, 3), (Row{"shelf", kScriptName, "12", "12", "10", "10",
                                  wilson(10 / 12.0, 12), "10", "0", "2", "0", "0", "0", "0"}));
}

TEST_F(ReportTest, Times) {
  const Table table = TimeTable(compared_);
  const Row first = Texts(table, 2);
  EXPECT_EQ(first[2], "12");
  // 1.1 to 2.2 s; the 3rd and 10th of twelve enclose the median: P(Bin(12, 1/2) < 3) = 1.9 %.
  EXPECT_EQ(first[3], "1650 [1300, 2000]");
  EXPECT_EQ(first[8], "1650");
  // 2.2 to 4.0 s and twice ten limits.
  EXPECT_EQ(Texts(table, 3)[8], FormatNumber(1000 * (31 + 2 * 100) / 12.0));
}

TEST_F(ReportTest, Pairs) {
  ASSERT_EQ(pairs_.size(), 3u);  // two sets, and both together
  EXPECT_EQ(pairs_[2].set, kAllSets);
  const Row shelf = Texts(PairTable(pairs_), 1);
  EXPECT_EQ(shelf[3], "12");
  EXPECT_EQ(shelf[4], "12");
  EXPECT_EQ(shelf[5], "0");
  EXPECT_EQ(shelf[7], "10");                    // the other fails in two
  EXPECT_EQ(shelf[8], "0.500 [0.500, 0.500]");  // always half
  EXPECT_EQ(shelf[9], "0.0005");                // 2 / 2^12
  EXPECT_EQ(shelf[11], "-1.00");
  // Both sets: ten ratios of a half, and of 1.1 to 1.5 s to 4 s.
  const double log_sum =
      10 * std::log(0.5) + std::log(1.1 * 1.2 * 1.3 * 1.4 * 1.5 / std::pow(4, 5));
  EXPECT_NEAR(pairs_[2].result.ratio->mean, std::exp(log_sum / 15), 1e-12);
  EXPECT_EQ(pairs_[2].result.num_problems, 18);
}

TEST_F(ReportTest, Quality) {
  const Table table = QualityTable(compared_);
  EXPECT_THAT(table.note, testing::HasSubstr("Simplified: as each planner does it"));
  ASSERT_EQ(table.rows.size(), 8u);  // two sets, raw and simplified, two contestants
  const Row raw = Texts(table, 5);
  EXPECT_EQ(raw, (Row{"shelf", kScriptName, "path_length", "rad, m", "raw", "10", "4.00", "4.00",
                      "4.00", kTagName, "10", "2.00 [2.00, 2.00]", "-"}));
  const Row reference = Texts(table, 4);
  EXPECT_EQ(Row(reference.begin() + 9, reference.end()), (Row{kTagName, "-", "-", "-"}));
}

TEST_F(ReportTest, QualityNamesWhatRatiosAreTo) {
  // A ranks first, and has no path on the table.
  std::vector<MadeRun> runs = {
      {.contestant = "A", .set = "table", .status = PlanStatus::kTimedOut},
      {.contestant = "B", .set = "table", .length = 2},
      {.contestant = "C", .set = "table", .time_s = 2, .length = 6},
  };
  for (int problem = 1; problem <= 4; ++problem) {
    runs.push_back({.contestant = "A", .problem = problem});
    for (const char* name : {"B", "C"}) {
      runs.push_back({.contestant = name, .problem = problem, .status = PlanStatus::kTimedOut});
    }
  }
  const Table table = QualityTable(Read(runs));
  ASSERT_EQ(table.rows.size(), 6u);  // A on the shelf, B and C on the table; raw and simplified
  EXPECT_EQ(Texts(table, 0)[9], "A");
  const Row b = Texts(table, 2), c = Texts(table, 3);
  EXPECT_EQ(Row(b.begin() + 9, b.end()), (Row{"B", "-", "-", "-"}));
  EXPECT_EQ(Row(c.begin() + 9, c.end()), (Row{"B", "1", "3.00", "-"}));
}

TEST_F(ReportTest, RejectedSimplifiedPathsAreCountedAndNotMeasured) {
  const ComparedSessions compared =
      Read({{.contestant = "A", .length_simplified = 0, .simplified_valid = false},
            {.contestant = "A", .problem = 2, .length_simplified = 1.5},
            {.contestant = "B", .time_s = 2, .length_simplified = 0, .simplified_valid = false},
            {.contestant = "B", .problem = 2, .status = PlanStatus::kInvalidPath}});
  const Table table = QualityTable(compared);
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(Texts(table, 0)[5], "2") << "the raw ones are confirmed";
  EXPECT_EQ(Texts(table, 2), (Row{"shelf", "A", "path_length", "rad, m", "simplified", "1", "1.50",
                                  "1.50", "1.50", "A", "-", "-", "1"}));
  EXPECT_EQ(Texts(table, 3), (Row{"shelf", "B", "path_length", "rad, m", "simplified", "0", "-",
                                  "-", "-", "A", "0", "-", "1"}));
  EXPECT_THAT(Cautions(compared),
              testing::IsSupersetOf(
                  {"A: the referee rejected 1 of 2 simplified paths of confirmed runs: no measure "
                   "of path quality counts them.",
                   "B: the referee rejected 1 of 1 simplified paths of confirmed runs: no measure "
                   "of path quality counts them."}));
  EXPECT_EQ(FigureData(compared, {}, {})["attempts"]["length_simplified"],
            (Json{nullptr, 1.5, nullptr, nullptr}));
}

TEST_F(ReportTest, NoAnswerMeansTheSameEverywhere) {
  const ComparedSessions compared =
      Read({{.contestant = "A", .status = PlanStatus::kNoAnswer},
            {.contestant = "A", .problem = 2, .status = PlanStatus::kCancelled},
            {.contestant = "A", .problem = 3, .status = PlanStatus::kInvalidRequest}});
  const Row success = Texts(SuccessTable(compared), 0);
  EXPECT_EQ(Row(success.end() - 2, success.end()), (Row{"1", "2"}));  // no answer, refused
  EXPECT_EQ(Texts(ConditionTable(compared), 0)[3], "1");
}

TEST_F(ReportTest, DirectionsHaveTimesOfTheirOwn) {
  EXPECT_TRUE(DirectionTable(compared_).rows.empty()) << "nobody searched backward";
  const auto backward = Direction::kBackward;
  const ComparedSessions compared =
      Read({{.contestant = "A", .time_s = 1},
            {.contestant = "A", .time_s = 3, .direction = backward},
            {.contestant = "A", .problem = 2, .status = PlanStatus::kTimedOut, .time_s = 10},
            {.contestant = "A", .problem = 2, .time_s = 5, .direction = backward},
            {.contestant = "A", .problem = 2, .trial = 2, .time_s = 2},
            {.contestant = "A", .problem = 2, .trial = 2, .time_s = 6, .direction = backward},
            {.contestant = "B"}});
  const Table table = DirectionTable(compared);
  ASSERT_EQ(table.rows.size(), 2u);
  const Row forward_row = Texts(table, 0), backward_row = Texts(table, 1);
  EXPECT_EQ(Row(forward_row.begin(), forward_row.begin() + 7),
            (Row{"shelf", "A", "forward", "3", "2", "2", "1500"}));
  EXPECT_EQ(Row(backward_row.begin(), backward_row.begin() + 7),  // 3, and 5 and 6 s
            (Row{"shelf", "A", "backward", "3", "3", "2", FormatNumber(1000 * (3 + 5.5) / 2)}));
}

TEST_F(ReportTest, OfBothDirectionsOnlyThePathFromStartToGoalCounts) {
  // The backward search finds a longer path, in more time, that the meshes do not allow and of
  // which the referee rejects the simplified one.
  const MadeRun forward = {.contestant = "A", .length = 2, .mesh_valid = true};
  MadeRun backward = forward;
  backward.direction = Direction::kBackward;
  backward.time_s = 3;
  backward.length = 8;
  backward.simplified_valid = false;
  backward.mesh_valid = false;
  const ComparedSessions compared = Read({forward, backward});
  const Row raw = Texts(QualityTable(compared), 0);
  EXPECT_EQ(Row(raw.begin() + 5, raw.begin() + 9), (Row{"1", "2.00", "2.00", "2.00"}));
  EXPECT_EQ(Texts(QualityTable(compared), 1).back(), "0") << "rejected";
  EXPECT_EQ(Texts(PhaseTable(compared), 0)[2], "1");
  EXPECT_EQ(Texts(PhaseTable(compared), 0)[4], "500");
  const Row meshes = Texts(MeshTable(compared), 0);
  EXPECT_EQ(Row(meshes.begin() + 2, meshes.begin() + 6), (Row{"1", "1", "1", "1"}));
  EXPECT_THAT(Cautions(compared), testing::Not(testing::Contains(testing::HasSubstr("rejected"))));
  const Json figures = FigureData(compared, {}, {})["sets"][0];
  EXPECT_EQ(figures["quality"][0]["raw"][0]["median"], 2);
  EXPECT_EQ(figures["phases"][0]["total"], 1000);
}

TEST_F(ReportTest, Phases) {
  const Table table = PhaseTable(compared_);
  EXPECT_EQ(Texts(table, 2)[2], "24");
  // An eighth, a half, a quarter, an eighth of a mean of 1.65 s, and what every run took after it.
  const std::vector<double> expected_ms = {1650.0 / 8, 1650.0 / 2, 1650.0 / 4, 1650.0 / 8, 250};
  for (std::size_t i = 0; i < expected_ms.size(); ++i) {
    EXPECT_NEAR(std::get<double>(table.rows[2][3 + i]), expected_ms[i], 1e-9);
  }
}

TEST_F(ReportTest, Failures) {
  const Table table = FailureTable(compared_);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(Texts(table, 0),
            (Row{"a<i>set</i>", kScriptName, "INVALID_PATH", "hits <board>", "1", "6"}));
  EXPECT_EQ(Texts(table, 1),
            (Row{"shelf", kScriptName, "TIMED_OUT", "the time limit came", "2", "11, 12"}));
}

TEST_F(ReportTest, Conditions) {
  const Table table = ConditionTable(compared_);
  EXPECT_EQ(Texts(table, 0),
            (Row{"example", kTagName, "30", "0", "1.00", "-", "-", "-", "0", "0"}));
  EXPECT_EQ(Texts(table, 1),
            (Row{"example", kScriptName, "18", "0", "-", "-", "-", "-", "0", "0"}));
  EXPECT_EQ(Cautions(compared_),
            std::vector<std::string>{"example: all 48 runs are recorded; it took 0 s."});
}

TEST_F(ReportTest, NoiseIsWhatAChecksTimeVariesAmongTrials) {
  // Collision checking is half of the time: 5 ms and 4 ms a configuration, then 1 ms and 3 ms.
  const ComparedSessions compared = Read(
      {{.contestant = "A", .time_s = 1, .counters = {{"configurations_checked", 100}}},
       {.contestant = "A", .trial = 2, .time_s = 2, .counters = {{"configurations_checked", 250}}},
       {.contestant = "A",
        .problem = 2,
        .time_s = 2,
        .counters = {{"configurations_checked", 1000}}},
       {.contestant = "A",
        .problem = 2,
        .trial = 2,
        .time_s = 6,
        .counters = {{"configurations_checked", 1000}}},
       {.contestant = "A",
        .problem = 3,
        .time_s = 6,
        .counters = {{"configurations_checked", 1}}}});
  const Row row = Texts(ConditionTable(compared), 0);
  EXPECT_EQ(row[4], "2.50");  // median of 2 and 3
  EXPECT_EQ(row[5], FormatNumber((1.25 + 3) / 2));
}

TEST_F(ReportTest, WhatOtherWorkDidToTheRunsIsTold) {
  // A round trip takes half a second longer than planning: 1.5 s and 2.5 s.
  const ComparedSessions compared = Read(
      {{.contestant = "A",
        .time_s = 1,
        .counters = {{"load_before", 1}, {"waiting_time", 0.5}, {"disturbed", 1}, {"repeats", 2}}},
       {.contestant = "A",
        .problem = 2,
        .time_s = 2,
        .counters =
            {{"load_before", 4}, {"waiting_time", 0}, {"steal_time", 0.25}, {"repeats", 1}}},
       {.contestant = "A", .problem = 3}});
  const Row row = Texts(ConditionTable(compared), 0);
  EXPECT_EQ(row[6], "2.50");
  EXPECT_EQ(row[7], FormatNumber(100 * 0.75 / 4));
  EXPECT_EQ(row[8], "1");
  EXPECT_EQ(row[9], "2");
}

TEST_F(ReportTest, TheMachineIsTold) {
  const TemporaryFolder folder;
  SessionMessage session = ExampleSession();
  NodeStatusMessage driver;
  driver.kind = NodeKind::kDriver;
  driver.settings = {{"cpu", "Fast CPU"}, {"governor", "powersave"}, {"load", "1 2 3"}};
  session.nodes = {driver};
  WriteSession(folder / "example", {{.contestant = "A"}}, session);
  const ComparedSessions compared(ReadSessions(folder / "example").sessions);
  const Table table = SessionTable(compared, false);
  std::map<std::string, std::string> fields;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    fields[Texts(table, i)[0]] = Texts(table, i)[1];
  EXPECT_EQ(fields.at("governor"), "powersave");
  EXPECT_EQ(fields.at("load"), "1 2 3");
  EXPECT_FALSE(fields.contains("cpu"));
}

TEST_F(ReportTest, WhoHasLearnedFromASetIsMarkedThere) {
  const TemporaryFolder folder;
  std::vector<MadeRun> runs = ExampleRuns();
  // Judged by meshes once, and failed once.
  runs.push_back({.contestant = kTagName, .problem = 13, .mesh_valid = true});
  runs.push_back({.contestant = kTagName, .problem = 14, .status = PlanStatus::kTimedOut});
  WriteSession(folder / "example", runs, ExampleSession());
  std::vector<StoredSession> sessions = ReadSessions(folder / "example").sessions;
  for (StoredContestant& one : sessions[0].contestants) {
    if (one.name == kTagName) one.settings += "learned_from = other, shelf\n";
  }
  const ComparedSessions compared(std::move(sessions));
  const auto pairs = ComparePairs(compared);
  std::map<std::string, Table> tables;
  for (Table& table : AllTables(compared, pairs)) tables[table.name] = std::move(table);
  // Every table whose rows are of a set: the name stays, the mark stands behind it.
  for (const char* name : {"success", "times", "quality", "phases", "failures", "meshes"}) {
    const Table& table = tables.at(name);
    ASSERT_EQ(table.columns[2].name, "trained") << name;
    bool any = false;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      const Row texts = Texts(table, row);
      const bool trained = texts[0] == "shelf" && texts[1] == kTagName;
      EXPECT_EQ(texts[2], trained ? "(trained)" : "") << name;
      any = any || trained;
    }
    EXPECT_TRUE(any) << name;
    EXPECT_THAT(table.note, testing::HasSubstr("(trained): has learned")) << name;
  }
  const Table& table = tables.at("pairs");
  ASSERT_EQ(table.columns[3].name, "first_trained");
  ASSERT_EQ(table.columns[4].name, "second_trained");
  const auto names_and_marks = [&](std::size_t row) {
    const Row texts = Texts(table, row);
    return Row(texts.begin(), texts.begin() + 5);
  };
  EXPECT_EQ(names_and_marks(0), (Row{"a<i>set</i>", kTagName, kScriptName, "", ""}));
  EXPECT_EQ(names_and_marks(1), (Row{"shelf", kTagName, kScriptName, "(trained)", ""}));
  EXPECT_EQ(names_and_marks(2), (Row{kAllSets, kTagName, kScriptName, "(trained)", ""}));
  EXPECT_THAT(table.note, testing::HasSubstr("(trained): has learned"));
  const Table& conditions = tables.at("conditions");
  ASSERT_EQ(conditions.columns[2].name, "trained");
  for (std::size_t row = 0; row < conditions.rows.size(); ++row) {
    const Row texts = Texts(conditions, row);
    EXPECT_EQ(texts[2], texts[1] == kTagName ? "(trained on shelf)" : "");
  }
  EXPECT_THAT(conditions.note, testing::HasSubstr("or of those named"));
  for (const Table& unmarked : AllTables(compared_, pairs_)) {
    for (const Column& column : unmarked.columns) {
      EXPECT_EQ(column.name.find("trained"), std::string::npos) << unmarked.name << ": nobody is";
    }
  }

  const std::string caution =
      fmt::format("{} has learned from shelf, on which it is tried here", kTagName);
  EXPECT_TRUE(Cautions(compared).back().starts_with(caution)) << Cautions(compared).back();
  const std::vector<std::string> answer = Answer(compared, pairs);
  EXPECT_TRUE(answer.at(1).starts_with(caution)) << "it ranks first";
  const std::string marked = fmt::format("{} (trained on shelf)", kTagName);
  EXPECT_THAT(answer.front(), testing::HasSubstr(marked));
  EXPECT_THAT(answer.back(), testing::HasSubstr(marked));
  const Json sets = FigureData(compared, pairs, {})["sets"];
  EXPECT_EQ(sets[0]["trained"], Json::array());
  EXPECT_EQ(sets[1]["trained"], Json::array({0}));
  EXPECT_EQ(sets[2]["trained"], Json::array({0})) << "all sets";
}

TEST_F(ReportTest, WhoHasLearnedIsMarkedInChanges) {
  const TemporaryFolder folder;
  std::vector<StoredSession> sessions;
  for (const char* name : {"one", "two"}) {
    SessionMessage session = ExampleSession();
    session.start_utime = static_cast<std::int64_t>(sessions.size()) * 86'400'000'000;
    WriteSession(folder / name, {{.contestant = "A"}, {.contestant = "B"}}, session);
    sessions.push_back(ReadSessions(folder / name).sessions.at(0));
  }
  sessions[1].contestants[0].settings += "learned_from = shelf\n";
  const ComparedSessions compared(std::move(sessions));
  const std::vector<Table> tables = AllTables(compared, ComparePairs(compared));
  const auto changes = std::find_if(tables.begin(), tables.end(),
                                    [](const Table& table) { return table.name == "changes"; });
  ASSERT_NE(changes, tables.end());
  ASSERT_EQ(changes->columns[2].name, "trained");
  ASSERT_EQ(changes->rows.size(), 2u);
  for (std::size_t row = 0; row < 2; ++row) {
    const Row texts = Texts(*changes, row);
    EXPECT_EQ(texts[2], texts[1] == "A" ? "(trained)" : "");
  }
}

TEST_F(ReportTest, TimesOfNothingAreCountedBesideTheRatio) {
  const ComparedSessions compared = Read({{.contestant = "A", .time_s = 0},
                                          {.contestant = "A", .problem = 2},
                                          {.contestant = "B"},
                                          {.contestant = "B", .problem = 2, .time_s = 2}});
  const std::vector<ComparedPair> pairs = ComparePairs(compared);
  EXPECT_THAT(PairTable(pairs).note, testing::HasSubstr("since a time is 0: 1 problem that both"));
  EXPECT_THAT(Answer(compared, pairs).at(1), testing::HasSubstr("1 with a time of 0 left out"));
  EXPECT_EQ(PairTable(pairs_).note.find("time is 0"), std::string::npos);
  EXPECT_EQ(FigureData(compared, {}, {})["sets"][0]["problem_times"][0]["time"], (Json{0, 1000}));
}

TEST_F(ReportTest, ARatioTellsOnHowManyProblemsItRests) {
  const ComparedSessions compared =
      Read({{.contestant = "A", .trial = 1, .status = PlanStatus::kTimedOut},
            {.contestant = "A", .trial = 2},
            {.contestant = "A", .problem = 2},
            {.contestant = "B", .time_s = 20},
            {.contestant = "B", .problem = 2, .time_s = 20}});
  const std::vector<ComparedPair> pairs = ComparePairs(compared);
  const Table times = TimeTable(compared), table = PairTable(pairs);
  EXPECT_EQ(times.rows.size(), 2u);
  for (std::size_t i = 0; i < times.rows.size(); ++i) EXPECT_EQ(Texts(times, i)[2], "2");
  ASSERT_EQ(table.columns[7].name, "problems_in_ratio");
  EXPECT_EQ(Texts(table, 0)[7], "1") << "half of A's trials at the first problem are no median";
  EXPECT_THAT(times.note, testing::HasSubstr("in one trial at least"));
  EXPECT_THAT(table.note, testing::HasSubstr("in the median, if more than half of its trials"));
  EXPECT_THAT(Answer(compared, pairs).at(1),
              testing::HasSubstr("on the 1 problem that both solved in the median"));
}

TEST_F(ReportTest, FiguresNameTrialsAsTheyAre) {
  const ComparedSessions compared =
      Read({{.contestant = "A", .trial = 3}, {.contestant = "A", .problem = 2, .trial = 2}});
  const Json json = FigureData(compared, {}, {});
  EXPECT_EQ(json["sets"][0]["times"][0]["trial"], (Json{3, 2}));
}

TEST_F(ReportTest, FiguresHaveEveryRunAndEveryProblem) {
  const Json json = FigureData(compared_, pairs_, AllTables(compared_, pairs_));
  EXPECT_EQ(json["attempts"]["run"].size(), 48u);
  ASSERT_EQ(json["sets"].size(), 3u);
  EXPECT_EQ(json["sets"][1]["times"][0]["time"].size(), 24u);
  EXPECT_EQ(json["sets"][1]["times"][0]["time"][0], 1100);
  EXPECT_EQ(json["sets"][1]["times"][1]["time"][11], nullptr);  // failed
  EXPECT_EQ(json["sets"][1]["problem_times"][1]["problem"].size(), 12u);
  EXPECT_EQ(json["sets"][1]["survival"][1]["share"].back(), 0.833333);
  EXPECT_EQ(json["sets"][1]["profile"][0]["share"], Json::array({1.0}));
  EXPECT_EQ(json["sets"][1]["phases"][0]["shares"], Json::array({0.125, 0.5, 0.25, 0.125}));
  EXPECT_TRUE(json["sets"][2]["all"]);
}

TEST_F(ReportTest, PhasesThatAreNotToldAreNone) {
  const TemporaryFolder folder;
  WriteSession(folder / "example", {{.contestant = "A"}, {.contestant = "B"}}, ExampleSession());
  std::vector<StoredSession> sessions = ReadSessions(folder / "example").sessions;
  for (StoredRun& run : sessions[0].runs) {
    if (sessions[0].contestants[run.contestant].name == "B") run.phases = {};
  }
  const ComparedSessions compared(std::move(sessions));
  const Table table = PhaseTable(compared);
  ASSERT_EQ(table.rows.size(), 2u);
  for (std::size_t row = 0; row < 2; ++row) {
    const Row texts = Texts(table, row);
    const Row phases(texts.begin() + 3, texts.end());
    EXPECT_EQ(phases, texts[1] == "B"
                          ? Row(5, "-")
                          : (Row{FormatNumber(125), FormatNumber(500), FormatNumber(250),
                                 FormatNumber(125), FormatNumber(250)}));
  }
  const Json phases = FigureData(compared, {}, {})["sets"][0]["phases"];
  ASSERT_EQ(phases.size(), 1u);
  EXPECT_EQ(phases[0]["problems"], 1);
}

TEST_F(ReportTest, MeshVerdictsNameTheCommonestContact) {
  const auto run = [](int problem, bool valid, const std::string& reason, double depth_m = 0) {
    return MadeRun{.contestant = "A",
                   .problem = problem,
                   .time_s = 0.25,
                   .mesh_valid = valid,
                   .mesh_reason = reason,
                   .mesh_depth_m = depth_m};
  };
  MadeRun again = run(1, true, "");  // no case of its own
  again.trial = 2;
  const ComparedSessions compared =
      Read({run(1, true, ""),
            again,
            run(2, false, "segment 1: 'arm' and 'shelf', 0.001 m deep", 0.001),
            run(3, false, "segment 7: 'arm' and 'shelf' in contact"),
            run(4, false, "segment 2: 'hand' and 'box', 0.002 m deep", 0.002),
            {.contestant = "A", .problem = 5, .status = PlanStatus::kInvalidPath},
            {.contestant = "A", .problem = 6, .mesh_valid_simplified = true},
            {.contestant = "A", .problem = 7, .mesh_valid_simplified = false},
            {.contestant = "B", .problem = 1}});
  const Table table = MeshTable(compared);
  ASSERT_EQ(table.rows.size(), 1u);
  const Row row = Texts(table, 0);
  const Interval wilson = WilsonInterval(1, 4);
  EXPECT_EQ(row, (Row{"shelf", "A", "8", "7", "5", "2",
                      fmt::format("25.0 [{:.1f}, {:.1f}]", 100 * wilson.lower, 100 * wilson.upper),
                      "2", "1", "1.50", "250", "'arm' and 'shelf' (2)"}));
}

TEST_F(ReportTest, ImprovementsAreFiguresOfTheirOwn) {
  const ComparedSessions compared = Read(
      {{.contestant = "A", .progress = {{0.1, 4, 30, 1}, {1, 2, 15, 2}}}, {.contestant = "B"}});
  const Json json = FigureData(compared, {}, {});
  ASSERT_EQ(json["sets"][0]["anytime_cost"].size(), 1u);
  EXPECT_EQ(json["sets"][0]["anytime_cost"][0]["median"].front(), 2);
  EXPECT_EQ(json["sets"][0]["anytime_cost"][0]["median"].back(), 1);
  EXPECT_EQ(json["sets"][0]["anytime_bound"][0]["upper"].back(), 2);
  EXPECT_EQ(json["sets"][0]["anytime_cost"][0]["time"].back(), 1000);
  EXPECT_EQ(json["sets"][0]["anytime_cost"][0]["limit"], 10'000);
  EXPECT_EQ(json["sets"][0]["anytime_cost"][0]["own_costs"], true) << "no length of a path";
}

TEST_F(ReportTest, CostsThatAreLengthsAreOverTheShortestOfAnybody) {
  const ComparedSessions compared = Read(
      {{.contestant = "A", .length = 12, .progress = {{0.1, 0, 30, 1}, {1, 0, 12, 2}}},
       {.contestant = "B", .time_s = 2, .length = 6, .progress = {{0.1, 0, 9, 1}, {2, 0, 6, 2}}},
       {.contestant = "C", .time_s = 3, .progress = {{0.1, 0, 3, 1}, {3, 0, 1, 2}}}});
  const Json json = FigureData(compared, {}, {})["sets"][0]["anytime_cost"];
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[0]["median"].back(), 2);
  EXPECT_EQ(json[0]["own_costs"], false);
  EXPECT_EQ(json[1]["median"].front(), 1.5);
  EXPECT_EQ(json[2]["median"].front(), 3);
  EXPECT_EQ(json[2]["own_costs"], true);
}

TEST_F(ReportTest, ChangesBetweenSessionsAreToldWithTheirUncertainty) {
  const TemporaryFolder folder;
  std::vector<MadeRun> before, after;
  for (int problem = 1; problem <= 8; ++problem) {
    before.push_back({.contestant = "A", .problem = problem, .time_s = 1 + problem / 10.0});
    before.push_back({.contestant = "B", .problem = problem, .time_s = 1});
    after.push_back({.contestant = "A", .problem = problem, .time_s = 2 + problem / 5.0});
    after.push_back({.contestant = "B", .problem = problem, .time_s = problem % 2 == 0 ? 0.5 : 2});
  }
  SessionMessage later = ExampleSession();
  later.start_utime = 60'000'000;
  WriteSession(folder / "new", after, later);
  WriteSession(folder / "old", before, ExampleSession());
  std::vector<StoredSession> sessions = ReadSessions(folder / "new").sessions;
  sessions.push_back(ReadSessions(folder / "old").sessions.front());
  const Table table = ChangeTable(ComparedSessions(std::move(sessions)));
  ASSERT_EQ(table.rows.size(), 2u);
  const Row slower = Texts(table, 0);
  EXPECT_EQ(slower[1], "A");
  EXPECT_EQ(slower[2], "old");
  EXPECT_EQ(slower[3], "new");
  EXPECT_EQ(slower[4], "slower") << "in sight, however long names are";
  EXPECT_EQ(slower[8], "8");
  EXPECT_EQ(slower[9], "2.00 [2.00, 2.00]");
  EXPECT_EQ(slower[10], FormatCell(2 * 2 / 256.0, Style::kPValue));  // 2 / 2^8, of two tests
  EXPECT_EQ(Texts(table, 1)[4], "not shown");
  EXPECT_TRUE(ChangeTable(compared_).rows.empty());
}

TEST_F(ReportTest, ChangesAreOfTheProblemsThatBothSessionsHave) {
  // The one has the problems 1 to 9, of which it fails at the first two, the other 3 to 12, of
  // which it fails at 9 to 12: both solve 3 to 8.
  const TemporaryFolder folder;
  std::vector<StoredSession> sessions;
  for (const int first : {1, 3}) {
    std::vector<MadeRun> runs;
    for (int problem = first; problem <= (first == 1 ? 9 : 12); ++problem) {
      const bool fails = first == 1 ? problem < 3 : problem >= 9;
      runs.push_back({.contestant = "A",
                      .problem = problem,
                      .status = fails ? PlanStatus::kTimedOut : PlanStatus::kSolved});
    }
    SessionMessage session = ExampleSession();
    session.start_utime = first * 60'000'000;
    const std::string name = fmt::format("from{}", first);
    WriteSession(folder / name, runs, session);
    sessions.push_back(ReadSessions(folder / name).sessions.front());
  }
  const Table table = ChangeTable(ComparedSessions(std::move(sessions)));
  ASSERT_EQ(table.rows.size(), 1u);
  const auto share = [](int confirmed) {
    return FormatCell(Percent(confirmed / 7.0, WilsonInterval(confirmed, 7)), Style::kShare);
  };
  const Row row = Texts(table, 0);
  EXPECT_EQ(Row(row.begin() + 5, row.begin() + 9), (Row{"7", share(7), share(6), "6"}));
}

TEST_F(ReportTest, ChangesOfAContestantStandTogetherInTheOrderOfItsSessions) {
  const TemporaryFolder folder;
  std::vector<StoredSession> sessions;
  for (const double time_s : {1.0, 4.0, 2.0}) {
    SessionMessage session = ExampleSession();
    session.start_utime = static_cast<std::int64_t>(sessions.size()) * 60'000'000;
    const std::string name = fmt::format("session{}", sessions.size());
    WriteSession(
        folder / name,
        {{.contestant = "A", .time_s = time_s}, {.contestant = "B", .time_s = time_s + 0.5}},
        session);
    sessions.push_back(ReadSessions(folder / name).sessions.front());
  }
  const Table table = ChangeTable(ComparedSessions(std::move(sessions)));
  std::vector<Row> rows;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    rows.push_back({Texts(table, i)[1], Texts(table, i)[3]});
  }
  EXPECT_EQ(rows, (std::vector<Row>{
                      {"A", "session1"}, {"A", "session2"}, {"B", "session1"}, {"B", "session2"}}));
}

TEST_F(ReportTest, SeveralSessionsAreListedWhereTheyDiffer) {
  const TemporaryFolder folder;
  const auto run_with = [](const std::string& step) {
    return MadeRun{.contestant = "A", .settings = {{"range", "1"}, {"step", step}}};
  };
  WriteSession(folder / "one", {run_with("10")}, ExampleSession());
  SessionMessage other = ExampleSession();
  other.commit = "def456";
  other.settings["time"] = "20";
  other.settings["trials"] += ".0";  // the same number
  WriteSession(folder / "two", {run_with("10.0")}, other);
  std::vector<StoredSession> sessions = ReadSessions(folder / "one").sessions;
  sessions.push_back(ReadSessions(folder / "two").sessions.front());
  const ComparedSessions compared(std::move(sessions));
  const Table table = SessionTable(compared, true);
  std::vector<std::string> fields;
  for (std::size_t i = 0; i < table.rows.size(); ++i) fields.push_back(Texts(table, i)[0]);
  EXPECT_EQ(fields, (Row{"session", "version", "commit", "--time"}));
  EXPECT_EQ(Texts(table, 3), (Row{"--time", "10", "20"}));
}

}  // namespace
}  // namespace planbench
