#include "planner_ara/guide.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/two_arm_robot.h"

namespace planbench {
namespace {

using Point = std::vector<Lattice::Coordinate>;

// Two arms of two joints, cells of 0.5 rad; the goal is two cells up in every joint.
class GuideTest : public testing::Test {
 protected:
  GuideTest() {
    for (int j = 0; j < lattice_.num_joints(); ++j) {
      goal_cells_.push_back(static_cast<Lattice::Coordinate>(Start()[0] + 2));
      std::vector<double>& terms = goal_terms_.emplace_back();
      for (int k = 0; k < lattice_.num_cells(j); ++k) {
        const double off = 0.5 * (k - goal_cells_.back());
        terms.push_back(off * off);
      }
    }
  }

  Guide Make(const Arms& arms, double crowding) const {
    return Guide(&lattice_, &goal_terms_, &goal_cells_, arms, 1, crowding, {1, 1, 1, 1});
  }
  const Point& Start() const { return lattice_.anchor(); }
  Point From(const std::vector<int>& cells) const {
    Point point = Start();
    for (std::size_t j = 0; j < cells.size(); ++j) {
      point[j] = static_cast<Lattice::Coordinate>(point[j] + cells[j]);
    }
    return point;
  }
  double Distance(const Point& point) const {
    double sum = 0;
    for (std::size_t j = 0; j < point.size(); ++j) sum += goal_terms_[j][point[j]];
    return std::sqrt(sum);
  }

  const Robot robot_ = MakeTwoArmRobot();
  const Arms one_ = OneArm(robot_.groups.front());
  const Arms two_ = ArmsOf(robot_.model, robot_.groups.front());
  const Lattice lattice_{robot_.groups.front().space, std::vector<double>(4, 0.0),
                         std::vector<double>(4, 0.5)};
  Point goal_cells_;
  std::vector<std::vector<double>> goal_terms_;
};

TEST_F(GuideTest, IsTheDistanceAndMoreInCrowdedPlaces) {
  Guide guide = Make(one_, 0.5);
  const Point near = From({1, 0, 0, 0});
  double last = 0;
  for (int n = 0; n < 20; ++n) {
    guide.SelectSource(Start(), {});
    const double crowd = 1 + 0.5 * (std::log2(1 + n) + n / 5.0);
    EXPECT_FLOAT_EQ(guide(near, Distance(near)), static_cast<float>(crowd * Distance(near)));
    EXPECT_GT(guide(near, Distance(near)), last);
    last = guide(near, Distance(near));
  }
  guide.SelectSource(near, {});  // another place
  EXPECT_FLOAT_EQ(guide(near, Distance(near)), static_cast<float>(Distance(near)));
}

TEST_F(GuideTest, MeasuresByOtherTermsInPlacesNotCrowdedYet) {
  std::vector<std::vector<double>> other_terms = goal_terms_;
  for (double& term : other_terms[0]) term = 9;
  const Point near = From({2, 2, 2, 0});
  for (const Arms& arms : {one_, two_}) {
    Guide guide = Make(arms, 0.5);
    for (int n = 0; n < 20; ++n) guide.SelectSource(near, {});
    guide.MeasureBy(&other_terms);
    guide.SelectSource(near, {});
    const double expected = arms.num == 1 ? std::sqrt(9 + 1) : 3 + 1;
    EXPECT_FLOAT_EQ(guide(near, Distance(near)), static_cast<float>(expected));
  }
}

TEST_F(GuideTest, PutsOffStatesInWhichSeveralArmsAreUnderWay) {
  Guide guide = Make(two_, 0);
  guide.SelectSource(Start(), {});
  const auto of = [&](const Point& point) { return guide(point, Distance(point)); };
  const float all_the_way = 2 * std::sqrt(2.0f);
  EXPECT_FLOAT_EQ(of(Start()), all_the_way);
  EXPECT_LT(of(From({1, 1, 0, 0})), all_the_way);            // one has moved
  EXPECT_FLOAT_EQ(of(From({2, 2, 0, 0})), all_the_way / 2);  // and is there
  EXPECT_FLOAT_EQ(of(From({2, 2, 2, 2})), 0);
  // Both halfway: as far as one all the way, and more.
  EXPECT_GT(of(From({1, 1, 1, 1})), all_the_way / 2 * 1.1f);
  EXPECT_LT(of(From({1, 1, 1, 1})), of(From({1, 1, 0, 0})));
}

TEST_F(GuideTest, AnArmThatWaitsCrowdsNoPlace) {
  Guide guide = Make(two_, 1);
  // The left arm stuck, with the right one at the start and then at the goal: one place.
  const Point stuck = From({1, 0, 0, 0});
  const Point later = From({1, 0, 2, 2});
  const auto of = [&](const Point& source, const Point& target) {
    guide.SelectSource(source, {});
    return guide(target, Distance(target));
  };
  const float first = of(stuck, stuck);
  EXPECT_GT(of(stuck, stuck), first);
  for (int i = 0; i < 10; ++i) of(stuck, stuck);
  EXPECT_GT(of(later, later), 5 * Distance(later));
  // Nothing is crowded where both wait.
  for (int i = 0; i < 10; ++i) of(Start(), Start());
  EXPECT_FLOAT_EQ(of(Start(), Start()), static_cast<float>(std::sqrt(2.0) * Distance(Start())));
}

}  // namespace
}  // namespace planbench
