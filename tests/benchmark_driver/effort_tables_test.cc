#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/numbers.h"
#include "tests/benchmark_driver/example_tables.h"

namespace planbench {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

PathVerdict Valid(MeasuredValues measures) {
  PathVerdict verdict;
  verdict.valid = true;
  verdict.measures = std::move(measures);
  return verdict;
}

TEST(EffortTablesTest, EffortThatIsNotToldIsNone) {
  RunRecordMessage record = OfProblem(1, AttemptOf(PlanStatus::kSolved, 0.5));
  record.result.result.phases = {};
  record.result.result.counters.clear();
  record.roundtrip_time_s = 0.501;
  EXPECT_EQ(Row(Full({record}), kEffort, "ARA*"), "1.000 - - - -");
  record.result.result.phases.search_s = 0.5;
  record.result.result.counters = {{"edges_checked", 0}};
  EXPECT_EQ(Row(Full({record}), kEffort, "ARA*"), "1.000 - 0 0 -");
}

TEST(EffortTablesTest, EffortIsTheMedianOfTheSolved) {
  std::vector<RunRecordMessage> records;
  for (int i = 1; i <= 3; ++i) {
    RunRecordMessage record = OfProblem(i, AttemptOf(PlanStatus::kSolved, 0.1 * i));
    PlanResult& result = record.result.result;
    result.phases.collision_s = 0.08 * i;
    result.phases.simplification_s = 0.02 * i;
    result.counters = {{"edges_checked", 10 * i}, {"configurations_checked", 1000 * i}};
    record.roundtrip_time_s = 0.12 * i + 0.0005;
    records.push_back(record);
  }
  RunRecordMessage failed = OfProblem(4, AttemptOf(PlanStatus::kTimedOut, 60));
  failed.result.result.counters = {{"edges_checked", 1e9}};
  records.push_back(failed);
  EXPECT_EQ(Table(Full(records), kEffort).at(0),
            "contestant bus ms simplify ms checking % edges configurations");
  EXPECT_EQ(Row(Full(records), kEffort, "ARA*"), "0.500 40.0 80 20 2000");
  EXPECT_THAT(Full(records), Not(HasSubstr(kMeshes)));
}

TEST(EffortTablesTest, AProblemCountsOnceHoweverManyTrialsItHas) {
  std::vector<RunRecordMessage> records;
  for (int trial = 1; trial <= 4; ++trial) {
    // Problem 1 has the trials 1 to 3.
    records.push_back(OfProblem(trial < 4 ? 1 : 2, AttemptOf(PlanStatus::kSolved, 1)));
    records.back().trial = trial;
    records.back().result.result.counters = {{"edges_checked", trial < 4 ? trial : 10}};
  }
  EXPECT_EQ(Row(Full(records), kEffort, "ARA*"), "1.000 - - 6 -");
  EXPECT_THAT(Full(records), HasSubstr("medians over different problems do not"));
}

TEST(EffortTablesTest, OfBothDirectionsOnlyThePathFromStartToGoalCounts) {
  std::vector<RunRecordMessage> records = {AttemptOf(PlanStatus::kSolved, 1),
                                           Backward(PlanStatus::kSolved, 2)};
  records[0].result.result.counters = {{"edges_checked", 10}};
  records[0].path_check.verdict = Valid({{"path_length", 2}});
  records[0].path_check.mesh_verdict = records[0].path_check.verdict;
  records[1].result.result.counters = {{"edges_checked", 90}};
  records[1].path_check.verdict = Valid({{"path_length", 8}});
  records[1].path_check.mesh_verdict = records[1].simplified_check.verdict = PathVerdict();
  const std::string text = Full(records);
  for (const char* title : {kEffort, kQuality}) {
    EXPECT_EQ(Row(text, title, "ARA*"), Row(Full({records[0]}), title, "ARA*"));
  }
  EXPECT_EQ(Row(text, kMeshes, "box ARA*"), "1 1 0 0");
  EXPECT_THAT(text, Not(HasSubstr("the referee rejected")));
  // The other where there is none.
  records[0].status = PlanStatus::kInvalidPath;
  EXPECT_THAT(Row(Full(records), kEffort, "ARA*"), HasSubstr(" 90 "));
}

TEST(EffortTablesTest, MeasuresAreShownAsTheyDescribeThemselves) {
  // Of problem i the m-th measure is m i, half as much on the simplified path.
  std::vector<RunRecordMessage> records;
  for (int i = 1; i <= 3; ++i) {
    RunRecordMessage record = OfProblem(i, AttemptOf(PlanStatus::kSolved, 1));
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
  EXPECT_EQ(Table(Full(records), kQuality).at(0), "contestant" + header);
  EXPECT_EQ(" " + Row(Full(records), kQuality, "ARA*"), medians);
}

TEST(EffortTablesTest, PathsOfSearchesThatWentOnAfterTheLimitAreLeftOut) {
  std::vector<RunRecordMessage> records;
  for (int i = 1; i <= 2; ++i) {
    records.push_back(OfProblem(i, AttemptOf(PlanStatus::kSolved, 1)));
    records.back().path_check.verdict = Valid({{"path_length", 4 - i}});
  }
  const std::string without = Row(Full({records[0]}), kQuality, "ARA*");
  EXPECT_NE(Row(Full(records), kQuality, "ARA*"), without);
  records[1].result.result.counters[kOverrunTime] = 5;
  EXPECT_EQ(Row(Full(records), kQuality, "ARA*"), without);
  EXPECT_THAT(Full(records), HasSubstr("ARA*: 1 of 2 runs searched on after the time limit"));
}

TEST(EffortTablesTest, RejectedSimplifiedPathsAreLeftOutAndTold) {
  std::vector<RunRecordMessage> records;
  for (int i = 1; i <= 2; ++i) {
    records.push_back(OfProblem(i, AttemptOf(PlanStatus::kSolved, 1)));
    records.back().path_check.verdict = Valid({{"path_length", 4}});
    records.back().simplified_check.verdict = Valid({{"path_length", 3}});
  }
  const std::string row = Row(Full(records), kQuality, "ARA*");
  EXPECT_THAT(Full(records), Not(HasSubstr("rejected 1 of")));
  PathVerdict& verdict = *records[1].simplified_check.verdict;
  verdict.valid = false;
  verdict.measures["path_length"] = 0;
  records[1].simplified_check.mesh_verdict = Valid({});
  EXPECT_EQ(Row(Full(records), kQuality, "ARA*"), row);
  EXPECT_THAT(Brief(records), HasSubstr("ARA*: the referee rejected 1 of 2 simplified paths"));
  EXPECT_FALSE(Rows(records).rows().at(1).mesh_valid_simple.has_value());
}

TEST(EffortTablesTest, MeasuresMayBeInfiniteOrNotTaken) {
  // The medians of three problems whose measures all have that value; NaN: not taken.
  const auto medians = [](std::initializer_list<double> values) {
    std::vector<RunRecordMessage> records;
    for (const double value : values) {
      const int index = static_cast<int>(records.size());
      records.push_back(OfProblem(index, AttemptOf(PlanStatus::kSolved, 1)));
      if (std::isnan(value)) continue;
      records.back().path_check.verdict = records.back().simplified_check.verdict = Valid({});
      for (const PathMeasure& measure : PathMeasures()) {
        records.back().path_check.verdict->measures[measure.name] = value;
        records.back().simplified_check.verdict->measures[measure.name] = value;
      }
    }
    return Row(Full(records), kQuality, "ARA*");
  };
  EXPECT_THAT(medians({kInfinity, kInfinity, NAN}), EndsWith(" inf inf"));
  EXPECT_THAT(medians({0, 0, kInfinity}), testing::ContainsRegex(" 0[.]0+$"));
  EXPECT_THAT(medians({NAN, NAN}), EndsWith(" - -"));
}

TEST(EffortTablesTest, MeshVerdictsAreShownIfThereAreAny) {
  std::vector<RunRecordMessage> records;
  for (int i = 1; i <= 3; ++i) {
    records.push_back(OfProblem(i, AttemptOf(PlanStatus::kSolved, 1)));
    records.back().path_check.mesh_verdict = Valid({});
    records.back().path_check.mesh_verdict->valid = i == 1;
    records.back().path_check.mesh_verdict->reason =
        fmt::format("collision on segment {} at 0.{}: 'arm' and 'post', 0.0{} m deep", i, i, i);
  }
  records[0].simplified_check.mesh_verdict = Valid({});
  // A path that the referee rejects on the planners' own model counts for nothing.
  records.push_back(OfProblem(4, AttemptOf(PlanStatus::kInvalidPath, 1)));
  records.back().path_check.mesh_verdict = Valid({});
  records.push_back(OfProblem(5, AttemptOf(PlanStatus::kSolved, 1)));  // not judged
  EXPECT_EQ(Table(Brief(records), kMeshes).at(0),
            "set contestant judged mesh-valid simplified mesh-valid");
  EXPECT_EQ(Row(Brief(records), kMeshes, "box ARA*"), "3 1 1 1");
  EXPECT_THAT(Brief(records),
              HasSubstr("box, ARA*: 2 not mesh-valid, mostly: collision on segment 2 "
                        "at 0.2"));
  EXPECT_THAT(Brief(records), Not(HasSubstr("Simplified paths pass nearer")));
  records[0].simplified_check.mesh_verdict->valid = false;
  EXPECT_THAT(Brief(records), HasSubstr("Simplified paths pass nearer"));
  EXPECT_THAT(Brief(records), Not(HasSubstr("differs from the planners'")));
  EXPECT_THAT(MakeTables(Conditions(), Rows(records), {}, 0, {}, 0, 0, {}, "it is bent").brief,
              HasSubstr("The mesh robot differs from the planners': it is bent.\n"));
}

}  // namespace
}  // namespace planbench
