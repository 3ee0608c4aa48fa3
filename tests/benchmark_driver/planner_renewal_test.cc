#include "benchmark_driver/planner_renewal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <string>
#include <vector>

#include "tests/benchmark_driver/driver_fixture.h"

namespace planbench {
namespace {

using testing::ElementsAre;

class PlannerRenewalTest : public DriverTest {
 protected:
  /// What a planner was asked in a session of problems of "cans", each once, in order: "1
  /// forward/2" is problem 1's second trial.
  static std::vector<std::string> AskedOf(FakePlanner* planner) {
    const std::string& name = planner->status.name;
    std::vector<std::string> asked;
    std::set<std::string> seen;
    for (const PlanRequest& request : planner->requests().messages()) {
      if (!seen.insert(request.request_id).second) continue;
      std::string id = request.request_id.substr(0, request.request_id.find('@'));
      id.erase(0, std::string("run/cans/").size());
      id.replace(id.find('/'), name.size() + 2, " ");
      if (request.request_id.ends_with("/warm-up")) id += ", not recorded";
      asked.push_back(id);
    }
    return asked;
  }
};

TEST_F(PlannerRenewalTest, EachPlannersProcessHasSoManyProblems) {
  NodeRegistry registry(&bus_);
  PlannerClient arm(&bus_, &registry, "arm"), leg(&bus_, &registry, "leg");
  std::vector<std::string> started;
  PlannerRenewal renewal(2, [&](const std::string& planner) { started.push_back(planner); });
  EXPECT_FALSE(renewal.Renew("cans", 1, &arm));
  EXPECT_FALSE(renewal.Renew("cans", 1, &arm));
  EXPECT_FALSE(renewal.Renew("cans", 2, &arm));
  EXPECT_FALSE(renewal.Renew("cans", 2, &leg));
  EXPECT_TRUE(renewal.Renew("tins", 2, &arm)) << "another set's";
  EXPECT_FALSE(renewal.Renew("tins", 2, &arm));
  EXPECT_FALSE(renewal.Renew("tins", 3, &arm));
  EXPECT_FALSE(renewal.Renew("tins", 3, &leg));
  EXPECT_TRUE(renewal.Renew("cans", 1, &arm)) << "as for a repeat";
  EXPECT_THAT(started, ElementsAre("arm", "arm"));
}

TEST_F(PlannerRenewalTest, WithoutANumberAProcessHasThemAll) {
  NodeRegistry registry(&bus_);
  PlannerClient arm(&bus_, &registry, "arm");
  PlannerRenewal renewal;
  for (int problem = 1; problem <= 100; ++problem) {
    EXPECT_FALSE(renewal.Renew("cans", problem, &arm));
  }
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
                  [&](const std::string& planner) { (planner == "arm" ? arm : leg).Restart(); });
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
  driver.Discover(true, Idle, {}, {}, [&](const std::string&) { ++num_started; });
  driver.GiveUp("arm", "it died");
  EXPECT_TRUE(driver.Run(Never, Idle));
  EXPECT_EQ(driver.num_not_asked(), 2);
  EXPECT_EQ(num_started, 0);
}

}  // namespace
}  // namespace planbench
