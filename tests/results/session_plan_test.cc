#include "results/session_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using enum Directions;

PlannedCall Call(std::vector<int> problems, Shard shard = {},
                 std::vector<PlannedPlanner> planners = {{"ara", kAuto, 2}}) {
  return {{{"box", std::move(problems)}}, std::move(planners), shard};
}

PlannedRun RunOf(const char* set, int problem, int trial, const char* planner,
                 Direction direction) {
  PlannedRun run;
  run.trial.problem_set = set;
  run.trial.problem_index = problem;
  run.trial.trial = trial;
  run.planner = planner;
  run.direction = direction;
  return run;
}

std::optional<SessionPlan> Read(const std::string& text) {
  return ReadPlan({{kPlanSetting, text}});
}

TEST(SessionPlanTest, IsReadAsItIsWritten) {
  PlannedCall call = Call({1, 2, 3, 7, 9, 10}, {2, 3}, {{"a \"b\"", kBoth, 5}, {"ara", kAuto, 1}});
  call.sets.push_back({"other", {4}});
  const SessionPlan plan = {call, Call({1})};
  EXPECT_EQ(Read(PlanText(plan)), plan);
  EXPECT_EQ(PlanText({Call({1, 2, 5}, {1, 2})}),
            R"([{"planners":[{"directions":"auto","name":"ara","trials":2}],)"
            R"("sets":[{"name":"box","problems":[[1,2],[5,5]]}],"shard":{"count":2,"index":1}}])");
  EXPECT_EQ(ReadPlan({{"trials", "2"}}), std::nullopt) << "an earlier version's";
}

TEST(SessionPlanTest, WhatIsNoPlanIsRefused) {
  const std::string text = PlanText({Call({1, 2, 5}, {1, 2})});
  const auto with = [&text](const std::string& from, const std::string& to) {
    std::string changed = text;
    return changed.replace(changed.find(from), from.size(), to);
  };
  for (const std::string& bad :
       {std::string("{"), std::string("[5]"), with("\"name\"", "\"nam\""), with("auto", "sideways"),
        with("[1,2]", "[2,1]"), with("[5,5]", "[2,5]"), with("[5,5]", "[5,2000000000]"),
        with("[5,5]", "[5]"), with(":2}]", ":0}]"), with("\"index\":1", "\"index\":3")}) {
    SCOPED_TRACE(bad);
    ExpectInputError([&] { Read(bad); }, {"the setting plan"});
  }
}

TEST(SessionPlanTest, CallsAreAddedOnce) {
  SessionPlan plan = {Call({1})};
  AddCalls({Call({2}), Call({1}), Call({2})}, &plan);
  EXPECT_EQ(plan, (SessionPlan{Call({1}), Call({2})}));
}

TEST(SessionPlanTest, APlannerIsAskedForTheTrialsOfTheShard) {
  PlannedCall call = Call({1, 2, 5}, {2, 2}, {{"ara", kAuto, 2}, {"once", kForward, 1}});
  call.sets.push_back({"other", {5}});
  EXPECT_THAT(call.Trials(), ElementsAre(PlannedTrial{"box", 2, 1}, PlannedTrial{"box", 2, 2},
                                         PlannedTrial{"other", 5, 1}, PlannedTrial{"other", 5, 2}));
  const std::map<PlannedRun, bool> runs = RunsOf({call});
  EXPECT_EQ(runs.size(), 10u);
  EXPECT_FALSE(runs.at(RunOf("other", 5, 2, "ara", Direction::kForward)));
  EXPECT_TRUE(runs.at(RunOf("other", 5, 2, "ara", Direction::kBackward))) << "may be needless";
  EXPECT_FALSE(runs.at(RunOf("other", 5, 1, "once", Direction::kForward)));
  EXPECT_FALSE(runs.contains(RunOf("other", 5, 2, "once", Direction::kForward))) << "one trial";
  EXPECT_FALSE(runs.contains(RunOf("box", 5, 1, "ara", Direction::kForward)))
      << "the other shard's";
  EXPECT_THAT(ProblemsOf({call}), ElementsAre("box 2", "other 5"));
  EXPECT_EQ(call.NumParts(), 8u);
}

TEST(SessionPlanTest, WhatIsNotMadeIsOwedOnce) {
  const SessionPlan plan = {Call({1, 2}, {}, {{"ara", kAuto, 1}, {"rrtc", kBoth, 1}}),
                            Call({2, 3}, {}, {{"ara", kAuto, 1}})};
  EXPECT_EQ(CountOwed(plan, {}, {}), 10) << "backward ones may be needed";
  const PlannedRun forward = RunOf("box", 1, 1, "ara", Direction::kForward);
  EXPECT_EQ(CountOwed(plan, {{forward, true}}, {}), 8);
  EXPECT_EQ(CountOwed(plan, {{forward, false}}, {}), 9);
  EXPECT_EQ(CountOwed(plan, {{RunOf("box", 1, 1, "rrtc", Direction::kForward), true}}, {}), 9)
      << "both are made";
  EXPECT_EQ(CountOwed(plan, {}, {{"box 2", "is bad"}}), 6);
}

TEST(MissingShardsTest, AreNamedForEachWhole) {
  const std::vector<PlannedPlanner> others = {{"rrtc", kForward, 1}};
  EXPECT_THAT(MissingShards({Call({1, 2, 3}, {2, 3})}),
              ElementsAre("1/3, 3/3 of box 1-3 by ara (auto, 2 trials)"));
  EXPECT_THAT(MissingShards({Call({1, 2}, {1, 2}), Call({1, 2}, {2, 2})}), IsEmpty());
  EXPECT_THAT(MissingShards({Call({1, 2, 3, 4}, {1, 2}), Call({3, 4, 5, 7}, {2, 2})}),
              ElementsAre("2/2 of box 1-4 by ara (auto, 2 trials)",
                          "1/2 of box 3-5,7 by ara (auto, 2 trials)"));
  EXPECT_THAT(MissingShards({Call({1, 2, 3}, {1, 3}), Call({1, 2, 3}, {2, 3}),
                             Call({1, 2, 3}, {3, 3}, others)}),
              ElementsAre("3/3 of box 1-3 by ara (auto, 2 trials)",
                          "1/3, 2/3 of box 1-3 by rrtc (forward, 1 trial)"));
  EXPECT_THAT(MissingShards({Call({1, 2}, {1, 2}), Call({1, 2}, {2, 2}, {{"ara", kAuto, 1}})}),
              ElementsAre("2/2 of box 1-2 by ara (auto, 2 trials)"))
      << "of one trial all are planned";
  EXPECT_THAT(MissingShards({Call({1, 2}, {1, kMostPlanned})}),
              ElementsAre("2/1000000, 3/1000000, 4/1000000 of box 1-2 by ara (auto, 2 trials)"))
      << "the others would be empty";
}

TEST(MissingShardsTest, WhatOtherCallsMakeIsNotMissing) {
  EXPECT_THAT(MissingShards({Call({1, 2}, {1, 2}), Call({1, 2})}), IsEmpty()) << "the whole";
  const PlannedPlanner ara = {"ara", kAuto, 1}, rrtc = {"rrtc", kForward, 1};
  EXPECT_THAT(MissingShards({Call({1, 2}, {1, 2}, {ara, rrtc}), Call({1, 2}, {2, 2}, {rrtc, ara})}),
              IsEmpty())
      << "in whatever order";
  EXPECT_THAT(MissingShards({Call({1}, {1, 2}, {ara})}), IsEmpty()) << "the other is empty";
}

TEST(DirectionsDifferenceTest, IsThatOfAPlannerOfBoth) {
  const SessionPlan first = {Call({1}, {}, {{"ara", kAuto, 1}, {"rrtc", kForward, 1}})};
  EXPECT_FALSE(FindDirectionsDifference(first, first));
  EXPECT_FALSE(FindDirectionsDifference(first, {Call({1}, {}, {{"stomp", kBoth, 1}})}));
  const auto difference = FindDirectionsDifference(first, {Call({2}, {}, {{"ara", kBoth, 3}})});
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->planner, "ara");
  EXPECT_EQ(difference->first, kAuto);
  EXPECT_EQ(difference->second, kBoth);
}

}  // namespace
}  // namespace planbench
