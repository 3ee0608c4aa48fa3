#include "planner_ara/ara_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "common/read_text.h"
#include "common/stopwatch.h"
#include "contract/planner_contract.h"
#include "contract/random_robots_contract.h"
#include "scene/moveit_yaml.h"
#include "support/expect_input_error.h"
#include "support/path_libraries.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"

namespace planbench {
namespace {

const std::string kPlanarSettings = "primitives: " PLANBENCH_SOURCE_DIR
                                    "/tests/planner_ara/data/planar3.mprim\n"
                                    "discretization: {shoulder: 0.2, elbow: 0.2, wrist: 0.2}\n"
                                    "epsilon_initial: 10\n"
                                    "epsilon_decrement: 1\n"
                                    "short_primitives_within: everywhere\n";

std::unique_ptr<Planner> MakeForContract(const Robot& robot) {
  const bool planar = robot.model.FindJoint("elbow") >= 0;
  return MakeAraPlanner(robot, YamlNode::Parse(planar ? kPlanarSettings : "", "ara.yaml"));
}

INSTANTIATE_TEST_SUITE_P(Ara, PlannerContract,
                         testing::Values(PlannerFactory{"ara", MakeForContract}));

TEST(AraPlanner, PlansForRandomRobotsByItsDefaults) {
  ExpectPlansForRandomRobots(
      [](const Robot& robot) { return MakeAraPlanner(robot, YamlNode::Parse("", "ara.yaml")); });
}

class AraPlannerTest : public testing::Test {
 protected:
  std::unique_ptr<Planner> Make(const std::string& settings) const {
    return MakeAraPlanner(robot_, YamlNode::Parse(settings, "ara.yaml"));
  }
  PlanRequest PastThePost() const { return MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0}); }
  PlanRequest ThroughTheWalls() const { return MakeRequest(robot_, {1.57, 0, 0}, {-1.57, 0, 0}); }

  const Robot robot_ = LoadPlanarRobot();
};

TEST_F(AraPlannerTest, RefusesSettingsItCannotUse) {
  ExpectInputError([&] { Make(kPlanarSettings + "speed: 3"); }, {"ara.yaml:6", "speed"});
  ExpectInputError([&] { Make(kPlanarSettings + "crowding_joints: [knee]"); },
                   {"ara.yaml", "crowding_joints", "knee"});
  ExpectInputError(
      [&] { Make(kPlanarSettings + "use_long_primitives: false\nuse_short_primitives: false"); },
      {"ara.yaml", "no motion primitive"});
  ExpectInputError([&] { Make(kPlanarSettings + "joint_weights: {knee: 2}"); },
                   {"ara.yaml:6", "knee", "no joint"});
  ExpectInputError(
      [&] {
        Make("primitives: " PLANBENCH_SOURCE_DIR
             "/tests/planner_ara/data/planar3.mprim\n"
             "discretization: {shoulder: 0.2, elbow: 0.2}\n");
      },
      {"ara.yaml", "wrist"});
  ExpectInputError(
      [&] {
        Make(
            "primitives: nowhere.mprim\n"
            "discretization: {shoulder: 0.2, elbow: 0.2, wrist: 0.2}\n");
      },
      {"ara.yaml:1: primitives: " + robot_.folder.string() + "/nowhere.mprim: cannot be opened"});
  ExpectInputError(
      [&] {
        Make("primitives: " PLANBENCH_SOURCE_DIR
             "/robots/fetch/fetch.mprim\n"
             "discretization: {shoulder: 0.2, elbow: 0.2, wrist: 0.2}\n");
      },
      {"fetch.mprim:1", "8 columns", "3 joints"});
}

TEST_F(AraPlannerTest, WhatNoLatticeCanHaveIsRefusedBeforeThereAreRequests) {
  const auto expect_refused = [&](const std::string& settings,
                                  const std::vector<std::string>& parts) {
    SCOPED_TRACE(settings);
    ExpectInputError([&] { Make(settings); }, parts);
  };
  for (const std::string size : {"1e-07", "1e-09", "1e-300"}) {
    const std::string cells = "{shoulder: 0.1, elbow: " + size + ", wrist: 0.1}";
    expect_refused("discretization: " + cells, {"ara.yaml", "discretization of elbow", "65535"});
    expect_refused("fit_cells: true\ndiscretization: " + cells,
                   {"ara.yaml", "discretization of elbow", "65535"});
  }
  expect_refused("discretization: {shoulder: 3, elbow: 0.1, wrist: 0.1}",
                 {"ara.yaml", "discretization of shoulder: 3", "fewer than 3"});
  const TemporaryFolder folder;
  const auto moves = folder.Write("p.mprim", "Motion_Primitives(degrees): 1 3 0\n16 0 0\n");
  expect_refused(
      "discretization: {shoulder: 0.2, elbow: 0.2, wrist: 0.2}\nprimitives: " + moves.string(),
      {"ara.yaml", "shoulder", "16 cells", "half a turn"});
}

TEST_F(AraPlannerTest, TellsWhatTheFileOfPrimitivesHolds) {
  const TemporaryFolder folder;
  const std::string settings = "primitives: " + (folder / "p.mprim").string() +
                               "\ndiscretization: {shoulder: 0.2, elbow: 0.2, wrist: 0.2}\n";
  const auto id = [&](const std::string& move) {
    folder.Write("p.mprim", "Motion_Primitives(degrees): 1 3 0\n" + move + "\n");
    return Make(settings)->Describe().settings.at("primitives_id");
  };
  const std::string first = id("1 0 0");
  EXPECT_NE(id("2 0 0"), first);
  EXPECT_EQ(id("1 0 0"), first);
  EXPECT_FALSE(Make("")->Describe().settings.contains("primitives_id"));
}

TEST_F(AraPlannerTest, HasThePrimitivesThatItToldOfWhateverIsWrittenMeanwhile) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.Write(
      "p.mprim", ReadText(PLANBENCH_SOURCE_DIR "/tests/planner_ara/data/planar3.mprim"));
  const std::unique_ptr<Planner> planner =
      Make("primitives: " + file.string() +
           "\ndiscretization: {shoulder: 0.2, elbow: 0.2, "
           "wrist: 0.2}\nshort_primitives_within: everywhere\n");
  PlanRequest request = PastThePost();
  request.parameters = {{"refine", "true"}};
  const PlanResult before = planner->Plan(request, PostsScene(), nullptr);
  ASSERT_EQ(before.status, PlanStatus::kSolved) << before.message;
  folder.Write("p.mprim", "no primitives");
  EXPECT_EQ(planner->Plan(request, PostsScene(), nullptr).path, before.path);
  request.parameters = {{"primitives", file.string()}};
  const PlanResult refused = planner->Plan(request, PostsScene(), nullptr);
  EXPECT_EQ(refused.status, PlanStatus::kInvalidRequest);
  EXPECT_NE(refused.message.find("p.mprim:1"), std::string::npos) << refused.message;
}

TEST_F(AraPlannerTest, FollowsWhatItRecallsAsFarAsItIsFree) {
  const PlanResult before = Make(kPlanarSettings)->Plan(PastThePost(), PostsScene(), nullptr);
  ASSERT_EQ(before.status, PlanStatus::kSolved) << before.message;
  const TemporaryFolder folder;
  const auto with = [&](const std::string& name, const PathLibrary& library) {
    return kPlanarSettings + "experience: " + folder.Write(name, ToYaml(library)).string() + "\n";
  };
  const PathLibrary same = LibraryOf(robot_, {before.simplified_path});
  const std::unique_ptr<Planner> planner = Make(with("same.yaml", same));
  const PlanResult recalled = planner->Plan(PastThePost(), PostsScene(), nullptr);
  ASSERT_EQ(recalled.status, PlanStatus::kSolved) << recalled.message;
  EXPECT_LT(recalled.counters.at("expansions"), before.counters.at("expansions") / 2);
  EXPECT_GT(recalled.counters.at("recalled_edges"), 0);

  // Straight through the posts: of no use.
  const PathLibrary blocked = LibraryOf(robot_, {{{0.6, 0, 0}, {-0.6, 0, 0}}});
  const PlanResult without =
      Make(with("blocked.yaml", blocked))->Plan(PastThePost(), PostsScene(), nullptr);
  EXPECT_EQ(without.status, PlanStatus::kSolved) << without.message;

  const PlannerDescription description = planner->Describe();
  EXPECT_EQ(description.algorithm, "ARA* (two-way, guided, experience)");
  EXPECT_EQ(description.settings.at("learned_from"), "posts, walls");
  EXPECT_FALSE(description.settings.at("experience_id").empty());

  ExpectInputError(
      [&] { Make("experience: nowhere.yaml"); },
      {"ara.yaml:1: experience: " + robot_.folder.string() + "/nowhere.yaml: cannot be opened"});
  PathLibrary other = same;
  other.joints.front() = "other";
  ExpectInputError([&] { Make(with("other.yaml", other)); }, {"other.yaml:1", "joints", "group"});
  ExpectInputError([&] { Make(with("same.yaml", same) + "wrap_heuristic: false"); },
                   {"ara.yaml", "experience", "wrap_heuristic"});
}

TEST_F(AraPlannerTest, NeedsNoSettings) {
  const std::unique_ptr<Planner> planner = Make("");
  EXPECT_EQ(planner->Describe().settings.at("primitives"), "generated");
  for (const Direction direction : {Direction::kForward, Direction::kBackward}) {
    PlanRequest request = PastThePost();
    request.direction = direction;
    const PlanResult result = planner->Plan(request, PostsScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
  }
}

TEST_F(AraPlannerTest, BadParametersOfARequestAreNamed) {
  const std::unique_ptr<Planner> planner = Make(kPlanarSettings);
  struct Case {
    std::string key;
    std::string text;
    std::string message;
  };
  for (const Case& test :
       {Case{"epsilon_initial", "0.5", "from 1 to 1000000, found 0.5"},
        Case{"epsilon_final", "11", "epsilon_final 11"}, Case{"cost", "cheap", "cheap"},
        Case{"discretization", "{elbow: -1}", "discretization.elbow"},
        Case{"discretization", "{elbow: 1e-9}", "cells"},
        Case{"memory_limit_mb", "[1]", "memory_limit_mb"},
        Case{"experience", "paths.yaml", "experience"}, Case{"recall", "0", "recall"},
        Case{"primitives", "nowhere.mprim", "request parameter primitives: /"},
        Case{"edge_weights", "{shoulder: 1, elbow: 1, wrist: 1}", "cannot change"},
        Case{"joint_weights", "{knee: 2}", "joint_weights.knee: the robot has no joint"},
        Case{"discretization", "{knee: 0.1}", "discretization.knee: the robot has no joint"},
        Case{"speed", "3", "speed"}, Case{"crowding", "", "crowding"}}) {
    PlanRequest request = PastThePost();
    request.parameters[test.key] = test.text;
    const PlanResult result = planner->Plan(request, PostsScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kInvalidRequest) << test.key;
    EXPECT_NE(result.message.find(test.message), std::string::npos) << result.message;
  }
}

TEST_F(AraPlannerTest, ParametersServeTheirRequestOnly) {
  const std::unique_ptr<Planner> planner = Make(kPlanarSettings);
  PlanRequest request = PastThePost();
  const PlanResult before = planner->Plan(request, PostsScene(), nullptr);
  request.parameters = {{"discretization", "{shoulder: 0.05}"}, {"epsilon_initial", "1"}};
  const PlanResult finer = planner->Plan(request, PostsScene(), nullptr);
  request.parameters.clear();
  const PlanResult after = planner->Plan(request, PostsScene(), nullptr);
  ASSERT_EQ(finer.status, PlanStatus::kSolved) << finer.message;
  EXPECT_NEAR(finer.epsilon, 1, 1e-12);
  EXPECT_NE(finer.path, before.path);
  EXPECT_EQ(after.path, before.path);
  EXPECT_EQ(after.counters, before.counters);
}

TEST_F(AraPlannerTest, ProvesThatTheLatticeHoldsNoPath) {
  PlanRequest request = ThroughTheWalls();
  request.parameters = {{"discretization", "{shoulder: 0.4, elbow: 0.4, wrist: 0.4}"},
                        {"refine", "false"}};
  const PlanResult result = Make(kPlanarSettings)->Plan(request, WallsScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kExhausted) << result.message;
  EXPECT_FALSE(result.message.empty());
  EXPECT_GT(result.counters.at("expansions"), 100);
  EXPECT_GE(result.counters.at("states"), result.counters.at("expansions"));
  // Guided round the wall, states that are reached at less cost are expanded again.
  EXPECT_GT(result.counters.at("goal_connections_tried"), 100);
  EXPECT_LE(result.counters.at("goal_connections_tried"), result.counters.at("expansions"));
}

TEST_F(AraPlannerTest, StopsAtItsMemoryLimit) {
  PlanRequest request = ThroughTheWalls();
  request.parameters = {{"discretization", "{shoulder: 0.01, elbow: 0.01, wrist: 0.01}"},
                        {"memory_limit_mb", "2"}};
  const PlanResult result = Make(kPlanarSettings)->Plan(request, WallsScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kMemoryLimit);
  EXPECT_NE(result.message.find("memory_limit_mb"), std::string::npos) << result.message;
}

TEST_F(AraPlannerTest, AnytimeSearchEndsAtItsFinalEpsilonWithAProof) {
  PlanRequest request = PastThePost();
  request.anytime = true;
  request.time_limit_s = 600;
  request.parameters["discretization"] = "{shoulder: 0.3, elbow: 0.3, wrist: 0.3}";
  const std::unique_ptr<Planner> planner = Make(kPlanarSettings);
  const PlanResult best = planner->Plan(request, PostsScene(), nullptr);
  ASSERT_EQ(best.status, PlanStatus::kSolved) << best.message;
  EXPECT_EQ(best.epsilon, 1);
  EXPECT_GT(best.progress.size(), 1U);
  EXPECT_EQ(best.progress.back().epsilon, 1);
  EXPECT_EQ(best.progress.back().cost, best.cost);
  EXPECT_NEAR(PathLength(robot_.groups.front().space, best.path), best.cost, 1e-9);
  for (const PlanProgress& progress : best.progress) {
    EXPECT_LE(progress.cost, progress.epsilon * best.cost + 1e-9);
  }

  // The first solution of the same search, when no better one is asked for.
  request.anytime = false;
  const PlanResult first = planner->Plan(request, PostsScene(), nullptr);
  ASSERT_EQ(first.status, PlanStatus::kSolved);
  EXPECT_EQ(first.cost, best.progress.front().cost);
  EXPECT_EQ(first.epsilon, best.progress.front().epsilon);
  EXPECT_TRUE(first.progress.empty());
  EXPECT_GT(first.cost, best.cost);

  request.anytime = true;
  request.parameters["epsilon_final"] = "1.5";
  const PlanResult good_enough = planner->Plan(request, PostsScene(), nullptr);
  EXPECT_LE(good_enough.epsilon, 1.5);
  EXPECT_LT(good_enough.counters.at("expansions"), best.counters.at("expansions"));
}

TEST_F(AraPlannerTest, TheCostIsThatOfThePath) {
  PlanRequest request = PastThePost();
  request.anytime = true;
  request.time_limit_s = 600;
  request.parameters = {{"discretization", "{shoulder: 0.3, elbow: 0.3, wrist: 0.3}"},
                        {"shorten", "false"}};
  const std::unique_ptr<Planner> planner = Make(kPlanarSettings);
  // At 4 and 2 a state on the path has become cheaper after the goal was reached by way of it.
  for (const char* epsilon : {"5", "4", "2", "1"}) {
    SCOPED_TRACE(epsilon);
    request.parameters["epsilon_final"] = epsilon;
    const PlanResult result = planner->Plan(request, PostsScene(), nullptr);
    ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
    EXPECT_NEAR(result.cost, PathLength(robot_.groups.front().space, result.path), 1e-9);
    EXPECT_GE(result.epsilon, 1);
    EXPECT_EQ(result.progress.back().cost, result.cost);
  }
}

TEST_F(AraPlannerTest, TheLastProgressIsThePathReturnedWhereverTheLimitComes) {
  PlanRequest request = PastThePost();
  request.anytime = true;
  request.simplify = false;
  request.time_limit_s = 0.01;
  const std::unique_ptr<Planner> planner = Make(kPlanarSettings);
  for (int i = 0; i < 150; ++i) {
    // What follows the first path, which is to shorten it, waits until so little time is left that
    // the limit comes within that, and may come within an edge.
    const double goes_on_at_s = request.time_limit_s - 2e-6 * i;
    bool is_first = true;
    PlanControl control;
    control.on_progress = [&](const PlanProgress& progress) {
      if (!std::exchange(is_first, false)) return;
      const Stopwatch clock;
      while (progress.elapsed_s + clock.seconds() < goes_on_at_s) {
      }
    };
    const PlanResult result = planner->Plan(request, PostsScene(), &control);
    if (result.status != PlanStatus::kSolved) continue;  // there was no path by then
    ASSERT_FALSE(result.progress.empty());
    ASSERT_EQ(result.progress.back().cost, result.cost);
    ASSERT_EQ(result.progress.back().epsilon, result.epsilon);
    ASSERT_GE(result.progress.front().epsilon, 1) << "the straight motion is a lower bound";
  }
}

TEST_F(AraPlannerTest, UniformCostsCountMoves) {
  PlanRequest request = PastThePost();
  request.parameters = {{"cost", "uniform"}, {"use_long_primitives", "false"}};
  const PlanResult result = Make(kPlanarSettings)->Plan(request, PostsScene(), nullptr);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
  // All moves cost 1 but the motion to the goal, which costs its length if that is more.
  const bool backward = result.counters.at("found_backward") > 0;
  const std::size_t to_goal = backward ? 1 : result.path.size() - 1;
  const double length =
      robot_.groups.front().space.Distance(result.path[to_goal - 1], result.path[to_goal]);
  EXPECT_NEAR(result.cost, static_cast<double>(result.path.size() - 2) + std::max(1.0, length),
              1e-6);
}

TEST_F(AraPlannerTest, DescribesItself) {
  const PlannerDescription description = Make(kPlanarSettings)->Describe();
  EXPECT_EQ(description.algorithm, "ARA* (two-way, guided)");
  EXPECT_EQ(description.planner_class, PlannerClass::kSearchAndSample);
  EXPECT_TRUE(description.backward);
  EXPECT_TRUE(description.anytime);
  EXPECT_TRUE(description.bidirectional);
  EXPECT_FALSE(Make(kPlanarSettings + "two_way: false")->Describe().bidirectional);
  EXPECT_TRUE(description.deterministic);
  EXPECT_EQ(description.collision_models, EnumValues<CollisionModel>());
  EXPECT_EQ(description.settings.at("epsilon_initial"), "10");
  EXPECT_EQ(description.settings.at("discretization"), "{elbow: 0.2, shoulder: 0.2, wrist: 0.2}");
}

TEST_F(AraPlannerTest, ItsNameSaysWhichVariantItIs) {
  const auto name = [&](const std::string& settings) {
    return Make(kPlanarSettings + settings)->Describe().algorithm;
  };
  EXPECT_EQ(name("two_way: false\ntip_guide: 0\ncrowding: 0"), "ARA*");
  EXPECT_EQ(name("tip_guide: 0\ncrowding: 0"), "ARA* (two-way)");
  EXPECT_EQ(name("burs: true"), "ARA* (two-way, guided, burs)");
  EXPECT_EQ(name("two_way: false\ntip_guide: 0"), "ARA* (guided)");
}

TEST_F(AraPlannerTest, BursAreRefusedWhereDistancesProveNothing) {
  PlanRequest request = PastThePost();
  request.collision_model = CollisionModel::kVoxels;
  EXPECT_NE(Make(kPlanarSettings)->Plan(request, PostsScene(), nullptr).status,
            PlanStatus::kInvalidRequest);
  const PlanResult result =
      Make(kPlanarSettings + "burs: true")->Plan(request, PostsScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kInvalidRequest);
  EXPECT_THAT(result.message, testing::HasSubstr("burs: the collision model 'voxels'"));
}

TEST_F(AraPlannerTest, TheStudysSettingsSolveWithItsOwnMoves) {
  const Robot fetch = LoadFetch();
  const std::unique_ptr<Planner> planner =
      MakeAraPlanner(fetch, YamlNode::LoadFile((fetch.folder / "ara_study.yaml").string()));
  EXPECT_EQ(planner->Describe().settings.at("cost"), "uniform");
  EXPECT_EQ(planner->Describe().settings.at("evaluation"), "eager");
  PlanRequest request = MakeRequest(fetch, FetchTucked(), FetchOverTable());
  request.direction = Direction::kBackward;
  request.simplify = false;
  const PlanResult result = planner->Plan(request, FetchTableScene(fetch), nullptr);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_EQ(result.epsilon, 0) << "its heuristic proves nothing";
  // The path runs start to goal: of all its motions only the first, the search's last, is no move
  // of 8 cells.
  const JointSpace& space = fetch.groups.front().space;
  for (std::size_t i = 2; i < result.path.size(); ++i) {
    int num_moved = 0;
    for (int j = 0; j < space.size(); ++j) {
      const auto k = static_cast<std::size_t>(j);
      const double motion = std::abs(space.Difference(j, result.path[i - 1][k], result.path[i][k]));
      if (motion < 1e-9) continue;
      ++num_moved;
      // A whole number of cells between the limits of each bounded joint.
      const double range = space.joint(j).upper - space.joint(j).lower;
      const double nominal = space.joint(j).prismatic ? 0.005 : M_PI / 180;
      EXPECT_NEAR(motion, 8 * range / std::round(range / nominal), 1e-9);
    }
    EXPECT_EQ(num_moved, 1);
  }
}

TEST_F(AraPlannerTest, SolvesPublishedProblems) {
  PLANBENCH_NEED_SHARED_DATA("problems/table_pick_fetch");
  const Robot fetch = LoadFetch();
  const std::unique_ptr<Planner> planner = MakeForContract(fetch);
  const ProblemSet set = ListProblemSet(SharedData("problems/table_pick_fetch"));
  for (const int index : {11, 41, 71}) {
    const ProblemFiles* files = set.Find(index);
    ASSERT_NE(files, nullptr);
    const Problem problem = ReadProblem(files->scene, files->request, fetch);
    PlanRequest request;
    request.group = problem.group;
    request.start = problem.start;
    request.goal = problem.goal;
    request.direction = Direction::kBackward;
    request.time_limit_s = 120;
    const PlanResult result = planner->Plan(request, problem.scene, nullptr);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << index << ": " << result.message;
    EXPECT_GE(result.epsilon, 1);
    EXPECT_LE(result.epsilon, 20);
  }
}

TEST_F(AraPlannerTest, BothCollisionEnginesLeadToTheSamePaths) {
  ExpectSamePathsFromBothEngines(MakeForContract);
}

}  // namespace
}  // namespace planbench
