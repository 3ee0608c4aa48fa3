#include "benchmark_driver/driver_flags.h"

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/error.h"
#include "results/recorded_flags.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

/// Options of a command line. Throws InputError for whatever is wrong with it.
DriverOptions ParseFlags(std::vector<std::string> arguments,
                         std::map<std::string, std::string>* flags = nullptr) {
  CLI::App app;
  DriverOptions options;
  AddDriverFlags(&app, &options);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());  // as programs do
  }
  if (flags != nullptr) *flags = FlagsOf(app);
  return options;
}

void ExpectRefused(const std::vector<std::string>& arguments,
                   const std::vector<std::string>& parts) {
  ExpectInputError([&] { ParseFlags(arguments); }, parts);
}

const std::vector<std::string> kLaunch = {"--launch", "--robot", "r", "--problems", "p"};

std::vector<std::string> Launch(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = kLaunch;
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(ParseRangeTest, ReadsNumbersAndRanges) {
  EXPECT_EQ(ParseRange("3"), std::vector<int>{3});
  EXPECT_EQ(ParseRange("0"), std::vector<int>{0});
  EXPECT_EQ(ParseRange("1-4"), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(ParseRange("5-5"), std::vector<int>{5});
  EXPECT_EQ(ParseRange("10-12,1-2,8"), (std::vector<int>{1, 2, 8, 10, 11, 12}));
  EXPECT_EQ(ParseRange("1-3,2-4"), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(ParseRange("1-100").size(), 100u);
}

TEST(ParseShardTest, TakesOneOfSeveralAndRefusesTheRest) {
  const Shard shard = ParseShard("2/8");
  EXPECT_EQ(shard.index, 2);
  EXPECT_EQ(shard.count, 8);
  EXPECT_EQ(ParseShard("1/1000000").count, 1'000'000) << "as many as a plan may have";
  for (const char* text : {"", "1", "1/", "/2", "0/2", "3/2", "-1/2", "1/2/3", "1 /2", "a/b", "1/0",
                           "1/99999999999", "1/1000001"}) {
    ExpectInputError([&] { ParseShard(text); }, {std::string("--shard ") + text, "I/N"});
  }
}

TEST(ParseRangeTest, RefusesWhatIsNoRange) {
  for (const char* text : {"a", "1-", "-1", "-", "1-2-3", "4-1", "1,,2", "1,", ",1", " 1", "1.5",
                           "+1", "99999999999", "0-2000000000"}) {
    ExpectInputError([&] { ParseRange(text); }, {"--problems-range", text});
  }
}

TEST(DriverFlagsTest, DefaultsAreTheStudys) {
  const DriverOptions options = ParseFlags({});
  EXPECT_TRUE(options.sets.empty());
  EXPECT_TRUE(options.problem_indices.empty());
  EXPECT_FALSE(options.line_up.file);
  EXPECT_TRUE(options.line_up.planners.empty());
  EXPECT_EQ(options.directions, Directions::kAuto);
  EXPECT_EQ(options.conditions.request.time_limit_s, 60);
  EXPECT_EQ(options.trials, 1);
  EXPECT_EQ(options.conditions.request.seed, 1u);
  EXPECT_EQ(options.conditions.request.collision_model, CollisionModel::kSpheres);
  EXPECT_FALSE(options.conditions.request.anytime);
  EXPECT_TRUE(options.conditions.request.simplify);
  EXPECT_TRUE(options.conditions.with_clearance);
  EXPECT_FALSE(options.conditions.parallel);
  EXPECT_FALSE(options.launch);
}

TEST(DriverFlagsTest, WhatASharedMachineDoesCanBeLimited) {
  const DriverOptions defaults = ParseFlags({});
  EXPECT_EQ(defaults.max_disturbance, 0.1);
  EXPECT_FALSE(defaults.repeat_disturbed);
  const DriverOptions options = ParseFlags({"--max-disturbance", "0.5", "--repeat-disturbed"});
  EXPECT_EQ(options.max_disturbance, 0.5);
  EXPECT_TRUE(options.repeat_disturbed);
  ExpectRefused({"--max-disturbance", "0"}, {"--max-disturbance"});
  ExpectRefused({"--max-disturbance", "nan"}, {"--max-disturbance"});
  ExpectRefused({"--max-disturbance", "2"}, {"at most 1"});

  const std::vector<int> usable = UsableProcessors();
  const std::string last = fmt::format("{}", usable.back());
  if (usable.size() > 1) {
    EXPECT_EQ(ParseFlags(Launch({"--pin", last})).pinned, std::vector<int>{usable.back()});
  }
  ExpectRefused(Launch({"--pin", "4095"}), {"--pin 4095", "there is no processor 4095"});
  ExpectRefused(Launch({"--pin", fmt::format("{}", fmt::join(usable, ","))}), {"is left"});
  ExpectRefused(Launch({"--pin", "x"}), {"--pin x", "is no number"});
  ExpectRefused({"--pin", last}, {"--launch"});
}

TEST(DriverFlagsTest, ReadsEveryFlag) {
  std::map<std::string, std::string> flags;
  const DriverOptions options = ParseFlags(Launch({"--sets",
                                                   "a,b",
                                                   "--problems-range",
                                                   "1-2",
                                                   "--lineup",
                                                   "l.yaml",
                                                   "--planners",
                                                   "x,y",
                                                   "--directions",
                                                   "backward",
                                                   "--time",
                                                   "2.5",
                                                   "--trials",
                                                   "3",
                                                   "--seed",
                                                   "18446744073709551615",
                                                   "--collision-model",
                                                   "meshes",
                                                   "--edge-resolution",
                                                   "0.05",
                                                   "--referee-step",
                                                   "0.01",
                                                   "--anytime",
                                                   "--no-simplify",
                                                   "--no-clearance",
                                                   "--parallel",
                                                   "--discovery-timeout",
                                                   "7",
                                                   "--problems",
                                                   "q",
                                                   "--referee-robot",
                                                   "m",
                                                   "--spheres",
                                                   "s.yaml",
                                                   "--package-path",
                                                   "f=/a",
                                                   "--package-path",
                                                   "g=/b",
                                                   "--out",
                                                   "o",
                                                   "--planner-command",
                                                   "y=./y --fast=1",
                                                   "--set",
                                                   "x.ompl.step=3",
                                                   "--set",
                                                   "x.name=a=b"}),
                                           &flags);
  EXPECT_EQ(options.sets, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(options.problem_indices, (std::vector<int>{1, 2}));
  EXPECT_EQ(options.line_up.file, "l.yaml");
  EXPECT_EQ(options.line_up.planners, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(options.directions, Directions::kBackward);
  EXPECT_EQ(options.conditions.request.time_limit_s, 2.5);
  EXPECT_EQ(options.trials, 3);
  EXPECT_EQ(options.conditions.request.seed, 18446744073709551615u);
  EXPECT_EQ(options.conditions.request.collision_model, CollisionModel::kMeshes);
  EXPECT_EQ(options.conditions.request.edge_resolution_m, 0.05);
  EXPECT_EQ(options.conditions.referee_step_m, 0.01);
  EXPECT_TRUE(options.conditions.request.anytime);
  EXPECT_FALSE(options.conditions.request.simplify);
  EXPECT_FALSE(options.conditions.with_clearance);
  EXPECT_TRUE(options.conditions.parallel);
  EXPECT_EQ(options.discovery_timeout_s, 7);
  EXPECT_EQ(options.robot.folder, "r");
  EXPECT_EQ(options.robot.spheres, "s.yaml");
  EXPECT_EQ(options.problems, (std::vector<std::filesystem::path>{"p", "q"}));
  EXPECT_EQ(options.referee_robot, "m");
  EXPECT_EQ(options.robot.package_paths, (std::vector<std::string>{"f=/a", "g=/b"}));
  EXPECT_EQ(options.out, "o");
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(options.line_up.commands, (Pairs{{"y", "./y --fast=1"}}));
  EXPECT_EQ(options.line_up.settings, (Pairs{{"x", "ompl.step=3"}, {"x", "name=a=b"}}));

  EXPECT_EQ(flags.at("time"), "2.5");
  EXPECT_EQ(flags.at("problems-range"), "1-2");
  EXPECT_EQ(flags.at("set"), "x.ompl.step=3,x.name=a=b");
  EXPECT_EQ(flags.at("anytime"), "true");
  EXPECT_EQ(flags.at("no-simplify"), "true");
}

TEST(DriverFlagsTest, ValuesOfFlagsThatTakeSeveralAreToldApart) {
  CLI::App app;
  DriverOptions options;
  AddDriverFlags(&app, &options);
  for (const CLI::Option* option : app.get_options()) {
    const bool repeats = option->get_items_expected_max() > 1 && option->get_delimiter() == '\0';
    EXPECT_EQ(TakesSeveralValues(option->get_single_name()), repeats) << option->get_name();
  }
  std::map<std::string, std::string> flags;
  ParseFlags(
      {"--launch", "--robot", "r", "--problems", "/p", "--problems", "/c,d", "--set", "x.y=a,b=c"},
      &flags);
  EXPECT_EQ(SplitFlagValues(flags.at("problems")), (std::vector<std::string>{"/p", "/c,d"}));
  EXPECT_EQ(SplitFlagValues(flags.at("set")), std::vector<std::string>{"x.y=a,b=c"});
}

TEST(DriverFlagsTest, TheRefereesStepTellsItsDefaultAndTheMostSamples) {
  CLI::App app;
  DriverOptions options;
  AddDriverFlags(&app, &options);
  const std::string help = app.get_option("--referee-step")->get_description();
  EXPECT_THAT(help, testing::HasSubstr("half the edge resolution, 0.0002 m at least"));
  EXPECT_THAT(help, testing::HasSubstr("more than 1000000 samples"));
}

TEST(DriverFlagsTest, RecordsWhatWasNotGivenToo) {
  std::map<std::string, std::string> flags;
  ParseFlags({}, &flags);
  EXPECT_EQ(flags.at("time"), "60");
  EXPECT_EQ(flags.at("planners"), "");
  EXPECT_EQ(flags.at("directions"), "auto");
  EXPECT_EQ(flags.at("collision-model"), "spheres");
  EXPECT_EQ(flags.at("sets"), "");
  EXPECT_EQ(flags.at("edge-resolution"), "");
  EXPECT_EQ(flags.at("anytime"), "false");
  EXPECT_FALSE(flags.contains("help"));
}

TEST(DriverFlagsTest, FilesAndFoldersAreRecordedSoThatTheyHoldFromElsewhere) {
  const TemporaryFolder folder;
  folder.Write("robots/mine/robot.yaml", "");
  const std::filesystem::path robot =
      (folder / "robots/mine").lexically_relative(std::filesystem::current_path());
  ASSERT_TRUE(robot.is_relative());
  std::map<std::string, std::string> flags;
  ParseFlags(Launch({"--problems",
                     "./x/../q,1",
                     "--referee-robot",
                     "m",
                     "--spheres",
                     "s.yaml",
                     "--package-path",
                     "f=../a",
                     "--lineup",
                     "l.yaml",
                     "--reference",
                     "Planner A=b=c.csv",
                     "--out",
                     "o",
                     "--set",
                     "x.primitives=p.yaml",
                     "--planners",
                     "x,y",
                     "--planner-command",
                     "y=./y"}),
             &flags);
  const std::filesystem::path here = std::filesystem::current_path();
  const auto from_here = [&](const char* path) { return (here / path).string(); };
  EXPECT_EQ(flags.at("robot"), "r") << "the name of one that ships, for all that is known here";
  EXPECT_EQ(SplitFlagValues(flags.at("problems")),
            (std::vector<std::string>{from_here("p"), from_here("q,1")}));
  EXPECT_EQ(flags.at("referee-robot"), "m") << "likewise";
  EXPECT_EQ(flags.at("spheres"), from_here("s.yaml"));
  EXPECT_EQ(flags.at("package-path"), "f=" + (here.parent_path() / "a").string());
  EXPECT_EQ(flags.at("lineup"), from_here("l.yaml"));
  EXPECT_EQ(flags.at("reference"), "Planner A=" + from_here("b=c.csv"));
  EXPECT_EQ(flags.at("out"), from_here("o"));
  EXPECT_EQ(flags.at("set"), "x.primitives=p.yaml") << "which begins at the robot's folder";
  EXPECT_EQ(flags.at("planner-command"), "y=./y");
  EXPECT_EQ(flags.at("planners"), "x,y");

  const std::string meshes = robot.parent_path().string();
  const DriverOptions options = ParseFlags({"--launch", "--robot", robot.string(), "--problems",
                                            "/p", "--resume", "../s", "--referee-robot", meshes},
                                           &flags);
  EXPECT_EQ(flags.at("robot"), (folder / "robots/mine").string());
  EXPECT_EQ(flags.at("referee-robot"), (folder / "robots").string()) << "one without a robot.yaml";
  EXPECT_EQ(flags.at("problems"), "/p");
  EXPECT_EQ(flags.at("resume"), (here.parent_path() / "s").string());
  EXPECT_EQ(options.robot.folder, robot) << "what is done does not depend on what is recorded";

  std::filesystem::remove(folder / "robots/mine/robot.yaml");
  ParseFlags({"--launch", "--robot", robot.string(), "--problems", "/p"}, &flags);
  EXPECT_EQ(flags.at("robot"), robot) << "a folder of that name may be beside a robot that ships";
}

TEST(DriverFlagsTest, RefusesBadValuesByTheFlag) {
  ExpectRefused({"--directions", "sideways"}, {"--directions", "sideways"});
  ExpectRefused({"--collision-model", "lidar"}, {"--collision-model", "lidar"});
  ExpectRefused({"--time", "0"}, {"--time"});
  ExpectRefused({"--time", "-1"}, {"--time"});
  ExpectRefused({"--time", "nan"}, {"--time"});
  ExpectRefused({"--time", "inf"}, {"--time"});
  ExpectRefused({"--time", "1e12"}, {"--time"});
  ExpectRefused({"--trials", "0"}, {"--trials"});
  for (const char* seed : {"-1", "18446744073709551616", "1.5", "x", ""}) {
    ExpectRefused({"--seed", seed}, {"--seed"});
  }
  ExpectRefused({"--edge-resolution", "-0.1"}, {"--edge-resolution"});
  for (const char* step : {"nan", "x", "1e300", "1e-320"}) {
    ExpectRefused({"--edge-resolution", step}, {"--edge-resolution", "is not from 1e-06 to 1"});
    ExpectRefused({"--referee-step", step}, {"--referee-step"});
  }
  ExpectRefused({"--discovery-timeout", "0"}, {"--discovery-timeout"});
  ExpectRefused({"--discovery-timeout", "1e16"}, {"--discovery-timeout"});
  ExpectRefused({"--planners", ""}, {"--planners"});
  ExpectRefused({"--planners", "a,a"}, {"--planners", "'a'"});
  ExpectRefused({"--problems-range", "x"}, {"--problems-range"});
}

TEST(DriverFlagsTest, WhatIsStartedAgainHasAsLongToComeUpAsTheFirstTime) {
  DriverOptions options;
  options.discovery_timeout_s = 90;
  EXPECT_EQ(options.TimeToComeBack(), std::chrono::seconds(90));
  options.launch = true;  // where it is killed first
  EXPECT_EQ(options.TimeToComeBack(), std::chrono::seconds(90) + Supervisor::kMostSilence);
}

TEST(DriverFlagsTest, RefusesBadLaunchFlags) {
  ExpectRefused({"--launch", "--problems", "p"}, {"--robot"});
  ExpectRefused({"--launch", "--robot", "r"}, {"--problems"});
  ExpectRefused(Launch({"--resume", "s", "--out", "o"}), {"--resume", "--out"});
  ExpectRefused(Launch({"--planner-command", "./y"}), {"--planner-command", "./y"});
  ExpectRefused(Launch({"--planner-command", "y="}), {"--planner-command", "y="});
  ExpectRefused(Launch({"--set", "x=1"}), {"--set", "x=1"});
  ExpectRefused(Launch({"--set", ".k=1"}), {"--set", ".k=1"});
  ExpectRefused(Launch({"--set", "x.k"}), {"--set", "x.k"});
  ExpectRefused(Launch({"--set", "x=k.1"}), {"--set", "x=k.1"});
  ExpectRefused(Launch({"--set", "x.=1"}), {"--set", "x.=1"});
}

TEST(DriverFlagsTest, ProcessesThatAreLaunchedMayHaveSoManyProblems) {
  std::map<std::string, std::string> flags;
  EXPECT_FALSE(ParseFlags(kLaunch, &flags).problems_per_process);
  EXPECT_EQ(flags.at("problems-per-process"), "");
  const std::vector<std::string> ten = {"--problems-per-process", "10"};
  EXPECT_EQ(ParseFlags(Launch(ten), &flags).problems_per_process, 10);
  EXPECT_EQ(flags.at("problems-per-process"), "10");
  ExpectRefused(ten, {"--problems-per-process", "--launch"});
  ExpectRefused(Launch({"--problems-per-process", "0"}), {"--problems-per-process"});
  ExpectRefused(Launch({"--problems-per-process", "10", "--replay", "a.lcmlog"}),
                {"--problems-per-process", "--replay"});
}

TEST(DriverFlagsTest, AReplayTakesItsRequestsFromTheLog) {
  EXPECT_EQ(ParseFlags({"--replay", "a.lcmlog", "--planners", "x"}).replay, "a.lcmlog");
  // Without --problems.
  EXPECT_TRUE(ParseFlags({"--replay", "a.lcmlog", "--launch", "--robot", "r"}).launch);
  ExpectRefused({"--replay", "a.lcmlog", "--time", "3"}, {"--replay", "--time"});
  ExpectRefused({"--replay", "a.lcmlog", "--resume", "s"}, {"--replay", "--resume"});
  EXPECT_EQ(ParseFlags(Launch({"--replay", "a.lcmlog"})).problems.size(), 1u)
      << "for planners that need a scene server";
}

TEST(DriverFlagsTest, LaunchFlagsNeedLaunch) {
  ExpectRefused({"--robot", "r"}, {"--robot", "--launch"});
  ExpectRefused({"--out", "o"}, {"--out", "--launch"});
}

TEST(DriverFlagsTest, NumbersMustBeNumbers) {
  ExpectRefused({"--seed", "-1"}, {"--seed"});
  ExpectRefused({"--trials", "many"}, {"--trials", "many"});
}

}  // namespace
}  // namespace planbench
