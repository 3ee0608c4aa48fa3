#include "planning/shortcut.h"

#include <gtest/gtest.h>

#include "planning/path_judge.h"
#include "planning/path_measures.h"
#include "support/planning_problems.h"

namespace planbench {
namespace {

bool Never() { return false; }

class ShortcutTest : public testing::Test {
 protected:
  Path Shortcut(const Path& path, const Scene& scene, std::uint64_t seed = 1, int rounds = 4,
                const std::function<bool()>& should_stop = Never,
                EdgeCheck method = EdgeCheck::kFixed) {
    checker_->SetScene(scene, robot_.model.DefaultPositions());
    EdgeChecker edges(checker_.get(), kResolution, method);
    return ShortcutPath(&edges, path, seed, rounds, should_stop);
  }

  void ExpectValid(const Path& path, const Scene& scene) {
    checker_->SetScene(scene, robot_.model.DefaultPositions());
    const Configuration& goal = path.back();
    const PathVerdict verdict =
        JudgePath(checker_.get(), path, path.front(), {{goal, goal, goal}}, kResolution, false);
    EXPECT_TRUE(verdict.valid) << verdict.reason;
  }

  static constexpr double kResolution = 0.02;
  const Robot robot_ = LoadPlanarRobot();
  const JointSpace& space_ = robot_.groups.front().space;
  const std::unique_ptr<CollisionChecker> checker_ =
      MakeCollisionChecker(robot_, robot_.groups.front(), CollisionModel::kSpheres);
  /// Folds, passes the post ahead, stretches; with detours.
  const Path around_post_ = {{0.6, 0, 0},     {0.9, 0.5, 0.3},  {0.7, 1.3, 1.0},
                             {0.6, 2.0, 1.5}, {-0.3, 2.1, 1.2}, {-1.0, 2.0, 1.5},
                             {-1.1, 1.0, 0},  {-0.9, 0.2, 0.2}, {-0.6, 0, 0}};
};

TEST_F(ShortcutTest, TheInputIsValid) { ExpectValid(around_post_, PostsScene()); }

TEST_F(ShortcutTest, WithoutObstaclesTheStraightEdgeRemains) {
  const Path path = Shortcut(around_post_, EmptyPlanarScene());
  EXPECT_EQ(path, (Path{around_post_.front(), around_post_.back()}));
}

TEST_F(ShortcutTest, KeepsClearOfObstaclesAndShortens) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Path path = Shortcut(around_post_, PostsScene(), seed);
    ExpectValid(path, PostsScene());
    EXPECT_EQ(path.front(), around_post_.front());
    EXPECT_EQ(path.back(), around_post_.back());
    EXPECT_GT(path.size(), 2u) << "the straight edge runs through the post";
    EXPECT_LT(PathLength(space_, path), 0.9 * PathLength(space_, around_post_));
  }
}

TEST_F(ShortcutTest, EdgesAreProvenWhereTheyAreCertified) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Path path = Shortcut(around_post_, PostsScene(), seed, 4, Never, EdgeCheck::kCertified);
    const Configuration& goal = path.back();
    const PathVerdict verdict = JudgePath(checker_.get(), path, path.front(), {{goal, goal, goal}},
                                          kResolution / 64, false);
    EXPECT_TRUE(verdict.valid) << "seed " << seed << ": " << verdict.reason;
    EXPECT_LT(PathLength(space_, path), 0.9 * PathLength(space_, around_post_));
  }
}

TEST_F(ShortcutTest, WhatIsNotProvenIsCheckedAgainBeforePartOfItIsKept) {
  // An input whose second edge runs through the post ahead: parts of it may not come in as new
  // edges, so each edge of the result is an edge of the input or valid.
  const Path path = {{1.5, 0, 0}, {0.6, 0.3, 0}, {-0.6, -0.3, 0}, {-1.5, 0, 0}};
  checker_->SetScene(PostsScene(), robot_.model.DefaultPositions());
  for (const EdgeCheck method : {EdgeCheck::kFixed, EdgeCheck::kCertified}) {
    EdgeChecker edges(checker_.get(), kResolution, method);
    ASSERT_FALSE(edges.IsValidEdge(path[1], path[2]));
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Path shorter = ShortcutPath(&edges, path, seed, 4, Never);
      for (std::size_t i = 1; i < shorter.size(); ++i) {
        const bool is_of_input = shorter[i - 1] == path[1] && shorter[i] == path[2];
        EXPECT_TRUE(is_of_input || edges.IsValidEdge(shorter[i - 1], shorter[i]));
      }
    }
  }
}

TEST_F(ShortcutTest, MoreRoundsNeverLengthen) {
  double length = PathLength(space_, around_post_);
  for (const int rounds : {0, 1, 2, 4, 10}) {
    const double shorter = PathLength(space_, Shortcut(around_post_, PostsScene(), 3, rounds));
    EXPECT_LE(shorter, length + 1e-12) << rounds;
    length = shorter;
  }
}

TEST_F(ShortcutTest, IsDeterministic) {
  const Path once = Shortcut(around_post_, PostsScene(), 5);
  Shortcut(around_post_, EmptyPlanarScene(), 9);
  EXPECT_EQ(Shortcut(around_post_, PostsScene(), 5), once);
  EXPECT_NE(Shortcut(around_post_, PostsScene(), 6), once);
}

TEST_F(ShortcutTest, StopsWhenTold) {
  int calls = 0;
  const Path path = Shortcut(around_post_, PostsScene(), 1, 100'000, [&] { return ++calls > 5; });
  ExpectValid(path, PostsScene());
  EXPECT_EQ(Shortcut(around_post_, PostsScene(), 1, 4, [] { return true; }), around_post_);
}

TEST_F(ShortcutTest, ChecksNoMoreThanOneShortcutsEdgesBeforeItStops) {
  checker_->SetScene(PostsScene(), robot_.model.DefaultPositions());
  EdgeChecker unwatched(checker_.get(), kResolution, EdgeCheck::kFixed);
  ShortcutPath(&unwatched, around_post_, 1, 2, Never);
  for (std::int64_t most = 0; most <= unwatched.counters().edges; ++most) {
    EdgeChecker edges(checker_.get(), kResolution, EdgeCheck::kFixed);
    ShortcutPath(&edges, around_post_, 1, 2, [&] { return edges.counters().edges >= most; });
    EXPECT_LE(edges.counters().edges, most + 2) << "of the three that a shortcut may need";
  }
}

TEST_F(ShortcutTest, ShortPathsStayAsTheyAre) {
  EXPECT_EQ(Shortcut({}, EmptyPlanarScene()), Path{});
  EXPECT_EQ(Shortcut({{1, 0, 0}}, EmptyPlanarScene()), (Path{{1, 0, 0}}));
  EXPECT_EQ(Shortcut({{1, 0, 0}, {0, 0, 0}}, EmptyPlanarScene()), (Path{{1, 0, 0}, {0, 0, 0}}));
}

TEST_F(ShortcutTest, RepeatedWaypointsDoNoHarm) {
  const Path path = {around_post_[0], around_post_[0], around_post_[3], around_post_[3],
                     around_post_[3], around_post_[5], around_post_[8], around_post_[8]};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Path shorter = Shortcut(path, PostsScene(), seed);
    EXPECT_EQ(shorter.front(), path.front());
    EXPECT_EQ(shorter.back(), path.back());
    EXPECT_LE(PathLength(space_, shorter), PathLength(space_, path) + 1e-12);
  }
}

TEST_F(ShortcutTest, EndsKeepTheirExactValues) {
  const Configuration beyond_a_turn = {0.6 + 2 * 3.14159265358979, 0, 0};
  Path path = around_post_;
  path.front() = beyond_a_turn;
  EXPECT_EQ(Shortcut(path, PostsScene()).front(), beyond_a_turn);
}

}  // namespace
}  // namespace planbench
