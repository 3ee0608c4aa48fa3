#include "benchmark_driver/tables.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace planbench {
namespace {

using Kind = ProblemOutcome::Kind;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

RunRecordMessage Attempt(PlanStatus status, double planning_time_s,
                         Direction direction = Direction::kForward) {
  RunRecordMessage record;
  record.planner = "ara";
  record.problem_set = "box";
  record.problem_index = 1;
  record.status = status;
  record.request.direction = direction;
  record.roundtrip_time_s = planning_time_s + 0.001;
  record.result.result.planning_time_s = record.result.result.total_time_s = planning_time_s;
  return record;
}

RunRecordMessage Backward(PlanStatus status, double planning_time_s) {
  return Attempt(status, planning_time_s, Direction::kBackward);
}

RunRecordMessage OfProblem(int index, RunRecordMessage record) {
  record.problem_index = index;
  return record;
}

RunRecordMessage OfPlanner(const std::string& planner, RunRecordMessage record) {
  record.planner = planner;
  return record;
}

/// The lines of the table of that title, words joined by single blanks: header, rule, rows, notes.
std::vector<std::string> Table(const std::string& text, const std::string& title) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  bool inside = false;
  for (std::string line; std::getline(stream, line);) {
    if (line == title) {
      inside = true;
    } else if (inside && line.empty()) {
      break;
    } else if (inside) {
      std::istringstream words(line);
      std::string joined;
      for (std::string word; words >> word;) joined += (joined.empty() ? "" : " ") + word;
      lines.push_back(joined);
    }
  }
  return lines;
}

/// A row of a table by its beginning; "" if there is none.
std::string Row(const std::vector<RunRecordMessage>& records, const std::string& title,
                const std::string& beginning) {
  for (const std::string& line : Table(FormatTables(records), title)) {
    if (line.rfind(beginning + " ", 0) == 0) return line.substr(beginning.size() + 1);
  }
  return "";
}

constexpr char kSuccess[] = "Success";
constexpr char kTimes[] = "Planning time of the solved, ms";
constexpr char kEffort[] = "Effort and quality over the solved runs, medians";
constexpr char kMeshes[] = "Paths judged with the robot's meshes";

TEST(FoldAttemptsTest, ForwardSuccessCountsFirst) {
  const auto forward = Attempt(PlanStatus::kSolved, 0.5);
  const auto backward = Backward(PlanStatus::kSolved, 0.25);
  const ProblemOutcome outcome = FoldAttempts(&forward, &backward);
  EXPECT_EQ(outcome.kind, Kind::kForward);
  EXPECT_TRUE(outcome.solved_forward);
  EXPECT_TRUE(outcome.solved_backward);
  EXPECT_EQ(outcome.forward_time_s, 0.5);
  EXPECT_EQ(outcome.backward_time_s, 0.25);
  EXPECT_EQ(outcome.either_time_s, 0.5);
}

TEST(FoldAttemptsTest, BackwardSuccessBearsTheTimeOfTheFailedForwardAttempt) {
  const auto forward = Attempt(PlanStatus::kTimedOut, 60);
  const auto backward = Backward(PlanStatus::kSolved, 0.25);
  const ProblemOutcome outcome = FoldAttempts(&forward, &backward);
  EXPECT_EQ(outcome.kind, Kind::kBackward);
  EXPECT_FALSE(outcome.solved_forward);
  EXPECT_EQ(outcome.either_time_s, 60.25);
}

TEST(FoldAttemptsTest, AttemptWithoutAnswerTookAsLongAsItWasWaitedFor) {
  auto forward = Attempt(PlanStatus::kNoAnswer, 0);
  forward.roundtrip_time_s = 5;
  const auto backward = Backward(PlanStatus::kSolved, 0.25);
  EXPECT_EQ(FoldAttempts(&forward, &backward).either_time_s, 5.25);
}

TEST(FoldAttemptsTest, OneDirectionMayBeMissing) {
  const auto forward = Attempt(PlanStatus::kSolved, 0.5);
  EXPECT_EQ(FoldAttempts(&forward, nullptr).kind, Kind::kForward);
  EXPECT_EQ(FoldAttempts(&forward, nullptr).either_time_s, 0.5);
  const auto backward = Backward(PlanStatus::kSolved, 0.25);
  EXPECT_EQ(FoldAttempts(nullptr, &backward).kind, Kind::kBackward);
  EXPECT_EQ(FoldAttempts(nullptr, &backward).either_time_s, 0.25);
}

TEST(FoldAttemptsTest, FailuresAreToldApart) {
  struct Case {
    PlanStatus forward;
    PlanStatus backward;
    Kind kind;
  };
  using enum PlanStatus;
  for (const Case& c : std::vector<Case>{{kTimedOut, kTimedOut, Kind::kFailure},
                                         {kExhausted, kTimedOut, Kind::kFailure},
                                         {kTimedOut, kMemoryLimit, Kind::kFailure},
                                         {kStartInvalid, kStartInvalid, Kind::kUnsolvable},
                                         {kGoalInvalid, kTimedOut, Kind::kUnsolvable},
                                         {kNoAnswer, kGoalInvalid, Kind::kUnsolvable},
                                         {kGoalInvalid, kSolved, Kind::kBackward},
                                         {kTimedOut, kInvalidPath, Kind::kOther},
                                         {kNoAnswer, kTimedOut, Kind::kOther},
                                         {kCancelled, kExhausted, Kind::kOther},
                                         {kInvalidRequest, kInvalidRequest, Kind::kOther}}) {
    const auto forward = Attempt(c.forward, 1);
    const auto backward = Backward(c.backward, 1);
    EXPECT_EQ(FoldAttempts(&forward, &backward).kind, c.kind)
        << EnumName(c.forward) << " " << EnumName(c.backward);
  }
}

/// Four problems of which ARA* solves the first forward, the second backward, the third not; the
/// fourth's goal is in collision. RRT-Connect solves the first.
std::vector<RunRecordMessage> Session() {
  return {
      OfProblem(1, Attempt(PlanStatus::kSolved, 0.1)),
      OfProblem(1, Backward(PlanStatus::kSolved, 0.02)),
      OfProblem(2, Attempt(PlanStatus::kTimedOut, 60)),
      OfProblem(2, Backward(PlanStatus::kSolved, 0.04)),
      OfProblem(3, Attempt(PlanStatus::kTimedOut, 60)),
      OfProblem(3, Backward(PlanStatus::kExhausted, 2)),
      OfProblem(4, Attempt(PlanStatus::kGoalInvalid, 0)),
      OfProblem(4, Backward(PlanStatus::kGoalInvalid, 0)),
      OfProblem(1, OfPlanner("rrtc", Attempt(PlanStatus::kSolved, 0.0051234))),
      OfProblem(2, OfPlanner("rrtc", Attempt(PlanStatus::kInvalidPath, 0.2))),
  };
}

TEST(TablesTest, SuccessCountsProblemsAsTheStudyDoes) {
  const auto session = Session();
  EXPECT_EQ(Table(FormatTables(session), kSuccess).at(0),
            "set planner problems forward backward failure unsolvable other backward alone");
  EXPECT_EQ(Row(session, kSuccess, "box ara"), "4 1 1 1 1 0 2");
  EXPECT_EQ(Row(session, kSuccess, "box rrtc"), "2 1 - 0 0 1 -");  // no backward attempts made
}

TEST(TablesTest, TimesAreOfTheSolvedInMilliseconds) {
  const auto session = Session();
  EXPECT_EQ(Table(FormatTables(session), kTimes).at(0),
            "set planner direction solved median mean 25 % 75 % 95 %");
  EXPECT_EQ(Row(session, kTimes, "box ara forward"), "1 100.0 100.0 100.0 100.0 100.0");
  EXPECT_EQ(Row(session, kTimes, "box ara backward"), "2 30.0 30.0 25.0 35.0 39.0");
  // 0.1 s, and 60 s of failure before 0.04 s.
  EXPECT_EQ(Row(session, kTimes, "box ara either"), "2 30070 30070 15085 45055 57043");
  EXPECT_EQ(Row(session, kTimes, "box rrtc forward"), "1 5.123 5.123 5.123 5.123 5.123");
  EXPECT_EQ(Row(session, kTimes, "box rrtc either"), "");
}

TEST(TablesTest, NothingSolvedIsNoTime) {
  const std::vector<RunRecordMessage> records = {Attempt(PlanStatus::kTimedOut, 60)};
  EXPECT_EQ(Row(records, kTimes, "box ara forward"), "0 - - - - -");
  EXPECT_THAT(Row(records, kEffort, "box ara"), testing::MatchesRegex("-( -)*"));
}

TEST(TablesTest, TrialsCountApart) {
  std::vector<RunRecordMessage> records;
  for (int trial = 1; trial <= 3; ++trial) {
    records.push_back(Attempt(trial == 3 ? PlanStatus::kTimedOut : PlanStatus::kSolved, trial));
    records.back().trial = trial;
  }
  EXPECT_EQ(Row(records, kSuccess, "box ara"), "3 2 - 1 0 0 -");
}

TEST(TablesTest, OrderOfRecordsDoesNotMatter) {
  auto session = Session();
  const std::string text = FormatTables(session);
  std::reverse(session.begin(), session.end());
  EXPECT_EQ(FormatTables(session), text);
}

PathVerdict Valid(MeasuredValues measures) {
  PathVerdict verdict;
  verdict.valid = true;
  verdict.measures = std::move(measures);
  return verdict;
}

TEST(TablesTest, EffortIsTheMedianOfTheSolved) {
  std::vector<RunRecordMessage> records;
  for (int i = 1; i <= 3; ++i) {
    RunRecordMessage record = OfProblem(i, Attempt(PlanStatus::kSolved, 0.1 * i));
    PlanResult& result = record.result.result;
    result.phases.collision_s = 0.08 * i;
    result.phases.simplification_s = 0.02 * i;
    result.counters = {{"edges_checked", 10 * i}, {"configurations_checked", 1000 * i}};
    record.roundtrip_time_s = 0.12 * i + 0.0005;
    records.push_back(record);
  }
  RunRecordMessage failed = OfProblem(4, Attempt(PlanStatus::kTimedOut, 60));
  failed.result.result.counters = {{"edges_checked", 1e9}};
  records.push_back(failed);
  EXPECT_THAT(Table(FormatTables(records), kEffort).at(0),
              StartsWith("set planner bus ms simplify ms checking % edges configurations "));
  EXPECT_THAT(Row(records, kEffort, "box ara"), StartsWith("0.500 40.0 80 20 2000 "));
  EXPECT_THAT(FormatTables(records), Not(HasSubstr(kMeshes)));
}

TEST(TablesTest, MeasuresAreShownAsTheyDescribeThemselves) {
  // Of problem i the m-th measure is m i, half as much on the simplified path.
  std::vector<RunRecordMessage> records;
  for (int i = 1; i <= 3; ++i) {
    RunRecordMessage record = OfProblem(i, Attempt(PlanStatus::kSolved, 1));
    record.path_check.verdict = record.simplified_check.verdict = Valid({});
    double m = 0;
    for (const PathMeasure& measure : PathMeasures()) {
      m += 1;
      record.path_check.verdict->measures[measure.name] = m * i / measure.column.scale;
      record.simplified_check.verdict->measures[measure.name] = m * i / 2 / measure.column.scale;
    }
    records.push_back(record);
  }
  std::string header;
  std::string medians;
  double m = 0;
  for (const PathMeasure& measure : PathMeasures()) {
    m += 1;
    const auto add = [&](const char* heading, double median) {
      if (heading == nullptr) return;
      header += fmt::format(" {}", heading);
      medians += fmt::format(" {:.{}f}", median, measure.column.decimals);
    };
    add(measure.column.heading, 2 * m);
    add(measure.column.heading_simplified, m);
  }
  EXPECT_THAT(Table(FormatTables(records), kEffort).at(0), EndsWith("configurations" + header));
  EXPECT_THAT(Row(records, kEffort, "box ara"), EndsWith(medians));
}

TEST(TablesTest, MeasuresMayBeInfiniteOrNotTaken) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // The medians of three problems whose measures all have that value; NaN: not taken.
  const auto medians = [](std::initializer_list<double> values) {
    std::vector<RunRecordMessage> records;
    for (const double value : values) {
      const int index = static_cast<int>(records.size());
      records.push_back(OfProblem(index, Attempt(PlanStatus::kSolved, 1)));
      if (std::isnan(value)) continue;
      records.back().path_check.verdict = records.back().simplified_check.verdict = Valid({});
      for (const PathMeasure& measure : PathMeasures()) {
        records.back().path_check.verdict->measures[measure.name] = value;
        records.back().simplified_check.verdict->measures[measure.name] = value;
      }
    }
    return Row(records, kEffort, "box ara");
  };
  EXPECT_THAT(medians({kInfinity, kInfinity, NAN}), EndsWith(" inf inf"));
  EXPECT_THAT(medians({0, 0, kInfinity}), testing::ContainsRegex(" 0[.]0+$"));
  EXPECT_THAT(medians({NAN, NAN}), EndsWith(" - -"));
}

TEST(TablesTest, MeshVerdictsAreShownIfThereAreAny) {
  std::vector<RunRecordMessage> records;
  for (int i = 1; i <= 3; ++i) {
    records.push_back(OfProblem(i, Attempt(PlanStatus::kSolved, 1)));
    records.back().path_check.mesh_verdict = Valid({});
    records.back().path_check.mesh_verdict->valid = i == 1;
  }
  records[0].simplified_check.mesh_verdict = Valid({});
  // A path that the referee rejects on the planners' own model counts for nothing.
  records.push_back(OfProblem(4, Attempt(PlanStatus::kInvalidPath, 1)));
  records.back().path_check.mesh_verdict = Valid({});
  EXPECT_EQ(Row(records, kMeshes, "box ara"), "3 1 1 1");
}

TEST(TablesTest, PrintedText) {
  const std::string text = FormatTables(Session());
  const std::string header =
      "  set  planner  problems  forward  backward  failure  unsolvable  other  backward alone\n";
  const std::string rule = "  " + std::string(header.size() - 3, '-') + "\n";
  EXPECT_THAT(
      text,
      HasSubstr(
          "Success\n" + header + rule +
          "  box  ara             4        1         1        1           1      0               "
          "2\n"
          "  box  rrtc            2        1         -        0           0      1               "
          "-\n"));
  EXPECT_THAT(text, HasSubstr("with the time of the failed attempt.\n\nEffort"));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 120u) << line;
    EXPECT_TRUE(line.empty() || line.back() != ' ') << line;
  }
}

/// As a session of the study's: two planners on one of its sets, on one of ours, and a planner that
/// the study has not.
std::vector<RunRecordMessage> StudySession(const std::string& set) {
  std::vector<RunRecordMessage> session;
  for (const auto& [planner, algorithm] : std::vector<std::pair<std::string, std::string>>{
           {"ara", "ARA*"}, {"ara_2", "ARA*"}, {"mine", "PRM"}, {"rrtc", "RRT-Connect"}}) {
    for (const std::string& problem_set : {set, std::string("box")}) {
      session.push_back(OfPlanner(planner, Attempt(PlanStatus::kSolved, 0.1)));
      session.back().problem_set = problem_set;
      session.back().algorithm = algorithm;
    }
  }
  return session;
}

TEST(TablesTest, PublishedFiguresStandBelowTheStudysSets) {
  const auto session = StudySession("shelf_height_rot_test");
  EXPECT_EQ(Row(session, kSuccess, "shelf_height_rot_test published ARA*"), "100 43 43 6 8 - -");
  EXPECT_EQ(Row(session, kSuccess, "shelf_height_rot_test published RRT-Connect"),
            "100 76 - 24 - - -");
  EXPECT_EQ(Row(session, kTimes, "shelf_height_rot_test published ARA*"),
            "solving one 86 ~170.0 - - - -");
  EXPECT_EQ(Row(session, kTimes, "shelf_height_rot_test published RRT-Connect"),
            "forward 76 15000-16000 - - - -");
  for (const char* title : {kSuccess, kTimes}) {
    std::vector<std::string> planners;
    for (const std::string& line : Table(FormatTables(session), title)) {
      if (line.rfind("shelf_height_rot_test ", 0) != 0) continue;
      planners.push_back(line.substr(22, line.find(' ', 22) - 22));
    }
    EXPECT_THAT(planners,
                testing::ElementsAre("ara", "ara_2", "mine", "rrtc", "published", "published"));
  }
  const std::string text = FormatTables(session);
  EXPECT_THAT(text, Not(HasSubstr("box published")));
  EXPECT_THAT(text, HasSubstr("arXiv 2406.09623"));
  // Tables that have a published row stay within the width of the others.
  std::istringstream lines(text.substr(0, text.find(kEffort)));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
}

TEST(TablesTest, PublishedFiguresAreOfTheAlgorithmsThatRan) {
  auto session = StudySession("shelf_zero_test");
  std::erase_if(session, [](const RunRecordMessage& r) { return r.algorithm == "RRT-Connect"; });
  EXPECT_EQ(Row(session, kSuccess, "shelf_zero_test published ARA*"), "100 47 53 0 0 - -");
  EXPECT_EQ(Row(session, kSuccess, "shelf_zero_test published RRT-Connect"), "");
  std::erase_if(session, [](const RunRecordMessage& r) { return r.algorithm == "ARA*"; });
  EXPECT_THAT(FormatTables(session), Not(HasSubstr("published")));
}

TEST(TablesTest, NoRunsAreSaid) { EXPECT_EQ(FormatTables({}), "No runs.\n"); }

}  // namespace
}  // namespace planbench
