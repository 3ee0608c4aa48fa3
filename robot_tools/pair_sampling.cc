#include "robot_tools/pair_sampling.h"

#include <algorithm>
#include <functional>
#include <random>

#include "robot_tools/joint_draw.h"
#include "robot_tools/link_balls.h"
#include "robot_tools/link_chain.h"

namespace planbench {
namespace {

constexpr double kNearlyAll = 0.95;

// The spheres of the links of a robot at a configuration.
class PlacedSpheres {
 public:
  explicit PlacedSpheres(const Robot& robot) : robot_(robot) {
    for (int link = 0; link < robot.model.num_links(); ++link) {
      by_link_.push_back(BallsOfLink(robot.spheres, link));
    }
  }

  std::vector<PairSamples::Pair> CheckedPairs() const {
    std::vector<PairSamples::Pair> pairs;
    for (int b = 0; b < robot_.model.num_links(); ++b) {
      for (int a = 0; a < b; ++a) {
        if (Of(a).balls.empty() || Of(b).balls.empty() || !robot_.ChecksLinks(a, b)) continue;
        pairs.push_back({a, b});
      }
    }
    return pairs;
  }

  void MoveTo(const std::vector<double>& full_positions) {
    X_BL_ = ComputeLinkPoses(robot_.model, full_positions);
  }

  bool Touch(int link_a, int link_b) const {
    return BallsTouch(Of(link_a), Of(link_b), Pose(link_a).inverse() * Pose(link_b));
  }

 private:
  const LinkBalls& Of(int link) const { return by_link_[static_cast<std::size_t>(link)]; }
  const Eigen::Isometry3d& Pose(int link) const { return X_BL_[static_cast<std::size_t>(link)]; }

  const Robot& robot_;
  std::vector<LinkBalls> by_link_;
  std::vector<Eigen::Isometry3d> X_BL_;
};

std::vector<std::pair<int, int>> PairsThat(
    const std::vector<PairSamples::Pair>& pairs,
    const std::function<bool(const PairSamples::Pair&)>& hold) {
  std::vector<std::pair<int, int>> those;
  for (const PairSamples::Pair& pair : pairs) {
    if (hold(pair)) those.emplace_back(pair.link_a, pair.link_b);
  }
  return those;
}

}  // namespace

std::vector<std::pair<int, int>> PairSamples::Never() const {
  return PairsThat(pairs, [](const Pair& pair) { return pair.contacts == 0 && !pair.anywhere; });
}

std::vector<std::pair<int, int>> PairSamples::Always() const {
  return PairsThat(pairs, [this](const Pair& pair) {
    return pair.contacts >= kNearlyAll * samples && !pair.anywhere;
  });
}

std::vector<std::pair<int, int>> PairSamples::Anywhere() const {
  return PairsThat(pairs, [](const Pair& pair) { return pair.anywhere; });
}

std::vector<std::pair<int, int>> PairSamples::HeldInContact() const {
  return PairsThat(pairs, [](const Pair& pair) { return pair.contacts > 0 && !pair.is_moved; });
}

std::vector<PairSamples::Pair> PairSamples::MostOften(std::size_t at_most) const {
  std::vector<Pair> met = pairs;
  std::erase_if(met, [](const Pair& pair) { return pair.contacts == 0 || !pair.is_moved; });
  std::ranges::stable_sort(met, std::ranges::greater(), &Pair::contacts);
  if (met.size() > at_most) met.resize(at_most);
  return met;
}

PairSamples SamplePairs(const Robot& robot, const PairSampling& sampling) {
  PlacedSpheres placed(robot);
  PairSamples result{sampling.samples, 0, placed.CheckedPairs()};
  for (PairSamples::Pair& pair : result.pairs) {
    pair.is_moved = JointsMove(robot.model, sampling.joints, pair.link_a, pair.link_b);
    pair.anywhere = AnywhereByPose(robot.model, pair.link_a, pair.link_b);
  }
  std::mt19937_64 random(sampling.seed);
  std::vector<double> positions = robot.model.DefaultPositions();
  for (int i = 0; i < sampling.samples; ++i) {
    DrawPositions(robot.model, sampling.joints, &random, &positions);
    placed.MoveTo(positions);
    bool is_free = true;
    bool is_free_if_moved = true;
    for (PairSamples::Pair& pair : result.pairs) {
      if (!placed.Touch(pair.link_a, pair.link_b)) continue;
      ++pair.contacts;
      is_free = false;
      if (pair.is_moved) is_free_if_moved = false;
    }
    if (is_free) ++result.free;
    if (is_free_if_moved) ++result.free_if_moved;
  }
  return result;
}

std::vector<std::pair<int, int>> PairsInContact(const Robot& robot,
                                                const std::vector<double>& full_positions) {
  PlacedSpheres placed(robot);
  placed.MoveTo(full_positions);
  std::vector<std::pair<int, int>> touching;
  for (const PairSamples::Pair& pair : placed.CheckedPairs()) {
    if (placed.Touch(pair.link_a, pair.link_b)) touching.emplace_back(pair.link_a, pair.link_b);
  }
  return touching;
}

}  // namespace planbench
