#include "benchmark_driver/planner_renewal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "tests/benchmark_driver/driver_fixture.h"

namespace planbench {
namespace {

using testing::ElementsAre;

using PlannerRenewalTest = DriverTest;

TEST_F(PlannerRenewalTest, EachPlannersProcessHasSoManyProblems) {
  NodeRegistry registry(&bus_);
  FakePlanner live_arm(&bus_, "arm"), live_leg(&bus_, "leg");
  for (FakePlanner* planner : {&live_arm, &live_leg}) planbench::Reannounce(&registry, planner);
  PlannerClient arm(&bus_, &registry, "arm"), leg(&bus_, &registry, "leg");
  std::vector<std::string> started;
  PlannerRenewal renewal(2, [&](const std::string& planner) {
    started.push_back(planner);
    planbench::Reannounce(&registry, planner == "arm" ? &live_arm : &live_leg);
  });
  const auto renews = [&](const std::string& set, int problem, PlannerClient* planner) {
    const std::size_t before = started.size();
    renewal.Renew(set, problem, planner);
    return started.size() > before;
  };
  EXPECT_FALSE(renews("cans", 1, &arm));
  EXPECT_FALSE(renews("cans", 1, &arm));
  EXPECT_FALSE(renews("cans", 2, &arm));
  EXPECT_FALSE(renews("cans", 2, &leg));
  EXPECT_TRUE(renews("tins", 2, &arm)) << "another set's";
  EXPECT_FALSE(renews("tins", 2, &arm));
  EXPECT_FALSE(renews("tins", 3, &arm));
  EXPECT_FALSE(renews("tins", 3, &leg));
  EXPECT_TRUE(renews("cans", 1, &arm)) << "as for a repeat";
  EXPECT_THAT(started, ElementsAre("arm", "arm"));
}

TEST_F(PlannerRenewalTest, WhereNobodyIsLiveNobodyIsToldToEnd) {
  NodeRegistry registry(&bus_);
  PlannerClient arm(&bus_, &registry, "arm");
  PlannerRenewal renewal(1, [](const std::string&) { ADD_FAILURE() << "it is new, or to come"; });
  for (const int problem : {1, 2, 3}) renewal.Renew("cans", problem, &arm);
}

TEST_F(PlannerRenewalTest, WithoutANumberAProcessHasThemAll) {
  NodeRegistry registry(&bus_);
  FakePlanner live(&bus_, "arm");
  planbench::Reannounce(&registry, &live);
  PlannerClient arm(&bus_, &registry, "arm");
  PlannerRenewal renewal({}, [](const std::string&) { ADD_FAILURE(); });
  for (int problem = 1; problem <= 100; ++problem) renewal.Renew("cans", problem, &arm);
}

TEST_F(PlannerRenewalTest, ASessionsNewProcessesAnswerARequestThatIsNotRecordedFirst) {
  FakePlanner arm(&bus_, "arm"), leg(&bus_, "leg");
  const FakeSceneServer server(&bus_);
  FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kForward;
  options.problem_indices = {1, 2, 3};
  options.trials = 2;
  options.problems_per_process = 2;
  Driver driver(&bus_, options, LineUp({"arm", "leg"}), {});
  driver.Discover(true, Idle, {}, {},
                  {[&](const std::string& planner) { (planner == "arm" ? arm : leg).Restart(); }});
  EXPECT_TRUE(driver.Run(Never, Idle));
  for (FakePlanner* planner : {&arm, &leg}) {
    EXPECT_THAT(
        AskedOf(planner),
        ElementsAre("1 forward/1, not recorded", "1 forward/1", "1 forward/2", "2 forward/1",
                    "2 forward/2", "3 forward/1, not recorded", "3 forward/1", "3 forward/2"));
  }
  EXPECT_EQ(driver.runs().size(), 12u);
  for (const RunRow& run : driver.runs().rows()) EXPECT_TRUE(run.confirmed()) << *run.message;
}

TEST_F(PlannerRenewalTest, WhoIsGivenUpIsNotStartedAnew) {
  const FakePlanner arm(&bus_, "arm");
  const FakeSceneServer server(&bus_);
  const FakeLogger logger(&bus_);
  DriverOptions options = Options();
  options.directions = Directions::kForward;
  options.problems_per_process = 1;
  Driver driver(&bus_, options, LineUp({"arm"}), {});
  std::atomic<int> num_started = 0;
  driver.Discover(true, Idle, {}, {}, {[&](const std::string&) { ++num_started; }});
  driver.GiveUp("arm", "it died");
  EXPECT_TRUE(driver.Run(Never, Idle));
  EXPECT_EQ(driver.num_not_asked(), 2);
  EXPECT_EQ(num_started, 0);
}

}  // namespace
}  // namespace planbench
