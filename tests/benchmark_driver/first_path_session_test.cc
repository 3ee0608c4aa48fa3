#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/benchmark_driver/driver_fixture.h"

namespace planbench {
namespace {

TEST_F(DriverTest, OneWhoIsGivenAPathMustImproveIt) {
  const FakePlanner planner(&bus_);
  const FakePlanner first(&bus_, "first");
  const FakeSceneServer server(&bus_);
  std::vector<LineUpEntry> line_up = LineUp({"arm", "first"});
  line_up[0].contestant.first_path_of = "first";
  Driver driver(&bus_, Options(), line_up, {});
  ExpectInputError([&] { driver.Discover(false, Idle); },
                   {"first_path_of", "'arm' does not improve paths"});
}

/// "arm" improves what "first" finds.
class FirstPathSessionTest : public DriverTest {
 protected:
  FirstPathSessionTest() {
    planner_.status.can_improve = true;
    Reannounce(&planner_);
    line_up_[0].contestant.first_path_of = "first";
  }

  FakePlanner planner_{&bus_};
  FakePlanner first_{&bus_, "first"};
  const FakeSceneServer server_{&bus_};
  FakeLogger logger_{&bus_};
  std::vector<LineUpEntry> line_up_ = LineUp({"arm", "first"});
};

TEST_F(FirstPathSessionTest, WhatTheFirstPathsPlannerLearnedFromIsTold) {
  first_.status.settings["learned_from"] = "books, cans";
  first_.status.settings["learned_scenes"] = "01234567";
  Reannounce(&first_);
  Driver driver(&bus_, Options(), line_up_, {});
  MakeAll(&driver);
  ASSERT_FALSE(driver.runs().empty());
  for (const RunRecordMessage& record : logger_.records().messages()) {
    if (record.planner != "arm") continue;
    EXPECT_EQ(record.settings.at("first_path_of"), "first");
    EXPECT_EQ(record.settings.at("first_path_learned_from"), "books, cans");
    EXPECT_EQ(record.settings.at("first_path_learned_scenes"), "01234567");
  }
}

TEST_F(FirstPathSessionTest, WhoFindsFirstPathsOnlyIsNoContestantAndNeedNotBeAnytime) {
  planner_.status.can_anytime = true;
  Reannounce(&planner_);
  line_up_[1].finds_first_paths_only = true;
  DriverOptions options = Options();
  options.conditions.request.anytime = true;
  Driver driver(&bus_, options, line_up_, {});
  MakeAll(&driver);
  ASSERT_EQ(driver.conditions().contestants.size(), 1u);
  EXPECT_EQ(driver.conditions().contestants[0].name, "Fake* after Fake*");
  ASSERT_FALSE(logger_.records().messages().empty());
  for (const RunRecordMessage& record : logger_.records().messages()) {
    EXPECT_EQ(record.planner, "arm");
  }
  ASSERT_FALSE(first_.requests().messages().empty());
  for (const PlanRequest& request : first_.requests().messages()) EXPECT_FALSE(request.anytime);
}

TEST_F(FirstPathSessionTest, HowWhoFindsFirstPathsOnlyChecksIsACondition) {
  first_.status.collision_models.emplace_back("voxels");
  Reannounce(&first_);
  line_up_[1].finds_first_paths_only = true;
  line_up_[1].contestant.edge_check = EdgeCheck::kFixed;
  Driver begun(&bus_, Options(), line_up_, {});
  MakeAll(&begun);
  HeldSession earlier;
  earlier.sessions = {logger_.sessions().messages().back()};
  const auto resume = [&] {
    Driver(&bus_, Options(), line_up_, {}, earlier.Earlier()).Discover(true, Idle);
  };
  EXPECT_NO_THROW(resume());
  line_up_[1].finds_first_paths_only = false;
  EXPECT_NO_THROW(resume()) << "as a contestant besides";
  line_up_[1].finds_first_paths_only = true;
  line_up_[1].contestant.edge_resolution_m = 0.05;
  ExpectInputError(resume, {"--resume", "node[first].setting[collision checks]",
                            "spheres, edges fixed at 0.02 m", "spheres, edges fixed at 0.05 m"});
  line_up_[1].contestant.edge_resolution_m.reset();
  line_up_[1].contestant.collision_model = CollisionModel::kVoxels;
  ExpectInputError(resume, {"--resume", "node[first].setting[collision checks]", "voxels, edges"});
}

}  // namespace
}  // namespace planbench
