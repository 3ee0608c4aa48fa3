#include "planner_rrtc/rrtc_planner.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "planner_rrtc/ompl_algorithms.h"
#include "planner_rrtc/rrtc_settings.h"
#include "scene/moveit_yaml.h"
#include "tests/contract/planner_contract.h"
#include "tests/contract/random_robots_contract.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/path_libraries.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

YamlNode Settings(const std::string& text) { return YamlNode::Parse(text, "rrtc.yaml"); }

std::unique_ptr<Planner> MakeForContract(const Robot& robot) {
  return MakeRrtcPlanner(robot, Settings("range: 1.0"));
}

std::vector<PlannerFactory> AllPlanners() {
  std::vector<PlannerFactory> factories;
  const auto add = [&](const std::string& name, const std::string& settings) {
    factories.push_back({name, [settings](const Robot& robot) {
                           return MakeRrtcPlanner(robot, Settings(settings));
                         }});
  };
  add("RRT_Connect", "");
  add("RRT_Connect_step_by_step", "{extension: step, balance: false}");
  add("RRT_Connect_halton", "{sampler: halton}");
  add("RRT_Connect_dynamic_domain", "{domain_radius: 2}");
  for (const OmplAlgorithm& algorithm : OmplAlgorithms()) {
    add(std::string(algorithm.name), fmt::format("{{algorithm: {}, range: 1}}", algorithm.name));
  }
  return factories;
}

INSTANTIATE_TEST_SUITE_P(Rrtc, PlannerContract, testing::ValuesIn(AllPlanners()),
                         [](const auto& info) { return info.param.name; });

TEST(RrtcPlanner, PlansForRandomRobotsByItsDefaults) {
  for (const char* settings : {"", "algorithm: RRTConnect"}) {
    ExpectPlansForRandomRobots(
        [&](const Robot& robot) { return MakeRrtcPlanner(robot, Settings(settings)); });
  }
}

class RrtcPlannerTest : public testing::Test {
 protected:
  PlanResult Solve(const std::string& settings, std::uint64_t seed = 1) const {
    PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
    request.seed = seed;
    return MakeRrtcPlanner(robot_, Settings(settings))->Plan(request, PostsScene(), nullptr);
  }

  const Robot robot_ = LoadPlanarRobot();
};

TEST_F(RrtcPlannerTest, FollowsWhatItRecallsAsFarAsItIsFree) {
  const PlanResult before = Solve("");
  ASSERT_EQ(before.status, PlanStatus::kSolved);
  const TemporaryFolder folder;
  PathLibrary library = LibraryOf(robot_, {before.simplified_path});
  const auto with = [&](const std::string& name) {
    return "experience: " + folder.Write(name, ToYaml(library)).string();
  };

  const PlanResult recalled = Solve(with("same.yaml"));
  ASSERT_EQ(recalled.status, PlanStatus::kSolved) << recalled.message;
  EXPECT_EQ(recalled.counters.at("iterations"), 0) << "the path is free as it is";
  EXPECT_GT(recalled.counters.at("states_recalled"), 0);
  EXPECT_EQ(recalled.path, Solve(with("same.yaml"), 7).path) << "no sample was drawn";

  // Straight through the posts: of use up to them.
  library.paths = {{{0.6, 0, 0}, {-0.6, 0, 0}}};
  const PlanResult repaired = Solve(with("blocked.yaml"));
  ASSERT_EQ(repaired.status, PlanStatus::kSolved) << repaired.message;
  EXPECT_GT(repaired.counters.at("iterations"), 0);

  const PlannerDescription description =
      MakeRrtcPlanner(robot_, Settings(with("same.yaml")))->Describe();
  EXPECT_EQ(description.algorithm, "RRT-Connect (balanced, experience)");
  EXPECT_EQ(description.settings.at("learned_from"), "posts, walls");
  EXPECT_FALSE(description.settings.contains("learned_scenes"));
  library.scenes = {"0123456789abcdef", "fedcba9876543210"};
  EXPECT_EQ(MakeRrtcPlanner(robot_, Settings(with("scenes.yaml")))
                ->Describe()
                .settings.at("learned_scenes"),
            "01234567 fedcba98");
  EXPECT_FALSE(description.settings.at("experience_id").empty());

  ExpectInputError(
      [&] { Solve("experience: nowhere.yaml"); },
      {"rrtc.yaml:1: experience: " + robot_.folder.string() + "/nowhere.yaml: cannot be opened"});
  library.joints.front() = "other";
  ExpectInputError([&] { Solve(with("other.yaml")); }, {"other.yaml:1", "joints", "group"});
  ExpectInputError([&] { Solve("recall: 0"); }, {"rrtc.yaml:1", "recall"});
  ExpectInputError([&] { Solve("{algorithm: PRM, experience: a.yaml}"); }, {"experience", "OMPL"});
}

TEST_F(RrtcPlannerTest, RefusesBadSettingsByFileLineAndKey) {
  const auto expect_refused = [&](const std::string& text, const std::vector<std::string>& parts) {
    SCOPED_TRACE(text);
    ExpectInputError([&] { MakeRrtcPlanner(robot_, Settings(text)); }, parts);
  };
  expect_refused("range: 0", {"rrtc.yaml:1", "range"});
  expect_refused("\nrange: far", {"rrtc.yaml:2", "range", "far"});
  expect_refused("range: 1\nrnage: 2", {"rrtc.yaml:2", "rnage"});
  expect_refused("[1, 2]", {"rrtc.yaml"});
  expect_refused("range: 1\nsampler: sobol", {"rrtc.yaml:2", "sampler", "sobol", "halton"});
  expect_refused("extension: jump", {"rrtc.yaml:1", "extension", "jump", "connect"});
  expect_refused("range:", {"rrtc.yaml:1: range:", "has no value"});
  expect_refused("range: 1\nompl: ~", {"rrtc.yaml:2: ompl:", "has no value"});
  expect_refused("domain_radius: -1", {"rrtc.yaml:1", "domain_radius", "-1"});
  expect_refused("balance: 2.5", {"rrtc.yaml:1", "balance"});
  expect_refused("range: 1\nalgorithm: RRTConect",
                 {"rrtc.yaml:2", "algorithm", "RRTConect", "RRT-Connect", "BITstar", "PRM"});
}

TEST_F(RrtcPlannerTest, RefusesBadParametersOfOmplsPlanners) {
  const auto expect_refused = [&](const std::string& text, const std::vector<std::string>& parts) {
    SCOPED_TRACE(text);
    ExpectInputError([&] { MakeRrtcPlanner(robot_, Settings(text)); }, parts);
  };
  expect_refused("algorithm: RRT\nompl: {goal_bais: 0.1}",
                 {"rrtc.yaml", "ompl.goal_bais", "RRT", "goal_bias"});
  expect_refused("algorithm: RRT\nompl: {goal_bias: ~}",
                 {"rrtc.yaml:2: ompl.goal_bias:", "has no value"});
  expect_refused("algorithm: RRT\nompl: {goal_bias: often}",
                 {"rrtc.yaml", "ompl.goal_bias", "often"});
  for (const std::string value : {"-1", "7", ".nan", "nan", "inf", "0.1x"}) {
    expect_refused("algorithm: RRT\nompl: {goal_bias: " + value + "}",
                   {"rrtc.yaml", "ompl.goal_bias:", value});
  }
  expect_refused("algorithm: RRT\nompl: {goal_bias: 7}", {"from 0 to 1"});
  expect_refused("algorithm: PRM\nompl: {max_nearest_neighbors: -1}",
                 {"max_nearest_neighbors", "-1"});
  expect_refused("algorithm: BITstar\nompl: {samples_per_batch: 1.5}",
                 {"samples_per_batch", "1.5", "whole"});
  expect_refused("algorithm: BITstar\nompl: {use_k_nearest: never}", {"use_k_nearest", "never"});
  expect_refused("algorithm: KPIECE1\nompl: {min_valid_path_fraction: -0.1}",
                 {"min_valid_path_fraction", "-0.1", "from 0 to 1"});
  expect_refused("algorithm: TRRT\nompl: {init_temperature: -inf}", {"init_temperature", "finite"});
  expect_refused("algorithm: BITstar\nompl: {samples_per_batch: 1000000}",
                 {"samples_per_batch: 1000000 is not from 1 to 100000"});
  expect_refused("algorithm: LazyPRM\nompl: {max_nearest_neighbors: 5000000000}",
                 {"5000000000 is not from 1 to 1000000"});
  expect_refused("algorithm: STRIDE\nompl: {degree: 1}", {"1 is not from 2 to 1000"});
  expect_refused("algorithm: STRIDE\nompl: {max_degree: 1001}", {"1001 is not from 2 to 1000"});
  expect_refused("algorithm: STRIDE\nompl: {max_pts_per_leaf: 0}", {"0 is not from 1 to 1000000"});
  expect_refused("algorithm: RRTsharp\nompl: {rejection_variant: 4}",
                 {"ompl.rejection_variant: '4' is no value"});
  expect_refused("algorithm: RRTstar\nompl: {rewire_factor: 1e300}",
                 {"1e300 is not from 0 to 1000000"});
  expect_refused("algorithm: TRRT\nompl: {init_temperature: 1e300}",
                 {"1e300 is more than 1000000"});
  expect_refused("algorithm: KPIECE1\nompl: {failed_expansion_score_factor: 5}",
                 {"rrtc.yaml", "KPIECE1 cannot be set up", "score factor must be in the range"});
  expect_refused("algorithm: RRTstar\nompl: {ordered_sampling: 1}",
                 {"rrtc.yaml", "ompl.ordered_sampling", "informed_sampling or sample_rejection"});
  expect_refused("algorithm: RRT\nompl: 3", {"rrtc.yaml:2", "ompl"});
  expect_refused("ompl: {goal_bias: 0.1}", {"rrtc.yaml:1", "ompl", "RRT-Connect"});
  expect_refused("range: 2\nmetric: sum", {"rrtc.yaml:2", "metric", "RRT-Connect"});
  expect_refused("algorithm: RRT\nmetric: max", {"rrtc.yaml:2", "metric", "max", "sum"});
  expect_refused("algorithm: RRT\nompl: {range: 2}", {"ompl.range", "the setting 'range'"});
  expect_refused("algorithm: RRT\nlongest_valid_segment_fraction: 2",
                 {"rrtc.yaml:2", "longest_valid_segment_fraction", "2"});
  expect_refused("algorithm: RRT\nlongest_valid_segment_fraction: 1e-12",
                 {"rrtc.yaml:2", "longest_valid_segment_fraction", "from 1e-06 to 1"});
}

TEST_F(RrtcPlannerTest, RefusesWhatTheAlgorithmHasNoUseFor) {
  for (const std::string setting :
       {"extension: step", "balance: false", "domain_radius: 2", "recall: 2"}) {
    ExpectInputError([&] { MakeRrtcPlanner(robot_, Settings("algorithm: RRT\n" + setting)); },
                     {"rrtc.yaml:2", setting.substr(0, setting.find(':')), "RRT-Connect only"});
  }
  for (const std::string algorithm : {"EST", "KPIECE1", "SBL", "STRIDE"}) {
    ExpectInputError(
        [&] { MakeRrtcPlanner(robot_, Settings("algorithm: " + algorithm + "\nsampler: halton")); },
        {"rrtc.yaml:2: sampler:", algorithm});
    EXPECT_FALSE(MakeRrtcPlanner(robot_, Settings("algorithm: " + algorithm))
                     ->Describe()
                     .settings.contains("sampler"));
  }
  ExpectInputError([&] { MakeRrtcPlanner(robot_, Settings("recall: 2")); },
                   {"rrtc.yaml:1: recall", "'experience'"});

  const std::unique_ptr<Planner> planner = MakeRrtcPlanner(robot_, Settings("algorithm: RRT"));
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  request.parameters["balance"] = "false";
  const PlanResult result = planner->Plan(request, PostsScene(), nullptr);
  EXPECT_EQ(result.status, PlanStatus::kInvalidRequest);
  EXPECT_NE(result.message.find("balance"), std::string::npos) << result.message;
}

TEST_F(RrtcPlannerTest, TellsTheRangeWhereThereIsOne) {
  const auto settings = [&](const std::string& text) {
    return MakeRrtcPlanner(robot_, Settings(text))->Describe().settings;
  };
  EXPECT_EQ(settings("{algorithm: RRT, range: 1}").at("range"), "1");
  for (const std::string algorithm : {"PRM", "LazyPRM", "BITstar"}) {
    EXPECT_FALSE(settings("{range: 1, algorithm: " + algorithm + "}").contains("range"))
        << algorithm;
  }
}

TEST_F(RrtcPlannerTest, TheFetchsStudySettingsAreAccepted) {
  const Robot fetch = LoadFetch();
  EXPECT_FALSE(fetch.planner_settings.contains("rrtc")) << "the defaults suit it";
  const YamlNode study = YamlNode::LoadFile((fetch.folder / "rrtc_study.yaml").string());
  const PlannerDescription description = MakeRrtcPlanner(fetch, study)->Describe();
  EXPECT_EQ(description.algorithm, "RRTConnect (OMPL)");
  EXPECT_EQ(description.settings.at("range"), "default");
  EXPECT_EQ(description.settings.at("metric"), "sum");
  EXPECT_EQ(description.settings.at("longest_valid_segment_fraction"), "0.005");
}

TEST_F(RrtcPlannerTest, Describes) {
  const PlannerDescription description = MakeRrtcPlanner(robot_, Settings(""))->Describe();
  EXPECT_EQ(description.algorithm, "RRT-Connect (balanced)");
  EXPECT_EQ(description.planner_class, PlannerClass::kSamplingGuided);
  EXPECT_TRUE(description.backward);
  EXPECT_FALSE(description.anytime);
  EXPECT_TRUE(description.bidirectional);
  EXPECT_FALSE(description.deterministic);
  EXPECT_EQ(description.collision_models, EnumValues<CollisionModel>());
  EXPECT_EQ(description.settings, (std::map<std::string, std::string>{{"algorithm", "RRT-Connect"},
                                                                      {"sampler", "uniform"},
                                                                      {"range", "default"},
                                                                      {"extension", "connect"},
                                                                      {"balance", "true"},
                                                                      {"domain_radius", "0"}}));
}

TEST_F(RrtcPlannerTest, ItsNameSaysWhichVariantItIs) {
  const auto name = [&](const std::string& settings) {
    return MakeRrtcPlanner(robot_, Settings(settings))->Describe().algorithm;
  };
  EXPECT_EQ(name("{extension: step, balance: false, range: 1}"), "RRT-Connect (canonical)");
  EXPECT_EQ(name("{extension: step, balance: false}"), "RRT-Connect (step, alternating)");
  EXPECT_EQ(name("{extension: connect, balance: false}"), "RRT-Connect (connect, alternating)");
  EXPECT_EQ(name("{extension: step, balance: true}"), "RRT-Connect (step, balanced)");
  EXPECT_EQ(name("{domain_radius: 4}"), "RRT-Connect (balanced, dynamic domain)");
}

TEST_F(RrtcPlannerTest, OmplsPlannersCountWhatTheyDraw) {
  for (const OmplAlgorithm& algorithm : OmplAlgorithms()) {
    const PlanResult result = Solve(fmt::format("{{algorithm: {}, range: 1}}", algorithm.name));
    EXPECT_GT(result.counters.at("iterations"), 0) << algorithm.name;
  }
}

TEST_F(RrtcPlannerTest, OmplsPlannersReachGoalsManyTurnsAway) {
  for (const OmplAlgorithm& algorithm : OmplAlgorithms()) {
    PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {1000, 0.5, 0});
    request.time_limit_s = 20;
    const auto planner =
        MakeRrtcPlanner(robot_, Settings(fmt::format("algorithm: {}", algorithm.name)));
    const PlanResult result = planner->Plan(request, EmptyPlanarScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << algorithm.name << ": " << result.message;
  }
}

TEST_F(RrtcPlannerTest, DescribesOmplsPlannersUnderTheirNames) {
  const PlannerDescription description =
      MakeRrtcPlanner(robot_, Settings("{algorithm: BITstar, ompl: {samples_per_batch: 50}}"))
          ->Describe();
  EXPECT_EQ(description.algorithm, "BITstar (OMPL)");
  EXPECT_EQ(description.planner_class, PlannerClass::kSearchAndSample);
  EXPECT_TRUE(description.anytime);
  EXPECT_FALSE(description.bidirectional);
  EXPECT_TRUE(MakeRrtcPlanner(robot_, Settings("algorithm: BiEST"))->Describe().bidirectional);
  EXPECT_EQ(description.settings.at("ompl.samples_per_batch"), "50");
  const PlannerDescription prm = MakeRrtcPlanner(robot_, Settings("algorithm: PRM"))->Describe();
  EXPECT_EQ(prm.planner_class, PlannerClass::kSampleThenSearch);
  EXPECT_EQ(prm.algorithm, "PRM (OMPL, grown only)");
}

TEST_F(RrtcPlannerTest, ParametersOfOmplsPlannersTakeEffect) {
  EXPECT_NE(Solve("{algorithm: RRT, ompl: {goal_bias: 0.05}}").counters,
            Solve("{algorithm: RRT, ompl: {goal_bias: 0.5}}").counters);
  for (const std::string algorithm : {"KPIECE1", "BKPIECE1", "STRIDE"}) {
    const auto with = [&](const std::string& fraction) {
      return Solve(fmt::format("{{algorithm: {}, range: 2, ompl: {{min_valid_path_fraction: {}}}}}",
                               algorithm, fraction));
    };
    EXPECT_NE(with("0.05").counters, with("1").counters) << algorithm;
  }
}

TEST_F(RrtcPlannerTest, DefaultsAndChoicesOfOmplsParametersAreAccepted) {
  for (const std::string text :
       {"{algorithm: RRT, ompl: {goal_bias: 0, intermediate_states: true}}",
        "{algorithm: RRTstar, ompl: {goal_bias: 1, rewire_factor: 1.1, use_k_nearest: 0}}",
        "{algorithm: RRTstar, ompl: {informed_sampling: 1, ordered_sampling: 1}}",
        "{algorithm: InformedRRTstar, ompl: {ordered_sampling: true}}",
        "{algorithm: BITstar, ompl: {samples_per_batch: 100, rewire_factor: 1.1}}",
        "{algorithm: LazyPRM, ompl: {max_nearest_neighbors: 5, range: 10000}}",
        "{algorithm: RRTsharp, ompl: {rejection_variant: 0}}",
        "{algorithm: ABITstar, ompl: {initial_inflation_factor: 1e6}}",
        "{algorithm: TRRT, ompl: {init_temperature: 100, temp_change_factor: 0.1}}"}) {
    EXPECT_NO_THROW(MakeRrtcPlanner(robot_, Settings(text))) << text;
  }
}

TEST_F(RrtcPlannerTest, WholeNumbersBeyondOmplsSuggestionsDoNoHarm) {
  for (const std::string text :
       {"{algorithm: STRIDE, ompl: {degree: 1000, max_degree: 1000, min_degree: 1000}}",
        "{algorithm: STRIDE, ompl: {degree: 30, max_degree: 40, max_pts_per_leaf: 1000000}}",
        "{algorithm: PRM, ompl: {max_nearest_neighbors: 1000000}}",
        "{algorithm: InformedRRTstar, ompl: {number_sampling_attempts: 1000000}}"}) {
    const PlanResult result = Solve(text);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << text << ": " << result.message;
  }
}

TEST_F(RrtcPlannerTest, EverySettingTakesEffect) {
  const Path path = Solve("").path;
  for (const std::string text : {"range: 0.2", "sampler: halton", "extension: step",
                                 "algorithm: RRTConnect", "algorithm: RRT"}) {
    EXPECT_NE(Solve(text).path, path) << text;
  }
}

TEST_F(RrtcPlannerTest, TheLongestValidSegmentDecidesHowEdgesAreSampled) {
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  const auto solve = [&](const std::string& settings, EdgeCheck edge_check) {
    request.edge_check = edge_check;
    return MakeRrtcPlanner(robot_, Settings("{algorithm: RRTConnect, range: 1, " + settings + "}"))
        ->Plan(request, PostsScene(), nullptr);
  };
  const auto samples_an_edge = [&](const std::string& settings) {
    const PlanResult result = solve(settings, EdgeCheck::kFixed);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << result.message;
    return result.counters.at("configurations_checked") / result.counters.at("edges_checked");
  };
  const double few = samples_an_edge("longest_valid_segment_fraction: 1");
  EXPECT_GE(few, 1);
  EXPECT_LE(few, 4) << "the end of each, and start and goal by themselves";
  EXPECT_GT(samples_an_edge("longest_valid_segment_fraction: 0.01"), 2 * few);
  EXPECT_GT(samples_an_edge("metric: sum, longest_valid_segment_fraction: 0.005"), 2 * few);

  const PlanResult certified = solve("longest_valid_segment_fraction: 0.01", EdgeCheck::kCertified);
  EXPECT_EQ(certified.status, PlanStatus::kInvalidRequest) << "its edges would not be";
  EXPECT_TRUE(certified.message.starts_with("rrtc.yaml:1: longest_valid_segment_fraction: "))
      << certified.message;
  EXPECT_NE(certified.message.find("edge_check fixed"), std::string::npos) << certified.message;
}

TEST_F(RrtcPlannerTest, BadRangesOfARequestAreRefused) {
  const std::unique_ptr<Planner> planner = MakeForContract(robot_);
  for (const std::string text : {"0", "-1", "x", "", "[1]", "{x: 1}"}) {
    PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
    request.parameters["range"] = text;
    const PlanResult result = planner->Plan(request, PostsScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kInvalidRequest) << "range '" << text << "'";
    EXPECT_NE(result.message.find("range"), std::string::npos) << result.message;
  }
}

TEST_F(RrtcPlannerTest, MotionsWithoutEndEndWithTheTimeLimit) {
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  request.time_limit_s = 0.05;
  for (const std::string settings :
       {"{range: 1e-7}", "{range: 1e-300}", "{range: 1e-7, algorithm: RRTConnect}"}) {
    const PlanResult result =
        MakeRrtcPlanner(robot_, Settings(settings))->Plan(request, PostsScene(), nullptr);
    EXPECT_EQ(result.status, PlanStatus::kTimedOut) << settings;
    EXPECT_LT(result.counters.at("edges_checked"), 1e6) << "of more than a million: " << settings;
  }
}

TEST_F(RrtcPlannerTest, ByDefaultTheRangeShrinksAsTheSearchLasts) {
  EXPECT_EQ(ShrinkingRange(0), 2);
  EXPECT_NEAR(ShrinkingRange(50), 1.3, 1e-12);
  EXPECT_NEAR(ShrinkingRange(5000), 0.6, 1e-12);
  const PlanResult result = Solve("range: default");
  EXPECT_EQ(result.path, Solve("").path);
  const JointSpace& space = robot_.groups.front().space;
  for (std::size_t i = 1; i < result.path.size(); ++i) {
    EXPECT_LE(space.Distance(result.path[i - 1], result.path[i]), 2 + 1e-9);
  }
}

TEST_F(RrtcPlannerTest, ARangeHoldsForItsRequestOnly) {
  const std::unique_ptr<Planner> planner = MakeForContract(robot_);
  PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  const PlanResult before = planner->Plan(request, PostsScene(), nullptr);
  request.parameters["range"] = "0.1";
  const PlanResult with_short_range = planner->Plan(request, PostsScene(), nullptr);
  request.parameters.clear();
  const PlanResult after = planner->Plan(request, PostsScene(), nullptr);
  ASSERT_EQ(with_short_range.status, PlanStatus::kSolved);
  const JointSpace& space = robot_.groups.front().space;
  for (std::size_t i = 1; i < with_short_range.path.size(); ++i) {
    EXPECT_LE(space.Distance(with_short_range.path[i - 1], with_short_range.path[i]), 0.1 + 1e-9);
  }
  EXPECT_EQ(before.path, after.path);
}

TEST_F(RrtcPlannerTest, SeedsDecideThePath) {
  for (const std::string settings :
       {"", "algorithm: RRT", "algorithm: BITstar", "sampler: halton"}) {
    const Path one = Solve(settings, 1).path;
    EXPECT_EQ(Solve(settings, 1).path, one) << settings;
    EXPECT_NE(Solve(settings, 2).path, one) << settings;
    EXPECT_NE(Solve(settings, 1 + (std::uint64_t{1} << 32)).path, one) << settings;
  }
}

TEST_F(RrtcPlannerTest, AnotherPlannersRequestsInBetweenDoNotMatter) {
  const std::unique_ptr<Planner> planner = MakeRrtcPlanner(robot_, Settings("algorithm: KPIECE1"));
  const std::unique_ptr<Planner> other = MakeRrtcPlanner(robot_, Settings("algorithm: RRT"));
  const PlanRequest request = MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0});
  const PlanResult before = planner->Plan(request, PostsScene(), nullptr);
  other->Plan(request, PostsScene(), nullptr);
  EXPECT_EQ(planner->Plan(request, PostsScene(), nullptr).path, before.path);
}

TEST_F(RrtcPlannerTest, CountsItsTreesAndIterations) {
  const PlanResult result = MakeForContract(robot_)->Plan(
      MakeRequest(robot_, {0.6, 0, 0}, {-0.6, 0, 0}), PostsScene(), nullptr);
  ASSERT_EQ(result.status, PlanStatus::kSolved);
  EXPECT_GE(result.counters.at("iterations"), 1);
  EXPECT_GE(result.counters.at("states_start_tree"), 1);
  EXPECT_GE(result.counters.at("states_goal_tree"), 1);
  EXPECT_GE(result.counters.at("states_start_tree") + result.counters.at("states_goal_tree"),
            static_cast<double>(result.path.size()));
  EXPECT_GT(result.phases.guidance_s, 0);
  EXPECT_NEAR(result.phases.setup_s + result.phases.collision_s + result.phases.guidance_s +
                  result.phases.search_s,
              result.planning_time_s, 1e-9);
}

TEST_F(RrtcPlannerTest, MotionsAreWithinTheRange) {
  const JointSpace& space = robot_.groups.front().space;
  for (const std::string extension : {"step", "connect"}) {
    const Path path = Solve("{range: 0.3, extension: " + extension + "}").path;
    ASSERT_FALSE(path.empty());
    for (std::size_t i = 1; i < path.size(); ++i) {
      EXPECT_LE(space.Distance(path[i - 1], path[i]), 0.3 + 1e-6);
    }
  }
}

TEST_F(RrtcPlannerTest, ADynamicDomainTurnsSamplesAway) {
  // Stretched between two posts: most motions out of either end collide.
  const PlanResult result =
      MakeRrtcPlanner(robot_, Settings("{range: 0.5, extension: step, domain_radius: 0.6}"))
          ->Plan(MakeRequest(robot_, {0.25, 0, 0}, {-0.25, 0, 0}), PostsScene(), nullptr);
  ASSERT_EQ(result.status, PlanStatus::kSolved);
  EXPECT_GT(result.counters.at("out_of_domain"), 0);
  EXPECT_LT(result.counters.at("out_of_domain"), result.counters.at("iterations"));
}

TEST_F(RrtcPlannerTest, ADynamicDomainHasTheRangeAtLeast) {
  const auto with = [&](const std::string& radius) {
    return MakeRrtcPlanner(robot_,
                           Settings("{range: 0.5, extension: step, domain_radius: " + radius + "}"))
        ->Plan(MakeRequest(robot_, {0.25, 0, 0}, {-0.25, 0, 0}), PostsScene(), nullptr);
  };
  const PlanResult result = with("1e-9");
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.message;
  EXPECT_GT(result.counters.at("out_of_domain"), 0);
  const PlanResult larger = with("0.4");
  EXPECT_EQ(result.path, larger.path);
  EXPECT_EQ(result.counters, larger.counters);
}

TEST_F(RrtcPlannerTest, SolvesPublishedProblems) {
  PLANBENCH_NEED_SHARED_DATA("problems/table_pick_fetch");
  const Robot fetch = LoadFetch();
  const std::unique_ptr<Planner> planner = MakeForContract(fetch);
  const ProblemSet set = ListProblemSet(SharedData("problems/table_pick_fetch"));
  for (const int index : {1, 2, 3}) {
    const ProblemFiles* files = set.Find(index);
    ASSERT_NE(files, nullptr);
    const Problem problem = ReadProblem(files->scene, files->request, fetch);
    PlanRequest request;
    request.group = problem.group;
    request.start = problem.start;
    request.goal = problem.goal;
    request.time_limit_s = 120;
    const PlanResult result = planner->Plan(request, problem.scene, nullptr);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << index << ": " << result.message;
  }
}

TEST_F(RrtcPlannerTest, BothCollisionEnginesLeadToTheSamePaths) {
  ExpectSamePathsFromBothEngines([](const Robot& robot) {
    return MakeRrtcPlanner(robot, YamlNode::Parse("{}", "rrtc.yaml"));
  });
}

}  // namespace
}  // namespace planbench
