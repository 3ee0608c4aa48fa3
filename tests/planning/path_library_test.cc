#include "planning/path_library.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/numbers.h"
#include "common/random.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

JointSpace Space() {
  return JointSpace({{"turn", true, false, -kPi, kPi, 1}, {"bend", false, false, -2, 2, 1}});
}

std::vector<PlanningGroup> Groups() {
  std::vector<PlanningGroup> groups(1);
  groups.front().space = Space();
  return groups;
}

PathLibrary Library(std::vector<Path> paths) {
  return {{"turn", "bend"}, {"set"}, std::move(paths)};
}

TEST(PathLibrary, FitsTheGroupWithItsJointsInItsOrder) {
  EXPECT_TRUE(Library({}).Fits(Space()));
  EXPECT_FALSE((PathLibrary{{"bend", "turn"}, {}, {}}).Fits(Space()));
  EXPECT_FALSE((PathLibrary{{"turn"}, {}, {}}).Fits(Space()));
}

TEST(PathLibrary, IsReadAsItWasWritten) {
  PathLibrary library = Library({{{0.1, -1.0 / 3}, {3, 2}, {-3, 0}}, {{0, 0}, {1, 1}}});
  library.learned_from = {"a: set", "b"};
  library.scenes = {"01234567", "1e5"};
  const PathLibrary read =
      ReadPathLibrary(YamlNode::Parse(ToYaml(library), "paths.yaml"), Groups());
  EXPECT_EQ(read.joints, library.joints);
  EXPECT_EQ(read.learned_from, library.learned_from);
  EXPECT_EQ(read.scenes, library.scenes);
  EXPECT_EQ(read.paths, library.paths);
}

TEST(PathLibrary, TurnsOfContinuousJointsAreTakenOutAsItIsRead) {
  const PathLibrary library = Library({{{3, 0}, {4, 0}, {20 * kPi + 1, 0}}});
  const Path path =
      ReadPathLibrary(YamlNode::Parse(ToYaml(library), "paths.yaml"), Groups()).paths.front();
  EXPECT_EQ(path[0], (Configuration{3, 0}));
  EXPECT_NEAR(path[1][0], 4 - 2 * kPi, 1e-12);
  EXPECT_NEAR(path[2][0], 1, 1e-12);
}

TEST(PathLibrary, RecallsTheStretchBetweenTheEnds) {
  const PathLibrary library = Library({{{0, 0}, {1, 0}, {2, 0}, {3, 0}}, {{0, 2}, {1, 2}}});
  EXPECT_EQ(library.Recall(Space(), Configuration{0.9, 0.1}, Configuration{2.1, 0}, 1),
            (std::vector<Path>{{{1, 0}, {2, 0}}}));
  EXPECT_EQ(library.Recall(Space(), Configuration{3, 0}, Configuration{1, 0.1}, 1),
            (std::vector<Path>{{{3, 0}, {2, 0}, {1, 0}}}))
      << "reversed";
  EXPECT_EQ(library.Recall(Space(), Configuration{-kPi + 0.1, 0}, Configuration{3, 0}, 1),
            (std::vector<Path>{{{3, 0}}}))
      << "the short way round";
  EXPECT_EQ(library.Recall(Space(), Configuration{0, 2}, Configuration{1, 2}, 9),
            (std::vector<Path>{{{0, 2}, {1, 2}}, {{0, 0}, {1, 0}}}))
      << "the nearest first, not more than there are";
  EXPECT_TRUE(Library({}).Recall(Space(), Configuration{0, 0}, Configuration{1, 1}, 1).empty());
}

TEST(PathLibrary, RecallsTheNearestOfAll) {
  std::mt19937_64 random(1);
  const JointSpace space = Space();
  const auto draw = [&] {
    return Configuration{kPi * (2 * UniformFraction(&random) - 1),
                         2 * (2 * UniformFraction(&random) - 1)};
  };
  std::vector<Path> paths;
  for (int i = 0; i < 40; ++i) paths.push_back({draw(), draw(), draw()});
  const PathLibrary library = Library(paths);
  for (int i = 0; i < 50; ++i) {
    const Configuration from = draw();
    const Configuration to = draw();
    double least = kInfinity;
    for (const Path& path : paths) {
      for (const Configuration& a : path) {
        for (const Configuration& b : path) {
          least = std::min(least, space.Distance(a, from) + space.Distance(b, to));
        }
      }
    }
    const Path recalled = library.Recall(space, from, to, 1).front();
    EXPECT_DOUBLE_EQ(space.Distance(recalled.front(), from) + space.Distance(recalled.back(), to),
                     least);
  }
}

TEST(PathLibrary, WhatIsNoneIsRefusedByFileAndLine) {
  const auto expect_refused = [&](const std::string& text, const std::vector<std::string>& parts) {
    SCOPED_TRACE(text);
    const YamlNode file = YamlNode::Parse(text, "paths.yaml");
    ExpectInputError([&] { ReadPathLibrary(file, Groups()); }, parts);
  };
  const std::string head = "joints: [turn, bend]\nlearned_from: []\n";
  expect_refused("joints: []\nlearned_from: []\npaths: []\n", {"paths.yaml:1", "joints"});
  expect_refused("learned_from: []\npaths: []\n", {"paths.yaml", "joints"});
  expect_refused("learned_from: []\njoints: [bend, turn]\npaths: []\n",
                 {"paths.yaml:2: joints:", "group"});
  expect_refused(head + "paths:\n- [[1, 0], [2, 3, 4]]\n", {"paths.yaml:4"});
  expect_refused(head + "paths:\n- [[1, 0], [.nan, 0]]\n", {"paths.yaml:4"});
  expect_refused(head + "paths:\n- [[1, 0]]\n", {"paths.yaml:4", "two"});
  expect_refused(head + "path: []\n", {"paths.yaml:3", "path"});
  expect_refused(head + "paths: []\n", {"paths.yaml:3: paths:", "empty"});
  expect_refused(head + "paths:\n- [[1, 0],\n   [1, 99]]\n",
                 {"paths.yaml:5: paths[0][1][1]:", "bend", "99", "[-2, 2]"});
}

TEST(PathLibrary, OneThatWasCutBetweenTwoPathsIsRefused) {
  const std::string whole = ToYaml(Library({{{0, 0}, {1, 1}}, {{1, 1}, {0, 0}}}));
  const std::string cut = whole.substr(0, whole.rfind("  - "));
  ExpectInputError([&] { ReadPathLibrary(YamlNode::Parse(cut, "cut.yaml"), Groups()); },
                   {"cut.yaml:3: num_paths:", "is 2", "1 paths", "not whole"});
  const std::string line = "num_paths: 2\n";
  std::string of_before = whole;
  of_before.erase(of_before.find(line), line.size());
  EXPECT_EQ(ReadPathLibrary(YamlNode::Parse(of_before, "before.yaml"), Groups()).paths.size(), 2u);
}

}  // namespace
}  // namespace planbench
