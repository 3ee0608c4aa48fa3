#include "robot_tools/pair_sampling.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "common/random.h"

namespace planbench {
namespace {

constexpr double kNearlyAll = 0.95;

// The spheres of the links of a robot at a configuration.
class PlacedSpheres {
 public:
  explicit PlacedSpheres(const Robot& robot)
      : robot_(robot),
        by_link_(static_cast<std::size_t>(robot.model.num_links())),
        bounds_(static_cast<std::size_t>(robot.model.num_links())) {
    for (const LinkSphere& sphere : robot.spheres) {
      by_link_[static_cast<std::size_t>(sphere.link)].push_back({sphere.p_LS, sphere.radius});
    }
    for (std::size_t link = 0; link < by_link_.size(); ++link) {
      if (by_link_[link].empty()) continue;
      Ball& bound = bounds_[link];
      for (const Ball& ball : by_link_[link]) bound.center += ball.center;
      bound.center /= static_cast<double>(by_link_[link].size());
      for (const Ball& ball : by_link_[link]) {
        bound.radius = std::max(bound.radius, (ball.center - bound.center).norm() + ball.radius);
      }
    }
  }

  std::vector<PairSamples::Pair> CheckedPairs() const {
    std::vector<PairSamples::Pair> pairs;
    for (int b = 0; b < robot_.model.num_links(); ++b) {
      for (int a = 0; a < b; ++a) {
        if (Of(a).empty() || Of(b).empty() || !robot_.ChecksLinks(a, b)) continue;
        pairs.push_back({a, b, 0});
      }
    }
    return pairs;
  }

  void MoveTo(const std::vector<double>& full_positions) {
    X_BL_ = ComputeLinkPoses(robot_.model, full_positions);
  }

  bool Touch(int link_a, int link_b) const {
    // In the frame of link a.
    const Eigen::Isometry3d X_AB =
        X_BL_[static_cast<std::size_t>(link_a)].inverse() * X_BL_[static_cast<std::size_t>(link_b)];
    const Ball bound_b = Moved(X_AB, bounds_[static_cast<std::size_t>(link_b)]);
    if (!Meet(bounds_[static_cast<std::size_t>(link_a)], bound_b)) return false;
    for (const Ball& b : Of(link_b)) {
      const Ball ball_b = Moved(X_AB, b);
      for (const Ball& ball_a : Of(link_a)) {
        if (Meet(ball_a, ball_b)) return true;
      }
    }
    return false;
  }

 private:
  struct Ball {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double radius = 0;
  };

  const std::vector<Ball>& Of(int link) const { return by_link_[static_cast<std::size_t>(link)]; }
  static Ball Moved(const Eigen::Isometry3d& X, const Ball& ball) {
    return {X * ball.center, ball.radius};
  }
  static bool Meet(const Ball& a, const Ball& b) {
    const double reach = a.radius + b.radius;
    return (a.center - b.center).squaredNorm() <= reach * reach;
  }

  const Robot& robot_;
  std::vector<std::vector<Ball>> by_link_;
  std::vector<Ball> bounds_;
  std::vector<Eigen::Isometry3d> X_BL_;
};

void DrawPositions(const RobotModel& model, const std::vector<int>& joints, std::mt19937_64* random,
                   std::vector<double>* positions) {
  for (const int index : joints) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(index)];
    const bool bounded = std::isfinite(joint.lower);
    const double lower = bounded ? joint.lower : -std::numbers::pi;
    const double upper = bounded ? joint.upper : std::numbers::pi;
    (*positions)[static_cast<std::size_t>(joint.position_index)] =
        lower + UniformFraction(random) * (upper - lower);
  }
}

}  // namespace

std::vector<std::pair<int, int>> PairSamples::Never() const {
  std::vector<std::pair<int, int>> never;
  for (const Pair& pair : pairs) {
    if (pair.contacts == 0) never.emplace_back(pair.link_a, pair.link_b);
  }
  return never;
}

std::vector<std::pair<int, int>> PairSamples::Always() const {
  std::vector<std::pair<int, int>> always;
  for (const Pair& pair : pairs) {
    if (pair.contacts >= kNearlyAll * samples) always.emplace_back(pair.link_a, pair.link_b);
  }
  return always;
}

std::vector<PairSamples::Pair> PairSamples::MostOften(std::size_t at_most) const {
  std::vector<Pair> met = pairs;
  std::erase_if(met, [](const Pair& pair) { return pair.contacts == 0; });
  std::ranges::stable_sort(met, std::ranges::greater(), &Pair::contacts);
  if (met.size() > at_most) met.resize(at_most);
  return met;
}

std::vector<int> JointsToDraw(const RobotModel& model) {
  std::vector<int> joints;
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    const Joint& joint = model.joints()[j];
    if (NumPositions(joint.type) == 1 && joint.leader < 0) joints.push_back(static_cast<int>(j));
  }
  return joints;
}

PairSamples SamplePairs(const Robot& robot, const PairSampling& sampling) {
  PlacedSpheres placed(robot);
  PairSamples result{sampling.samples, 0, placed.CheckedPairs()};
  std::mt19937_64 random(sampling.seed);
  std::vector<double> positions = robot.model.DefaultPositions();
  for (int i = 0; i < sampling.samples; ++i) {
    DrawPositions(robot.model, sampling.joints, &random, &positions);
    placed.MoveTo(positions);
    bool is_free = true;
    for (PairSamples::Pair& pair : result.pairs) {
      if (!placed.Touch(pair.link_a, pair.link_b)) continue;
      ++pair.contacts;
      is_free = false;
    }
    if (is_free) ++result.free;
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
