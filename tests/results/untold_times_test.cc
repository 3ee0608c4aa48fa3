#include "results/untold_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::Pair;

/// Of that many runs, told and untold times in ms.
std::vector<AnswerTimes> Runs(std::size_t count, double told_ms, double untold_ms) {
  const AnswerTimes one = {.told_s = told_ms / 1e3, .roundtrip_s = (told_ms + untold_ms) / 1e3};
  return std::vector<AnswerTimes>(count, one);
}

TEST(UntoldTimesTest, MuchMoreThanOthersAndThanIsToldIsTold) {
  EXPECT_THAT(DescribeUntoldTimes({{"A", Runs(3, 1, 300)}, {"B", Runs(3, 5, 1)}}),
              ElementsAre(Pair("A",
                               "A: its answers tell of 1 ms, and 300 ms more passed until "
                               "they came (others: 1 ms): its times may be too short. Medians "
                               "over the confirmed runs, without waiting for a processor.")));
  EXPECT_THAT(DescribeUntoldTimes({{"A", Runs(3, 400, 300)}, {"B", Runs(3, 5, 1)}}), IsEmpty())
      << "little beside what it tells";
  EXPECT_THAT(DescribeUntoldTimes({{"A", Runs(3, 1, 300)}, {"B", Runs(3, 5, 100)}}), IsEmpty())
      << "all load big scenes";
  EXPECT_THAT(DescribeUntoldTimes({{"A", Runs(3, 1, 15)}, {"B", Runs(3, 5, 0)}}), IsEmpty())
      << "a busy machine";
}

TEST(UntoldTimesTest, LongTimesAreInSeconds) {
  EXPECT_THAT(DescribeUntoldTimes({{"A", Runs(3, 999.7, 4712)}, {"B", Runs(3, 1, 1e-2)}}),
              ElementsAre(Pair("A", HasSubstr("tell of 1 s, and 4.71 s more passed until they came "
                                              "(others: 0.01 ms)"))));
}

TEST(UntoldTimesTest, FailedRunsAreComparedWithFailedOnes) {
  const auto failed = [](PlanStatus status, double told_ms, double untold_ms) {
    std::vector<AnswerTimes> runs = Runs(3, told_ms, untold_ms);
    for (AnswerTimes& run : runs) run.status = status;
    return runs;
  };
  std::vector<AnswerTimes> a = failed(PlanStatus::kExhausted, 1, 300);
  const std::vector<AnswerTimes> confirmed = Runs(5, 10, 1);
  a.insert(a.end(), confirmed.begin(), confirmed.end());
  EXPECT_THAT(
      DescribeUntoldTimes({{"A", a}, {"B", failed(PlanStatus::kTimedOut, 900, 1)}}),
      ElementsAre(Pair("A",
                       "A: its answers tell of 1 ms, and 300 ms more passed until they came "
                       "(others: 1 ms): its times may be too short. Medians over its failed "
                       "runs but those that timed out, and the failed ones of others, without "
                       "waiting for a processor.")));
  const std::vector<AnswerTimes> honest = failed(PlanStatus::kTimedOut, 900, 1);
  for (int i = 0; i < 2; ++i) a.insert(a.end(), honest.begin(), honest.end());
  EXPECT_THAT(DescribeUntoldTimes({{"A", a}, {"B", honest}}),
              ElementsAre(Pair("A", HasSubstr("300 ms more passed until they came"))))
      << "hidden by those that timed out";
  EXPECT_THAT(DescribeUntoldTimes({{"A", failed(PlanStatus::kNoAnswer, 0, 300)},
                                   {"B", failed(PlanStatus::kInvalidRequest, 0, 300)}}),
              IsEmpty())
      << "they tell of no attempt";
}

TEST(UntoldTimesTest, OneOfTwoOthersDoesNotHideAnother) {
  EXPECT_THAT(
      DescribeUntoldTimes({{"A", Runs(3, 1, 300)}, {"B", Runs(3, 1, 300)}, {"C", Runs(3, 1, 1)}}),
      ElementsAre(Key("A"), Key("B")));
}

TEST(UntoldTimesTest, SingleRunsAndWaitingTellOfNobody) {
  std::vector<AnswerTimes> runs = Runs(3, 1, 1);
  runs[0].roundtrip_s = 5;
  EXPECT_THAT(DescribeUntoldTimes({{"A", runs}, {"B", Runs(3, 1, 1)}}), IsEmpty());
  for (AnswerTimes& run : runs) {
    run.roundtrip_s = 5;
    run.waited_s = 4.99;
  }
  EXPECT_THAT(DescribeUntoldTimes({{"A", runs}, {"B", Runs(3, 1, 1)}}), IsEmpty());
}

TEST(UntoldTimesTest, WithoutOthersItTakesMore) {
  EXPECT_THAT(DescribeUntoldTimes({{"A", Runs(3, 1, 90)}, {"B", {}}}), IsEmpty());
  EXPECT_THAT(DescribeUntoldTimes({{"A", Runs(3, 1, 110)}}),
              ElementsAre(Pair("A", HasSubstr("more passed until they came: its times"))));
}

}  // namespace
}  // namespace planbench
