#include "benchmark_driver/line_up.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class LineUpTest : public testing::Test {
 protected:
  LineUpTest() {
    folder_.Write("robot/rrtc_study.yaml", "range: 2");
    folder_.Write("lineups/near.yaml", "range: 1");
  }
  std::filesystem::path robot() const { return folder_.path() / "robot"; }
  std::filesystem::path Write(const std::string& text) {
    folder_.Write("lineups/test.yaml", text);
    return folder_.path() / "lineups/test.yaml";
  }
  std::vector<LineUpEntry> Read(const std::string& text) {
    return ReadLineUp(Write(text), robot());
  }
  void ExpectRefused(const std::string& text, std::vector<std::string> parts) {
    parts.emplace_back("test.yaml");
    ExpectInputError([&] { Read(text); }, parts);
  }
  LineUpFlags Flags(const std::string& text) {
    LineUpFlags flags;
    flags.file = Write(text);
    return flags;
  }

  TemporaryFolder folder_;
};

std::vector<std::string> Planners(const std::vector<LineUpEntry>& entries) {
  std::vector<std::string> planners;
  for (const LineUpEntry& entry : entries) planners.push_back(entry.contestant.planner);
  return planners;
}

TEST_F(LineUpTest, ReadsEverythingAContestantCanBe) {
  const auto entries = Read(R"(contestants:
  study:
    name: RRTConnect (study)
    about: as the study ran it
    published: RRT-Connect
    program: rrtc
    config: rrtc_study.yaml
    set: {range: 0.5, balance: false}
    collision_model: voxels
    edge_resolution: 0.05
    edge_check: fixed
    directions: both
  ara: {config: near.yaml}
  mine: {command: ./mine --fast}
)");
  ASSERT_THAT(Planners(entries), ElementsAre("study", "ara", "mine"));
  const LineUpEntry& study = entries[0];
  EXPECT_EQ(study.contestant.name, "RRTConnect (study)");
  EXPECT_EQ(study.contestant.about, "as the study ran it");
  EXPECT_EQ(study.contestant.published, "RRT-Connect");
  EXPECT_EQ(study.program, "rrtc");
  EXPECT_EQ(study.config, robot() / "rrtc_study.yaml");
  EXPECT_THAT(study.settings, ElementsAre("range=0.5", "balance=false"));
  EXPECT_EQ(study.contestant.collision_model, CollisionModel::kVoxels);
  EXPECT_EQ(study.contestant.edge_resolution_m, 0.05);
  EXPECT_EQ(study.contestant.edge_check, EdgeCheck::kFixed);
  EXPECT_EQ(study.directions, Directions::kBoth);

  const LineUpEntry& ara = entries[1];
  EXPECT_EQ(ara.program, "ara");
  EXPECT_EQ(ara.config, folder_.path() / "lineups/near.yaml");
  EXPECT_EQ(ara.contestant.name, "");
  EXPECT_FALSE(ara.contestant.collision_model || ara.contestant.edge_resolution_m ||
               ara.contestant.edge_check || ara.directions);
  EXPECT_EQ(entries[2].contestant.command, "./mine --fast");
}

TEST_F(LineUpTest, ASweepIsAContestantForEachValue) {
  const auto entries = Read(R"(contestants:
  rrtc:
    name: RRT-Connect
    set: {sampler: halton}
    sweep: {range: [0.5, 1], balance: [true, false]}
)");
  EXPECT_THAT(Planners(entries),
              ElementsAre("rrtc_range_0_5_balance_true", "rrtc_range_0_5_balance_false",
                          "rrtc_range_1_balance_true", "rrtc_range_1_balance_false"));
  EXPECT_EQ(entries[1].contestant.name, "RRT-Connect, range 0.5, balance false");
  EXPECT_EQ(entries[1].program, "rrtc");
  EXPECT_THAT(entries[1].settings, ElementsAre("sampler=halton", "range=0.5", "balance=false"));
}

TEST_F(LineUpTest, SettingsThatAreMapsAndListsAreHandedOnAsTheFlagHasThem) {
  const auto entries = Read(R"(contestants:
  rrtc:
    set: {algorithm: RRT, ompl: {range: 2, far: {down: 1}}, crowding_joints: [lift, "a, b"]}
    sweep: {ompl.goal_bias: [0.05, 0.5]}
  a: {sweep: {cells: {roll: [0.1, 0.2]}, joints: [[lift], [lift, roll]]}}
)");
  EXPECT_THAT(
      Planners(entries),
      ElementsAre("rrtc_ompl_goal_bias_0_05", "rrtc_ompl_goal_bias_0_5",
                  "a_cells_roll_0_1_joints__lift_", "a_cells_roll_0_1_joints__lift__roll_",
                  "a_cells_roll_0_2_joints__lift_", "a_cells_roll_0_2_joints__lift__roll_"));
  EXPECT_THAT(entries[1].settings,
              ElementsAre("algorithm=RRT", "ompl.range=2", "ompl.far.down=1",
                          "crowding_joints=[lift, \"a, b\"]", "ompl.goal_bias=0.5"));
  EXPECT_THAT(entries[3].settings, ElementsAre("cells.roll=0.1", "joints=[lift, roll]"));
}

TEST_F(LineUpTest, SettingsKnowWhereTheyStand) {
  LineUpFlags flags = Flags(R"(contestants:
  rrtc:
    set: {algorithm: RRT, ompl: {range: 2}}
    sweep: {metric: [l1, l2]}
)");
  flags.settings = {{"rrtc", "ompl.delay=1"}, {"rrtc", "algorithm=PRM"}};
  const std::string at = flags.file->string() + ":";
  const auto entries = MakeLineUp(flags, robot());
  EXPECT_EQ(entries[1].origins, (std::map<std::string, std::string>{
                                    {"algorithm", "--set rrtc.algorithm"},
                                    {"ompl.range", at + "3: contestants.rrtc.set.ompl.range"},
                                    {"metric", at + "4: contestants.rrtc.sweep.metric[1]"},
                                    {"ompl.delay", "--set rrtc.ompl.delay"}}));
}

TEST_F(LineUpTest, KeysOfTheFileThatBeginWithXAreForAnchors) {
  const auto entries = Read(R"(x-fine: &fine {edge_check: fixed, edge_resolution: 0.01}
contestants:
  ara: {<<: *fine}
  rrtc: {<<: *fine, edge_resolution: 0.02}
)");
  EXPECT_EQ(entries[0].contestant.edge_resolution_m, 0.01);
  EXPECT_EQ(entries[1].contestant.edge_check, EdgeCheck::kFixed);
  ExpectRefused("contestants: {ara: {x-fine: 1}}", {"unknown key 'x-fine'"});
}

TEST_F(LineUpTest, TheNameOfASweepStandsForAllOfIt) {
  LineUpFlags flags = Flags(R"(contestants:
  chomp: {program: trajopt, first_path_of: rrtc_range_2}
  improved: {program: trajopt, first_path_of: rrtc}
  rrtc: {sweep: {range: [1, 2]}}
)");
  flags.planners = {"rrtc", "chomp"};
  flags.settings = {{"rrtc", "balance=false"}, {"rrtc_range_2", "sampler=halton"}};
  const auto entries = MakeLineUp(flags, robot());
  EXPECT_THAT(Planners(entries), ElementsAre("rrtc_range_1", "rrtc_range_2", "chomp"));
  EXPECT_THAT(entries[0].settings, ElementsAre("range=1", "balance=false"));
  EXPECT_THAT(entries[1].settings, ElementsAre("range=2", "balance=false", "sampler=halton"));
  EXPECT_EQ(entries[2].contestant.first_path_of, "rrtc_range_2");

  for (const std::string name : {"rrtc", "rrtc_range_1"}) {
    flags.settings = {{name, "range=3"}};
    ExpectInputError([&] { MakeLineUp(flags, robot()); },
                     {"--set", "'rrtc_range_1'", "range", "sweep"});
  }
  flags.settings = {};
  flags.commands = {{"rrtc", "./rrtc"}};
  ExpectInputError([&] { MakeLineUp(flags, robot()); },
                   {"--planner-command", "'rrtc' stands for several", "rrtc_range_1"});
  flags.commands = {};
  flags.planners = {"rrtc", "improved"};
  ExpectInputError(
      [&] { MakeLineUp(flags, robot()); },
      {"'improved': first_path_of: 'rrtc' stands for several", "rrtc_range_1, rrtc_range_2"});
  flags.planners = {"improved", "rrtc_range_2"};
  flags.settings = {};
  EXPECT_EQ(MakeLineUp(flags, robot())[0].contestant.first_path_of, "rrtc_range_2");
}

TEST_F(LineUpTest, MapsOfASweepAreTheSweeps) {
  LineUpFlags flags = Flags("contestants: {rrt: {program: rrtc, sweep: {ompl.goal_bias: [0.1]}}}");
  flags.settings = {{"rrt", "ompl={goal_bias: 0.2}"}};
  ExpectInputError([&] { MakeLineUp(flags, robot()); }, {"--set", "ompl.goal_bias"});
  flags.settings = {{"rrt", "ompl.goal=0.2"}};
  EXPECT_NO_THROW(MakeLineUp(flags, robot()));
}

TEST_F(LineUpTest, TheExamplesOfTheDocumentationAreRead) {
  folder_.Write("lineups/rrtc_fine.yaml", "");  // A file of the reader's own.
  std::ifstream file(std::filesystem::path(PLANBENCH_SOURCE_DIR) / "docs" / "lineups.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string fence = "```yaml\n";
  int examples = 0;
  for (std::size_t at = text.find(fence); at != std::string::npos; at = text.find(fence, at)) {
    at += fence.size();
    const std::string example = text.substr(at, text.find("```", at) - at);
    SCOPED_TRACE(example);
    EXPECT_NO_THROW(MakeLineUp(Flags(example), robot()));
    ++examples;
  }
  EXPECT_GE(examples, 1);
}

TEST_F(LineUpTest, BadFilesAreRefusedByLineAndField) {
  ExpectRefused("contestants: {}", {"contestants", "no contestant"});
  ExpectRefused("lineup: {}", {":1", "lineup"});
  ExpectRefused("contestants:\n  ara: {colision_model: voxels}", {":2", "colision_model"});
  ExpectRefused("contestants:\n  ara: {collision_model: balls}",
                {":2", "spheres, voxels, meshes or enclosing"});
  for (const std::string step : {"0", "1e300", "1e-320"}) {
    ExpectRefused("contestants:\n  ara: {edge_resolution: " + step + "}",
                  {":2", "edge_resolution", "from 1e-06 to 1"});
  }
  ExpectRefused("contestants:\n  ara: {directions: up}", {":2", "auto, forward, backward or both"});
  ExpectRefused("contestants:\n  ara: {config: none.yaml}", {":2", "config", robot().string()});
  ExpectRefused("contestants:\n  ara: {sweep: {range: []}}", {":2", "range", "no value"});
  ExpectRefused("contestants:\n  ara: {set: {a: [{b: 1}]}}", {":2", "set.a", "a map"});
  ExpectRefused("contestants:\n  ara: {sweep: {range: 1}}", {":2", "range", "sequence"});
  ExpectRefused("contestants:\n  a b: {}", {":2", "a b", "letters"});
  ExpectRefused("contestants:\n  ara: {command: ./x, set: {a: 1}}", {":2", "set", "command"});
  ExpectRefused("contestants:\n  ara: {sweep: {a_very_long_name_of_a_setting: [100000000000]}}",
                {":2", "sweep", "letters"});
}

TEST_F(LineUpTest, WithoutARobotFolderNoSettingsFileIsLookedFor) {
  const auto file = Write("contestants: {ara: {config: none.yaml}}");
  EXPECT_FALSE(ReadLineUp(file, std::nullopt)[0].config);
}

TEST_F(LineUpTest, WithoutAFileThePlannersAreThemselves) {
  EXPECT_THAT(Planners(MakeLineUp({}, std::nullopt)), ElementsAre("ara", "rrtc"));
  LineUpFlags flags;
  flags.planners = {"mine", "ara"};
  flags.commands = {{"mine", "./mine"}};
  flags.settings = {{"ara", "epsilon_initial=5"}};
  const auto entries = MakeLineUp(flags, std::nullopt);
  EXPECT_THAT(Planners(entries), ElementsAre("mine", "ara"));
  EXPECT_EQ(entries[0].contestant.command, "./mine");
  EXPECT_EQ(entries[1].program, "ara");
  EXPECT_THAT(entries[1].settings, ElementsAre("epsilon_initial=5"));
}

TEST_F(LineUpTest, PlannersPickFromTheFile) {
  LineUpFlags flags = Flags("contestants: {a: {program: ara}, b: {program: rrtc}, c: {}}");
  flags.planners = {"c", "a"};
  EXPECT_THAT(Planners(MakeLineUp(flags, robot())), ElementsAre("c", "a"));
  flags.planners = {"d"};
  ExpectInputError([&] { MakeLineUp(flags, robot()); }, {"--planners", "'d'", "a, b, c"});
}

TEST_F(LineUpTest, NamesMustBeDistinct) {
  ExpectInputError([&] { MakeLineUp(Flags("contestants: {a: {name: X}, b: {name: X}}"), robot()); },
                   {"'a'", "'b'", "'X'"});
  ExpectInputError([&] { MakeLineUp(Flags("contestants: {ara-2: {}, Ara_2: {}}"), robot()); },
                   {"'ara-2'", "'Ara_2'", "PLAN_REQUEST_ARA_2"});
}

TEST_F(LineUpTest, CommandsAndSettingsAreOfThosePicked) {
  LineUpFlags flags = Flags("contestants: {a: {command: ./a}, b: {}}");
  flags.commands = {{"x", "./x"}};
  ExpectInputError([&] { MakeLineUp(flags, robot()); }, {"--planner-command", "'x'"});
  flags.commands = {{"a", "./x"}};
  ExpectInputError([&] { MakeLineUp(flags, robot()); }, {"--planner-command", "'a'", "already"});
  flags.commands = {};
  flags.settings = {{"a", "range=1"}};
  ExpectInputError([&] { MakeLineUp(flags, robot()); }, {"--set", "'a'", "command"});
  flags.settings = {{"x", "range=1"}};
  ExpectInputError([&] { MakeLineUp(flags, robot()); }, {"--set", "'x'"});
}

TEST_F(LineUpTest, NoPlannerIsCalledAsAnotherProcessOfTheSession) {
  for (const std::string name : {"driver", "logger", "scene_server"}) {
    LineUpFlags flags = Flags("contestants: {" + name + ": {program: rrtc}}");
    ExpectInputError([&] { MakeLineUp(flags, robot()); }, {"called '" + name + "'"});
    flags.file.reset();
    flags.planners = {name};
    flags.commands = {{name, "./mine"}};
    ExpectInputError([&] { MakeLineUp(flags, robot()); }, {"called '" + name + "'"});
  }
}

TEST_F(LineUpTest, WhatIsThereSaysSomething) {
  for (const char* key : {"name", "command", "published", "first_path_of"}) {
    for (const char* text : {"\"\"", "'  '"}) {
      ExpectInputError([&] { Read(fmt::format("contestants:\n  a: {{{}: {}}}", key, text)); },
                       {fmt::format("a.{}", key), "says nothing"});
    }
  }
}

TEST_F(LineUpTest, FiguresArePublishedOfTheStudysPlanners) {
  EXPECT_EQ(Read("contestants: {a: {published: ARA*}}").at(0).contestant.published, "ARA*");
  ExpectInputError([&] { Read("contestants:\n  a: {published: RRTConnect}"); },
                   {":2", "a.published", "'RRTConnect'", "ARA*, RRT-Connect"});
}

TEST_F(LineUpTest, AFirstPathIsOfAnotherWhoFindsItAlone) {
  const std::string text = R"(contestants:
  chomp: {program: trajopt, first_path_of: rrtc}
  rrtc: {}
  stomp: {program: trajopt, first_path_of: chomp}
  self: {program: trajopt, first_path_of: self}
  lost: {program: trajopt, first_path_of: nobody}
)";
  LineUpFlags flags = Flags(text);
  flags.planners = {"chomp", "rrtc"};
  EXPECT_EQ(MakeLineUp(flags, robot()).at(0).contestant.first_path_of, "rrtc");
  ExpectInputError([&] { RequireNoFirstPaths(MakeLineUp(flags, robot())); },
                   {"--parallel", "'rrtc' cannot search for 'chomp'"});
  const auto expect_refused = [&](const std::vector<std::string>& planners,
                                  const std::vector<std::string>& parts) {
    flags.planners = planners;
    ExpectInputError([&] { MakeLineUp(flags, robot()); }, parts);
  };
  expect_refused({"lost"}, {"'lost'", "first_path_of", "'nobody' is not among the planners: lost"});
  expect_refused({"stomp", "chomp", "rrtc"}, {"'stomp'", "'chomp' does not find a path by itself"});
  expect_refused({"self"}, {"'self' does not find a path by itself"});

  flags.planners = {"chomp"};
  flags.settings = {{"rrtc", "range=1"}};
  const auto entries = MakeLineUp(flags, robot());
  EXPECT_THAT(Planners(entries), ElementsAre("chomp", "rrtc"));
  EXPECT_FALSE(entries[0].finds_first_paths_only);
  EXPECT_TRUE(entries[1].finds_first_paths_only) << "it was not chosen";
  EXPECT_THAT(entries[1].settings, ElementsAre("range=1"));
}

}  // namespace
}  // namespace planbench
