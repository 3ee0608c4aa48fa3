#include "planner_ara/ara_settings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/expect_input_error.h"

namespace planbench {
namespace {

AraSettings Read(const std::string& text) {
  AraSettings settings;
  settings.Apply(YamlNode::Parse(text, "ara.yaml"));
  return settings;
}

TEST(AraSettings, ReadsEveryKey) {
  const AraSettings settings = Read(R"(
discretization: {lift: 0.005, roll: 0.1}
joint_weights: {lift: 3}
primitives: arm.mprim
use_long_primitives: false
use_short_primitives: true
long_primitives_beyond: 0.5
short_primitives_within: 0.4
two_way: false
bridge_after: 5000
burs: true
refine: false
shorten: false
tip_guide: 1.5
arm_by_arm: false
crowding: 0.3
crowding_joints: [lift]
cost: uniform
evaluation: eager
wrap_heuristic: false
fit_cells: true
edge_weights: {lift: 1, roll: 0.5}
epsilon_initial: 30
epsilon_decrement: 2
epsilon_final: 1.5
memory_limit_mb: 100
)");
  EXPECT_EQ(settings.discretization,
            (std::map<std::string, double>{{"lift", 0.005}, {"roll", 0.1}}));
  EXPECT_EQ(settings.joint_weights, (std::map<std::string, double>{{"lift", 3}}));
  EXPECT_EQ(settings.primitives, "arm.mprim");
  EXPECT_FALSE(settings.use_long_primitives);
  EXPECT_TRUE(settings.use_short_primitives);
  EXPECT_EQ(settings.long_primitives_beyond, 0.5);
  EXPECT_EQ(settings.short_primitives_within, 0.4);
  EXPECT_FALSE(settings.two_way);
  EXPECT_EQ(settings.bridge_after, 5000);
  EXPECT_TRUE(settings.burs);
  EXPECT_FALSE(settings.refine);
  EXPECT_FALSE(settings.shorten);
  EXPECT_EQ(settings.tip_guide, 1.5);
  EXPECT_FALSE(settings.arm_by_arm);
  EXPECT_EQ(settings.crowding, 0.3);
  EXPECT_EQ(settings.crowding_joints, std::vector<std::string>{"lift"});
  EXPECT_EQ(settings.cost, MoveCost::kUniform);
  EXPECT_EQ(settings.evaluation, Evaluation::kEager);
  EXPECT_FALSE(settings.wrap_heuristic);
  EXPECT_TRUE(settings.fit_cells);
  EXPECT_EQ(settings.edge_weights, (std::map<std::string, double>{{"lift", 1}, {"roll", 0.5}}));
  EXPECT_EQ(settings.epsilon.initial, 30);
  EXPECT_EQ(settings.epsilon.decrement, 2);
  EXPECT_EQ(settings.epsilon.final, 1.5);
  EXPECT_EQ(settings.memory_limit_mb, 100);
  settings.Validate("ara.yaml");
}

TEST(AraSettings, NothingLeavesTheDefaults) {
  EXPECT_EQ(Read("").AsText(), AraSettings().AsText());
  EXPECT_EQ(Read("").short_primitives_within, 0.2);
}

TEST(AraSettings, InfinityHasWords) {
  const AraSettings settings = Read("short_primitives_within: everywhere\nbridge_after: never");
  EXPECT_TRUE(std::isinf(settings.short_primitives_within));
  EXPECT_EQ(settings.AsText().at("short_primitives_within"), "everywhere");
  EXPECT_TRUE(std::isinf(settings.bridge_after));
  EXPECT_EQ(settings.AsText().at("bridge_after"), "never");
}

TEST(AraSettings, LaterValuesAreLaidOverEarlierOnes) {
  AraSettings settings = Read("{discretization: {lift: 0.005, roll: 0.1}, epsilon_initial: 9}");
  YamlNode node = YamlNode::Parse("", "parameter");
  node.Override("discretization", "{roll: 0.2}", "parameter discretization");
  node.Override("cost", "uniform", "parameter cost");
  settings.Apply(node);
  EXPECT_EQ(settings.discretization,
            (std::map<std::string, double>{{"lift", 0.005}, {"roll", 0.2}}));
  EXPECT_EQ(settings.cost, MoveCost::kUniform);
  EXPECT_EQ(settings.epsilon.initial, 9);
}

TEST(AraSettings, TextReadsBackAsTheSameSettings) {
  const AraSettings settings = Read(
      "{discretization: {lift: 0.005, roll: 0.017453292519943295}, joint_weights: {lift: 3}, "
      "primitives: a.mprim, crowding_joints: [lift, roll], two_way: false, "
      "short_primitives_within: 0.25, cost: uniform, epsilon_initial: 7.5, evaluation: eager, "
      "wrap_heuristic: false, fit_cells: true, edge_weights: {lift: 1, roll: 0.5}}");
  AraSettings again;
  for (const auto& [key, text] : settings.AsText()) {
    YamlNode node = YamlNode::Parse("", "parameter");
    node.Override(key, text, "parameter " + key);
    again.Apply(node);
  }
  EXPECT_EQ(again.AsText(), settings.AsText());
  EXPECT_EQ(again.discretization, settings.discretization);
  EXPECT_EQ(again.crowding_joints, settings.crowding_joints);
}

TEST(AraSettings, GeneratedPrimitivesReplaceAFile) {
  AraSettings settings = Read("primitives: a.mprim");
  settings.Apply(YamlNode::Parse("primitives: generated", "ara.yaml"));
  EXPECT_TRUE(settings.primitives.empty());
  EXPECT_EQ(settings.AsText().at("primitives"), "generated");
}

TEST(AraSettings, RefusesWhatItCannotUse) {
  struct Case {
    std::string text;
    std::vector<std::string> message;
  };
  const std::vector<Case> cases = {
      {"[1, 2]", {"ara.yaml:1", "expected a map"}},
      {"\nepsilon: 3", {"ara.yaml:2", "epsilon", "unknown key"}},
      {"\ntip_guide:", {"ara.yaml:2: tip_guide:", "has no value"}},
      {"discretization: {lift: ~}", {"ara.yaml:1: discretization.lift:", "has no value"}},
      {"cost: cheap", {"ara.yaml:1: cost:", "distance or uniform", "cheap"}},
      {"discretization: 0.1", {"ara.yaml:1: discretization:", "map"}},
      {"discretization: {lift: 0}", {"ara.yaml:1: discretization.lift:", "greater than zero"}},
      {"discretization: {lift: fine}", {"ara.yaml:1: discretization.lift:", "number"}},
      {"joint_weights: {lift: -1}", {"ara.yaml:1: joint_weights.lift:", "from 1e-06 to"}},
      {"use_long_primitives: 3", {"ara.yaml:1: use_long_primitives:", "true or false"}},
      {"long_primitives_beyond: -1",
       {"ara.yaml:1: long_primitives_beyond:", "negative, found '-1'"}},
      {"short_primitives_within: .inf", {"ara.yaml:1: short_primitives_within:", "finite"}},
      {"epsilon_initial: 0.9", {"ara.yaml:1: epsilon_initial:", "from 1 to", "0.9"}},
      {"epsilon_decrement: 0", {"ara.yaml:1: epsilon_decrement:", "from 1e-06 to"}},
      {"epsilon_final: .nan", {"ara.yaml:1: epsilon_final:", "finite"}},
      {"crowding: -0.1", {"ara.yaml:1: crowding:", "negative"}},
      {"crowding_joints: lift", {"ara.yaml:1: crowding_joints:", "sequence"}},
      {"tip_guide: -3", {"ara.yaml:1: tip_guide:", "negative"}},
      {"tip_guide: 1e308", {"ara.yaml:1: tip_guide:", "from 1e-06 to", "1e+308"}},
      {"crowding: 1e7", {"ara.yaml:1: crowding:", "from 1e-06 to", "10000000"}},
      {"joint_weights: {lift: 1e200}", {"ara.yaml:1: joint_weights.lift:", "1e+200"}},
      {"joint_weights: {lift: 1e-200}", {"ara.yaml:1: joint_weights.lift:", "1e-200"}},
      {"edge_weights: {lift: 1e200}", {"ara.yaml:1: edge_weights.lift:", "1e+200"}},
      {"epsilon_initial: 1e300", {"ara.yaml:1: epsilon_initial:", "1e+300"}},
      {"epsilon_decrement: 1e-300", {"ara.yaml:1: epsilon_decrement:", "1e-300"}},
      {"bridge_after: 0", {"ara.yaml:1: bridge_after:", "greater than zero"}},
      {"bridge_after: everywhere", {"ara.yaml:1: bridge_after:", "number"}},
      {"refine: fine", {"ara.yaml:1: refine:", "true or false"}},
      {"two_way: both", {"ara.yaml:1: two_way:", "true or false"}},
      {"memory_limit_mb: 0", {"ara.yaml:1: memory_limit_mb:", "greater than zero"}},
      {"primitives: [a, b]", {"ara.yaml:1: primitives:", "text"}},
      {"recall: 2", {"ara.yaml:1: recall:", "without 'experience'"}},
  };
  for (const Case& test : cases) {
    SCOPED_TRACE(test.text);
    ExpectInputError([&] { Read(test.text); }, test.message);
  }
}

TEST(AraSettings, MustHoldTogether) {
  Read("").Validate("ara.yaml");
  ExpectInputError([&] { Read("epsilon_initial: 2\nepsilon_final: 3").Validate("x"); },
                   {"x", "epsilon_initial 2", "epsilon_final 3"});
}

}  // namespace
}  // namespace planbench
