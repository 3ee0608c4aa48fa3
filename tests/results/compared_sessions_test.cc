#include "results/compared_sessions.h"

#include <gtest/gtest.h>

#include "results/comparison.h"
#include "results/quality.h"
#include "results/session_plan.h"
#include "results/training.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

StoredRun MakeRun(std::size_t contestant, int problem, double time_s,
                  PlanStatus status = PlanStatus::kSolved) {
  StoredRun run;
  run.contestant = contestant;
  run.problem_set = "shelf";
  run.problem_index = problem;
  run.time_s = time_s;
  run.time_limit_s = 10;
  run.status = status;
  run.claimed = run.confirmed();
  return run;
}

StoredSession Session(const std::string& folder, std::vector<StoredContestant> contestants,
                      std::vector<StoredRun> runs) {
  StoredSession session;
  session.file = "/sessions/" + folder + "/results.sqlite";
  session.run_id = "run of " + folder;
  session.contestants = std::move(contestants);
  session.runs = std::move(runs);
  return session;
}

std::vector<std::string> Names(const ComparedSessions& compared) {
  std::vector<std::string> names;
  for (const ComparedContestant& one : compared.contestants()) names.push_back(one.name);
  return names;
}

TEST(ComparedSessionsTest, ContestantsRankByPenalisedMeanTime) {
  // Slow but always: 5. Fast, but one of two fails: (0.1 + 10 * 10) / 2. Fastest: 1.
  const ComparedSessions compared(
      {Session("one", {{"slow", ""}, {"gambler", ""}, {"fastest", ""}},
               {MakeRun(0, 1, 5), MakeRun(0, 2, 5), MakeRun(1, 1, 0.1),
                MakeRun(1, 2, 10, PlanStatus::kTimedOut), MakeRun(2, 1, 1), MakeRun(2, 2, 1)})});
  EXPECT_EQ(Names(compared), (std::vector<std::string>{"fastest", "slow", "gambler"}));
  EXPECT_EQ(compared.contestants()[0].runs.size(), 2u);
  EXPECT_EQ(compared.outcomes().at("shelf").at("gambler").by_problem.size(), 2u);
  EXPECT_EQ(compared.session_names(), std::vector<std::string>{"one"});
}

TEST(ComparedSessionsTest, EqualsRankAlike) {
  // "sums" has the times of "same" in another order, of which the sum differs by rounding.
  std::vector<StoredRun> runs;
  for (int problem = 1; problem <= 3; ++problem) {
    runs.push_back(MakeRun(0, problem, 5));
    runs.push_back(MakeRun(1, problem, problem / 10.0));
    runs.push_back(MakeRun(2, problem, (4 - problem) / 10.0));
    runs.push_back(MakeRun(3, problem, 9, PlanStatus::kTimedOut));
  }
  ASSERT_NE(0.1 + 0.2 + 0.3, 0.3 + 0.2 + 0.1);
  const auto ranks = [&] {
    std::vector<std::pair<std::string, int>> of_all;
    const ComparedSessions compared(
        {Session("one", {{"slow", ""}, {"same", ""}, {"sums", ""}, {"fails", ""}}, runs)});
    for (const ComparedContestant& one : compared.contestants()) {
      of_all.emplace_back(one.name, one.rank);
    }
    return of_all;
  };
  using Ranks = std::vector<std::pair<std::string, int>>;
  EXPECT_EQ(ranks(), (Ranks{{"same", 1}, {"sums", 1}, {"slow", 3}, {"fails", 4}}));
  for (StoredRun& run : runs) run.time_limit_s = 0;
  runs[8].status = PlanStatus::kTimedOut;  // of "slow"
  EXPECT_EQ(ranks(), (Ranks{{"same", 1}, {"sums", 1}, {"slow", 3}, {"fails", 4}}))
      << "by the share solved";
}

TEST(ComparedSessionsTest, ContestantsRankByTheProblemsThatAllTried) {
  // "easy" is slower on the problem that both tried; the one that it alone tried is easy.
  const ComparedSessions compared(
      {Session("one", {{"easy", ""}, {"fair", ""}, {"absent", ""}},
               {MakeRun(0, 1, 2), MakeRun(0, 2, 0.001), MakeRun(0, 4, 1), MakeRun(1, 1, 1),
                MakeRun(1, 3, 9), MakeRun(1, 4, 1)})});
  EXPECT_EQ(Names(compared), (std::vector<std::string>{"fair", "easy"})) << "who has runs";
  EXPECT_EQ(compared.without_runs(), std::vector<std::string>{"absent"});
  ASSERT_EQ(compared.common().size(), 1u);
  for (const char* name : {"easy", "fair"}) {
    EXPECT_EQ(compared.common().at("shelf").at(name).by_problem.size(), 2u);
    EXPECT_EQ(compared.pooled_common().at(name).by_problem.size(), 2u);
    EXPECT_EQ(compared.pooled().at(name).by_problem.size(), 3u);
  }
}

TEST(ComparedSessionsTest, WithoutACommonProblemNothingIsCommon) {
  const ComparedSessions compared(
      {Session("one", {{"A", ""}, {"B", ""}}, {MakeRun(0, 1, 1), MakeRun(1, 2, 2)})});
  EXPECT_TRUE(compared.common().empty());
  EXPECT_TRUE(compared.pooled_common().empty());
  for (const ComparedContestant& one : compared.contestants()) EXPECT_EQ(one.rank, 0);
  EXPECT_EQ(compared.contestants().size(), 2u);
}

/// A failed attempt with the answer of a planner of that name on the bus.
StoredRun FailedAttempt(std::size_t contestant, int problem, const std::string& planner,
                        Direction direction = Direction::kForward) {
  StoredRun run = MakeRun(contestant, problem, 10, PlanStatus::kTimedOut);
  run.roundtrip_time_s = 10;
  run.direction = direction;
  run.request_id = "id/a/shelf/1/" + planner + "/forward/1";
  return run;
}

/// A call for ten problems of the set.
PlannedCall Asking(const std::vector<PlannedPlanner>& planners) {
  return {{{"shelf", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}}, planners, {}};
}

TEST(AwaitedAttemptsTest, AFailureWhoseOtherDirectionIsMissingIsMissing) {
  StoredRun invalid = FailedAttempt(0, 3, "ara");
  invalid.claimed = true;  // a claimed path is not followed by the other direction
  StoredSession session =
      Session("one", {{"ARA*", ""}, {"RRT-Connect", ""}, {"RRT", ""}},
              {FailedAttempt(0, 1, "ara"), FailedAttempt(0, 1, "ara", Direction::kBackward),
               FailedAttempt(1, 1, "rrtc"), MakeRun(0, 2, 1), invalid, FailedAttempt(0, 5, "ara"),
               FailedAttempt(0, 6, "ara"), FailedAttempt(2, 1, "rrt")});
  using enum Directions;
  session.flags = {{"directions", "auto"},
                   {kPlanSetting, PlanText({Asking({{"rrtc", kForward}, {"ara", kAuto}}),
                                            Asking({{"rrt", kAuto}})})}};
  session.described = true;
  session.num_runs = 11;
  const ComparedSessions compared({session});
  // Backward searches may be put off to the end (--repeat-disturbed): several can be missing.
  EXPECT_EQ(compared.num_awaiting(), std::vector<int>{3});
  EXPECT_EQ(compared.sessions()[0].runs.size(), 5u);
  const auto& tried = compared.outcomes().at("shelf");
  EXPECT_EQ(tried.at("ARA*").by_problem.size(), 3u);
  EXPECT_FALSE(tried.at("ARA*").by_problem.contains(5));
  EXPECT_EQ(tried.at("RRT-Connect").by_problem.size(), 1u);
  EXPECT_EQ(compared.without_runs(), std::vector<std::string>{"RRT"});

  session.finished = true;
  session.num_runs = static_cast<int>(session.runs.size());
  EXPECT_EQ(ComparedSessions({session}).num_awaiting(), std::vector<int>{0}) << "complete";
}

TEST(AwaitedAttemptsTest, DirectionsAreThoseThatTheSessionTellsOfThePlanner) {
  StoredSession session = Session("one", {{"A", ""}}, {FailedAttempt(0, 1, "ara")});
  session.num_runs = 2;
  session.flags["directions"] = "auto";
  using enum Directions;
  const auto num_awaiting = [&](const SessionPlan& plan) {
    session.flags[kPlanSetting] = PlanText(plan);
    return ComparedSessions({session}).num_awaiting().front();
  };
  EXPECT_EQ(ComparedSessions({session}).num_awaiting().front(), 0) << "an earlier version's";
  EXPECT_EQ(num_awaiting({Asking({{"ara", kForward}})}), 0) << "by the line-up, whatever the flag";
  EXPECT_EQ(num_awaiting({Asking({{"my_ara", kAuto}, {"ara", kForward}, {"ara2", kAuto}})}), 0);
  EXPECT_EQ(num_awaiting({Asking({{"rrtc", kForward}, {"ara", kAuto}})}), 1);
  EXPECT_EQ(num_awaiting({Asking({{"ara", kAuto}}), Asking({{"rrtc", kForward}})}), 1)
      << "whatever it was resumed with";
  PlannedCall others = Asking({{"ara", kAuto}});
  others.sets.front().problems = {2, 3};
  EXPECT_EQ(num_awaiting({others}), 0) << "it was asked for other problems";
  EXPECT_EQ(num_awaiting({Asking({{"ara", kBoth}})}), 1);
  session.runs[0].claimed = true;
  EXPECT_EQ(num_awaiting({Asking({{"ara", kAuto}})}), 0);
  EXPECT_EQ(num_awaiting({Asking({{"ara", kBoth}})}), 1);
  session.runs[0].direction = Direction::kBackward;
  EXPECT_EQ(num_awaiting({Asking({{"ara", kBoth}})}), 1) << "the forward one was put off";
  EXPECT_EQ(num_awaiting({Asking({{"ara", kBackward}})}), 0);
  session.flags[kPlanSetting] = "{";
  ExpectInputError([&] { ComparedSessions({session}); }, {"results.sqlite", "the setting plan"});
  session.imported = true;
  EXPECT_EQ(num_awaiting({Asking({{"ara", kBoth}})}), 0);
}

TEST(ComparedSessionsTest, FailuresCountAsTheLongestLimitThatAnybodyHadOnTheProblem) {
  StoredRun short_limit = MakeRun(0, 1, 0.2, PlanStatus::kTimedOut);
  short_limit.time_limit_s = 0.2;
  StoredRun other_problem = MakeRun(1, 2, 7, PlanStatus::kTimedOut);
  other_problem.time_limit_s = 7;
  const ComparedSessions compared(
      {Session("one", {{"hasty", ""}, {"patient", ""}},
               {short_limit, MakeRun(1, 1, 10, PlanStatus::kTimedOut), other_problem})});
  const auto mean = [&](const char* name) {
    return SummarizeTimes(compared.outcomes().at("shelf").at(name)).penalised_mean_s;
  };
  EXPECT_DOUBLE_EQ(mean("hasty"), 100);
  EXPECT_DOUBLE_EQ(mean("patient"), (100 + 70) / 2.0);
}

TEST(ComparedSessionsTest, WithoutLimitsWhoSolvesMoreRanksFirst) {
  std::vector<StoredRun> runs = {MakeRun(0, 1, 0.1),
                                 MakeRun(0, 2, 1, PlanStatus::kTimedOut),
                                 MakeRun(1, 1, 9),
                                 MakeRun(1, 2, 9),
                                 MakeRun(2, 1, 1, PlanStatus::kTimedOut),
                                 MakeRun(2, 2, 1, PlanStatus::kTimedOut)};
  for (StoredRun& run : runs) run.time_limit_s = 0;
  const ComparedSessions compared(
      {Session("one", {{"half", ""}, {"all", ""}, {"none", ""}}, runs)});
  EXPECT_EQ(Names(compared), (std::vector<std::string>{"all", "half", "none"}));
}

TEST(ComparedSessionsTest, SetsOfOneNameWithOtherScenesAreTwo) {
  const auto in_scene = [](int problem, const char* scene) {
    StoredRun run = MakeRun(0, problem, 1);
    run.scene_id = scene;
    return run;
  };
  const ComparedSessions compared(
      {Session("one", {{"A", ""}}, {in_scene(1, "a"), in_scene(2, "b")}),
       Session("more", {{"A", ""}}, {in_scene(2, "b"), in_scene(3, "c")}),
       Session("two", {{"A", ""}}, {in_scene(1, "a"), in_scene(3, "d")}),
       Session("again", {{"A", ""}}, {in_scene(3, "d")}),
       Session("untold", {{"A", ""}}, {in_scene(1, "")})});
  EXPECT_EQ(compared.other_sets(), std::vector<std::string>{"shelf (two)"});
  ASSERT_EQ(compared.outcomes().size(), 2u);
  EXPECT_EQ(compared.outcomes().at("shelf").size(), 3u);
  EXPECT_EQ(compared.outcomes().at("shelf (two)").size(), 2u);
}

TEST(ComparedSessionsTest, NoSetIsCalledAsAllTogether) {
  std::vector<StoredRun> runs = {MakeRun(0, 1, 1), MakeRun(0, 1, 2)};
  runs[1].problem_set = kAllSets;
  const ComparedSessions compared(
      {Session("one", {{"A", ""}}, runs), Session("two", {{"B", ""}}, runs)});
  ASSERT_EQ(compared.outcomes().size(), 2u);
  EXPECT_EQ(compared.outcomes().begin()->first, "all sets (one)");
  EXPECT_EQ(compared.outcomes().begin()->second.size(), 2u) << "the same set in both sessions";
  EXPECT_TRUE(compared.other_sets().empty());
  EXPECT_EQ(
      compared.sessions()[0].warnings,
      std::vector<std::string>{"its set 'all sets' stands as 'all sets (one)', since all sets "
                               "together are called so."});
}

TEST(ComparedSessionsTest, EqualNamesAreToldApartByTheirSessions) {
  const ComparedSessions compared(
      {Session("one", {{"A", ""}, {"B", ""}}, {MakeRun(0, 1, 1), MakeRun(1, 1, 2)}),
       Session("two", {{"A", ""}}, {MakeRun(0, 1, 3)})});
  EXPECT_EQ(Names(compared), (std::vector<std::string>{"A, one", "B", "A, two"}));
  EXPECT_EQ(compared.contestants()[2].session, 1u);
}

TEST(ComparedSessionsTest, EqualNamesWithOtherSettingsAreNumbered) {
  const ComparedSessions compared({Session("one", {{"A", "range = 1"}, {"A", "range = 2"}},
                                           {MakeRun(0, 1, 1), MakeRun(1, 1, 2)})});
  EXPECT_EQ(Names(compared), (std::vector<std::string>{"A #1", "A #2"}));
  EXPECT_EQ(compared.contestants()[1].settings, "range = 2");
}

TEST(ComparedSessionsTest, SessionsOfOneFolderAreToldApart) {
  StoredSession first = Session("one", {}, {});
  StoredSession second = first;
  second.run_id = "other";
  const ComparedSessions compared({first, second, first});
  EXPECT_EQ(compared.session_names(),
            (std::vector<std::string>{"one run of one #1", "one other", "one run of one #3"}));
}

TEST(ComparedSessionsTest, NothingIsCompared) {
  const ComparedSessions compared({});
  EXPECT_TRUE(compared.contestants().empty());
  EXPECT_TRUE(compared.pooled().empty());
}

TEST(GroupFailuresTest, RunsThatEndedAlikeStandTogetherTheMostFirst) {
  StoredRun hit = MakeRun(0, 3, 1, PlanStatus::kInvalidPath);
  hit.message = "hits board";
  const ComparedSessions compared({Session(
      "one", {{"A", ""}},
      {MakeRun(0, 1, 10, PlanStatus::kTimedOut), hit, MakeRun(0, 2, 1),
       MakeRun(0, 4, 10, PlanStatus::kTimedOut), MakeRun(0, 4, 10, PlanStatus::kTimedOut)})});
  const std::vector<FailureGroup> groups = GroupFailures(compared.contestants()[0], "shelf");
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].status, PlanStatus::kTimedOut);
  EXPECT_EQ(groups[0].num_runs, 3);
  EXPECT_EQ(groups[0].problems, (std::map<int, int>{{1, 1}, {4, 2}}));
  EXPECT_EQ(groups[1].reason, "hits board");
  EXPECT_TRUE(GroupFailures(compared.contestants()[0], "other").empty());
}

TEST(GroupFailuresTest, ReasonsThatDifferInFiguresAloneAreOneAsFirstWorded) {
  std::vector<StoredRun> runs;
  for (const char* message : {"CHOMP optimised from 57 guesses, none (0 of 57) free of 'box_1'",
                              "CHOMP optimised from 59 guesses, none (1 of 59) free of 'box_1'",
                              "CHOMP optimised from 59 guesses, none (1 of 59) free of 'box_2'"}) {
    runs.push_back(MakeRun(0, 1, 10, PlanStatus::kTimedOut));
    runs.back().message = message;
  }
  const ComparedSessions compared({Session("one", {{"A", ""}}, runs)});
  const std::vector<FailureGroup> groups = GroupFailures(compared.contestants()[0], "shelf");
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].num_runs, 2);
  EXPECT_EQ(groups[0].reason, runs[0].message);
  EXPECT_EQ(groups[1].reason, runs[2].message);
}

TEST(TrainingTest, IsKnownBySetsWhereScenesAreNotTold) {
  const auto includes = [](const std::string& settings, const std::string& set,
                           const std::string& scene_id = "0123456789abcdef") {
    return Training(ParseSettings(settings)).Includes(set, scene_id);
  };
  const std::string sets = "algorithm = RRT\nlearned_from = a set, b\nrange = 1\n";
  EXPECT_TRUE(includes(sets, "a set"));
  EXPECT_TRUE(includes(sets, "b"));
  EXPECT_FALSE(includes(sets, "set"));
  EXPECT_TRUE(includes("first_path_learned_from = c\n", "c"));
  EXPECT_TRUE(includes("learned_from = b\nfirst_path_learned_from = c\n", "c"));
  EXPECT_FALSE(includes("imported from learned_from.csv\n", "b"));
  EXPECT_FALSE(includes("", ""));

  const std::string scenes = "learned_from = b\nlearned_scenes = 76543210 01234567\n";
  EXPECT_TRUE(includes(scenes, "a copy of b"));
  EXPECT_FALSE(includes(scenes, "b", "abcdef0123456789")) << "another set of that name";
  EXPECT_TRUE(includes(scenes, "b", "")) << "of which no scene is known";
  EXPECT_TRUE(includes(scenes + "first_path_learned_from = d\n", "d", "abcdef0123456789"));
  EXPECT_TRUE(includes("first_path_learned_scenes = 01234567\n", "d"));
}

TEST(TrainingTest, APartOfTheSetIsEnough) {
  StoredRun first = MakeRun(0, 1, 1);
  first.scene_id = "0123456789abcdef";
  StoredRun second = MakeRun(0, 2, 1);
  second.scene_id = "abcdef0123456789";
  const ComparedSessions compared({Session(
      "one", {{"A", "learned_from = old\nlearned_scenes = abcdef01\n"}}, {first, second})});
  EXPECT_TRUE(compared.contestants()[0].IsTrainedOn("shelf"));
  EXPECT_FALSE(compared.contestants()[0].IsTrainedOn("old"));
}

TEST(PoolSetsTest, ProblemsOfEverySetStayApartAndPaired) {
  const auto attempt = [](const char* set, int problem, const char* contestant, double time_s) {
    return Attempt{set,
                   problem,
                   contestant,
                   1,
                   Direction::kForward,
                   PlanStatus::kSolved,
                   true,
                   time_s,
                   set[0] == 'a' ? 10.0 : 20.0};
  };
  const auto pooled = PoolSets(GroupOutcomes({attempt("a", 5, "A", 1), attempt("b", 5, "A", 2),
                                              attempt("a", 6, "B", 3), attempt("b", 5, "B", 4)}));
  EXPECT_EQ(pooled.at("A").time_limit_s, 20);
  ASSERT_EQ(pooled.at("A").by_problem.size(), 2u);
  ASSERT_EQ(pooled.at("B").by_problem.size(), 2u);
  EXPECT_EQ(pooled.at("A").by_problem.at(0)[0].time_s, 1);
  EXPECT_EQ(pooled.at("B").by_problem.at(1)[0].time_s, 3);
  EXPECT_EQ(pooled.at("A").by_problem.at(2)[0].time_s, 2);
  EXPECT_EQ(pooled.at("B").by_problem.at(2)[0].time_s, 4);
}

TEST(QualityTest, EveryProblemCountsOnceByItsMedian) {
  const Summary s = SummarizeByProblem({{1, {1, 2, 30}}, {2, {4, 6}}, {3, {8}}});
  EXPECT_EQ(s.count, 3);
  EXPECT_EQ(s.median, 5);  // of 2, 5, 8
  EXPECT_EQ(s.mean, 5);
}

TEST(QualityTest, RatiosAreOfCommonProblems) {
  const ValuesByProblem first = {{1, {2}}, {2, {8}}, {3, {100}}};
  const ValuesByProblem second = {{1, {1}}, {2, {1}}, {4, {1}}};
  EXPECT_NEAR(CompareByProblem(first, second)->mean, 4, 1e-12);  // sqrt(2 * 8)
  EXPECT_FALSE(CompareByProblem(first, {{9, {1}}}));
  EXPECT_FALSE(CompareByProblem(first, {{1, {0}}}));
  // A straight path's smoothness is 0, which has no ratio: the others have.
  const auto without_straight = CompareByProblem(first, {{1, {0}}, {2, {2}}, {3, {25}}});
  EXPECT_NEAR(without_straight->mean, 4, 1e-12);
  EXPECT_EQ(without_straight->num_pairs, 2);
}

TEST(QualityTest, MeasuresAreOfConfirmedRuns) {
  StoredRun solved = MakeRun(0, 1, 1);
  solved.measures["path_length"] = 3;
  solved.measures_simple["path_length"] = 2;
  StoredRun rejected = MakeRun(0, 1, 1, PlanStatus::kInvalidPath);
  rejected.measures["path_length"] = 100;
  StoredRun searched_on = MakeRun(0, 2, 1);
  searched_on.measures = searched_on.measures_simple = {{"path_length", 1}};
  for (std::size_t i = 0; i < kNumOddTimes; ++i) {
    searched_on.odd_times_s[i] = kOddTimes[i].counter == std::string(kOverrunTime) ? 5 : 0;
  }
  StoredRun untold = MakeRun(0, 3, 1);
  untold.measures["path_length"] = 7;
  untold.odd_times_s = searched_on.odd_times_s;
  for (double& odd_s : untold.odd_times_s) odd_s = 5 - odd_s;
  const ComparedSessions compared(
      {Session("one", {{"A", ""}}, {solved, rejected, searched_on, untold})});
  const ComparedContestant& one = compared.contestants()[0];
  EXPECT_EQ(MeasuredByProblem(one, "shelf", "path_length", true),
            (ValuesByProblem{{1, {3}}, {3, {7}}}));
  EXPECT_EQ(MeasuredByProblem(one, "shelf", "path_length", false), (ValuesByProblem{{1, {2}}}));
  EXPECT_TRUE(MeasuredByProblem(one, "shelf", "clearance", true).empty());
  EXPECT_EQ(ConfirmedRuns(one, "shelf").size(), 3u);
}

TEST(QualityTest, OfBothDirectionsThePathFromStartToGoalCounts) {
  const auto run = [](int problem, int trial, Direction direction, double length,
                      PlanStatus status = PlanStatus::kSolved) {
    StoredRun made = MakeRun(0, problem, 1, status);
    made.trial = trial;
    made.direction = direction;
    made.measures["path_length"] = length;
    return made;
  };
  using enum Direction;
  StoredRun elsewhere = run(2, 1, kForward, 9);
  elsewhere.problem_set = "desk";
  const ComparedSessions compared({Session(
      "one", {{"A", ""}},
      {run(1, 1, kBackward, 100), run(1, 1, kForward, 3),
       run(1, 2, kForward, 50, PlanStatus::kInvalidPath), run(1, 2, kBackward, 5), elsewhere,
       run(2, 1, kForward, 0, PlanStatus::kTimedOut), run(2, 1, kBackward, 7)})});
  const ComparedContestant& one = compared.contestants()[0];
  EXPECT_EQ(MeasuredByProblem(one, "shelf", "path_length", true),
            (ValuesByProblem{{1, {3, 5}}, {2, {7}}}));
}

TEST(QualityTest, PhasesAreMeans) {
  StoredRun a, b;
  a.phases = {1, 2, 3, 4, 5};
  b.phases = {3, 2, 1, 0, 1};
  EXPECT_EQ(MeanPhases({&a, &b}), (PhaseTimes{2, 2, 2, 2, 3}));
  EXPECT_EQ(MeanPhases({}), PhaseTimes());
  // Of one that tells nothing, and of one that simplified nothing.
  const StoredRun untold;
  EXPECT_EQ(MeanPhases({&a, &untold}), a.phases);
  StoredRun not_simplified;
  not_simplified.phases = {3, 2, 1, 0, 0};
  EXPECT_EQ(MeanPhases({&a, &not_simplified}), (PhaseTimes{2, 2, 2, 2, 5}));
  EXPECT_FALSE(MeanPhases({&untold}).AreTold());
}

}  // namespace
}  // namespace planbench
