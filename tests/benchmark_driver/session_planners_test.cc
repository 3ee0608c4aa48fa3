#include "benchmark_driver/session_planners.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/benchmark_driver/driver_fixture.h"

namespace planbench {
namespace {

using testing::ElementsAre;

class SessionPlannersTest : public DriverTest {
 protected:
  static DriverOptions Forward(std::vector<int> problems, int trials = 1) {
    DriverOptions options = Options();
    options.directions = Directions::kForward;
    options.problem_indices = std::move(problems);
    options.trials = trials;
    return options;
  }

  const FakeLogger logger_{&bus_};
  FakeSceneServer server_{&bus_};
};

TEST_F(SessionPlannersTest, EveryProcessAnswersARequestBeforeItsFirstRun) {
  FakePlanner planner(&bus_);
  Driver driver(&bus_, Forward({1, 2}), LineUp({"arm"}), {});
  MakeAll(&driver);
  EXPECT_THAT(AskedOf(&planner),
              ElementsAre("1 forward/1, not recorded", "1 forward/1", "2 forward/1"));
  EXPECT_EQ(driver.runs().size(), 2u);
}

TEST_F(SessionPlannersTest, OneThatComesInThePlaceOfAnotherAnswersOneToo) {
  std::atomic<bool> dies = false;
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    if (request.request_id.find("/forward/2@") == std::string::npos) return planner.Solve(request);
    dies = true;
  });
  Driver driver(&bus_, Forward({1}, 3), LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  bool has_come = false;
  EXPECT_TRUE(driver.Run(Never, [&] {
    if (dies && !std::exchange(has_come, true)) planner.Restart();
  }));
  EXPECT_THAT(AskedOf(&planner),
              ElementsAre("1 forward/1, not recorded", "1 forward/1", "1 forward/2",
                          "1 forward/3, not recorded", "1 forward/3"));
}

TEST_F(SessionPlannersTest, OneThatDiesOfItHasASuccessorThatAnswersOneAndNoThirdDies) {
  std::set<std::string> died_of;
  std::atomic<std::size_t> num_deaths = 0;
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    if (!request.request_id.ends_with("/warm-up")) return planner.Solve(request);
    died_of.insert(request.request_id);
    num_deaths = died_of.size();
  });
  Driver driver(&bus_, Forward({1}), LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  std::size_t num_successors = 0;
  EXPECT_TRUE(driver.Run(Never, [&] {
    if (num_successors == num_deaths) return;
    ++num_successors;
    planner.Restart();
  }));
  EXPECT_THAT(AskedOf(&planner),
              ElementsAre("1 forward/1, not recorded", "1 forward/1, not recorded", "1 forward/1"));
}

TEST_F(SessionPlannersTest, OneThatLivesAndGivesNoneIsNotAskedForAnother) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    PlanResult without_path = FakePlanner::SolvedResult();
    without_path.path.clear();
    planner.SendResult(request.request_id, without_path);
  });
  Driver driver(&bus_, Forward({1, 2}), LineUp({"arm"}), {});
  MakeAll(&driver);
  EXPECT_THAT(AskedOf(&planner),
              ElementsAre("1 forward/1, not recorded", "1 forward/1", "2 forward/1"));
}

TEST_F(SessionPlannersTest, AFirstRequestWithoutAResultIsMadeUpFor) {
  FakePlanner planner(&bus_);
  planner.OnRequest([&](const PlanRequest& request) {
    if (request.scene_id != "scene-2") return planner.Solve(request);
    planner.Acknowledge(request, PlanAckVerdict::kRefused, "too large a scene");
  });
  Driver driver(&bus_, Forward({1, 2, 3}, 2), LineUp({"arm"}), {});
  driver.Discover(true, Idle);
  server_.RefuseProblem(1, "it is gone");
  EXPECT_TRUE(driver.Run(Never, Idle));
  EXPECT_THAT(
      AskedOf(&planner),
      ElementsAre("2 forward/1, not recorded", "2 forward/1", "2 forward/2, not recorded",
                  "2 forward/2", "3 forward/1, not recorded", "3 forward/1", "3 forward/2"));
}

}  // namespace
}  // namespace planbench
