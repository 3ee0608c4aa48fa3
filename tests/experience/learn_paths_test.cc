#include "experience/learn_paths.h"

#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"
#include "tests/support/held_runs.h"

namespace planbench {
namespace {

/// A solved run whose simplified path, of that length, is confirmed.
RunRecordMessage SolvedRun(const std::string& set, int problem, double length) {
  RunRecordMessage run;
  run.contestant = "ARA*";
  run.planner = "ara";
  run.problem_set = set;
  run.problem_index = problem;
  run.status = PlanStatus::kSolved;
  run.request.goal = {{.joint = "turn", .position = length}};
  run.result.joint_names = {"turn"};
  run.result.result.simplified_path = {{0}, {length}};
  run.simplified_check.verdict.emplace();
  run.simplified_check.verdict->valid = true;
  run.simplified_check.verdict->measures["path_length"] = length;
  return run;
}

TEST(LearnPaths, TakesTheShortestOfEachProblem) {
  const auto [library, num_against_meshes] =
      LearnPaths(Held({SolvedRun("b", 1, 3), SolvedRun("a", 2, 2), SolvedRun("b", 1, 1),
                       SolvedRun("a", 1, 4), SolvedRun("b", 1, 2)}),
                 {});
  EXPECT_EQ(library.joints, (std::vector<std::string>{"turn"}));
  EXPECT_EQ(library.learned_from, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(library.paths, (std::vector<Path>{{{0}, {4}}, {{0}, {2}}, {{0}, {1}}}));
  EXPECT_EQ(num_against_meshes, 0);
}

TEST(LearnPaths, ProblemsOfOneNumberInOtherScenesAreTwo) {
  RunRecordMessage other = SolvedRun("a", 1, 5);
  other.request.scene_id = "other";
  EXPECT_EQ(LearnPaths(Held({SolvedRun("a", 1, 2), other}), {}).library.paths,
            (std::vector<Path>{{{0}, {2}}, {{0}, {5}}}));
}

TEST(LearnPaths, TellsTheScenesOfItsPaths) {
  RunRecordMessage one = SolvedRun("b", 1, 2);
  one.request.scene_id = "one";
  RunRecordMessage two = SolvedRun("a", 1, 2);
  two.request.scene_id = "two";
  RunRecordMessage unsolved = SolvedRun("a", 2, 2);
  unsolved.request.scene_id = "unsolved";
  unsolved.status = PlanStatus::kTimedOut;
  EXPECT_EQ(LearnPaths(Held({two, one, one, unsolved}), {}).library.scenes,
            (std::vector<std::string>{"one", "two"}));
}

TEST(LearnPaths, TakesOnlyWhatTheRefereeConfirmed) {
  RunRecordMessage timed_out = SolvedRun("a", 1, 1);
  timed_out.status = PlanStatus::kTimedOut;
  RunRecordMessage rejected = SolvedRun("a", 2, 1);
  rejected.simplified_check.verdict->valid = false;
  RunRecordMessage unjudged = SolvedRun("a", 3, 1);
  unjudged.simplified_check.verdict.reset();
  RunRecordMessage through_meshes = SolvedRun("a", 4, 1);
  through_meshes.simplified_check.mesh_verdict.emplace();
  RunRecordMessage at_its_goal = SolvedRun("a", 5, 0);
  at_its_goal.result.result.simplified_path = {{0}};
  const std::vector<RunRecordMessage> none = {timed_out, rejected, unjudged, through_meshes,
                                              at_its_goal};
  ExpectInputError([&] { LearnPaths(Held({rejected}), {}); }, {"nothing to learn", "was recorded"});
  ExpectInputError([&] { LearnPaths(Held(none), {}); },
                   {"nothing to learn", "meshes refuse every", "(1)"});
  std::vector<RunRecordMessage> one = none;
  one.push_back(SolvedRun("a", 6, 7));
  EXPECT_EQ(LearnPaths(Held(one), {}).library.paths, (std::vector<Path>{{{0}, {7}}}));
  EXPECT_EQ(LearnPaths(Held(one), {}).num_against_meshes, 1);
}

TEST(LearnPaths, TakesOnlyTheSetsAndContestantsAskedFor) {
  RunRecordMessage other = SolvedRun("a", 1, 1);
  other.contestant = "other, guided";
  other.planner = "prm";
  const std::vector<RunRecordMessage> runs = {other, SolvedRun("a", 1, 2), SolvedRun("b", 1, 3)};
  EXPECT_EQ(LearnPaths(Held(runs), {{"a"}, {"ARA*"}}).library.paths,
            (std::vector<Path>{{{0}, {2}}}));
  EXPECT_EQ(LearnPaths(Held(runs), {{"b"}, {}}).library.learned_from,
            (std::vector<std::string>{"b"}));
  ExpectInputError([&] { LearnPaths(Held(runs), {{"c"}, {}}); }, {"--sets", "'c'"});
  EXPECT_EQ(LearnPaths(Held(runs), {{"a"}, {"prm"}}).library.paths, (std::vector<Path>{{{0}, {1}}}))
      << "its name on the bus";
  ExpectInputError(
      [&] {
        LearnPaths(Held(runs), {{}, {"PRM"}});
      },
      {"--contestants", "'PRM'", "ARA*; ara; other, guided; prm"});
}

TEST(LearnPaths, PathsAreInTheGroupsOrderWhicheverTheirPlannersHave) {
  RunRecordMessage run = SolvedRun("a", 1, 5);
  // Two alternatives.
  for (const char* joint : {"bend", "turn", "bend"}) run.request.goal.push_back({.joint = joint});
  run.result.joint_names = {"bend", "turn"};
  run.result.result.simplified_path = {{1, 2}, {3, 4}};
  RunRecordMessage other = run;
  other.problem_index = 2;
  other.result.joint_names = {"turn", "bend"};
  for (const auto& runs : {std::vector{run, other}, std::vector{other, run}}) {
    const PathLibrary library = LearnPaths(Held(runs), {}).library;
    EXPECT_EQ(library.joints, (std::vector<std::string>{"turn", "bend"}));
    EXPECT_EQ(library.paths, (std::vector<Path>{{{2, 1}, {4, 3}}, {{1, 2}, {3, 4}}}));
  }
}

TEST(LearnPaths, PathsOfOtherJointsAreNotMixed) {
  RunRecordMessage other = SolvedRun("b", 1, 1);
  other.request.goal.front().joint = "bend";
  other.result.joint_names = {"bend"};
  ExpectInputError(
      [&] {
        LearnPaths(Held({SolvedRun("a", 1, 1), other}), {});
      },
      {"'b'", "other joints"});
}

}  // namespace
}  // namespace planbench
