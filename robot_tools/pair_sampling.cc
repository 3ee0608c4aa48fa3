#include "robot_tools/pair_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "common/random.h"

namespace planbench {
namespace {

constexpr double kNearlyAll = 0.95;

// The spheres of the links of a robot at a configuration.
class PlacedSpheres {
 public:
  PlacedSpheres(const RobotModel& model, const std::vector<LinkSphere>& spheres)
      : model_(model),
        by_link_(static_cast<std::size_t>(model.num_links())),
        bounds_(static_cast<std::size_t>(model.num_links())) {
    for (const LinkSphere& sphere : spheres) {
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

  std::vector<PairSamples::Pair> CheckablePairs() const {
    std::vector<PairSamples::Pair> pairs;
    for (int b = 0; b < model_.num_links(); ++b) {
      for (int a = 0; a < b; ++a) {
        if (Of(a).empty() || Of(b).empty() || model_.Adjacent(a, b)) continue;
        pairs.push_back({a, b, 0});
      }
    }
    return pairs;
  }

  void MoveTo(const std::vector<double>& full_positions) {
    X_BL_ = ComputeLinkPoses(model_, full_positions);
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

  const RobotModel& model_;
  std::vector<std::vector<Ball>> by_link_;
  std::vector<Ball> bounds_;
  std::vector<Eigen::Isometry3d> X_BL_;
};

std::vector<double> RandomPositions(const RobotModel& model, std::mt19937_64* random) {
  std::vector<double> positions = model.DefaultPositions();
  for (const Joint& joint : model.joints()) {
    if (NumPositions(joint.type) != 1 || joint.leader >= 0) continue;
    const bool bounded = std::isfinite(joint.lower);
    const double lower = bounded ? joint.lower : -std::numbers::pi;
    const double upper = bounded ? joint.upper : std::numbers::pi;
    positions[static_cast<std::size_t>(joint.position_index)] =
        lower + UniformFraction(random) * (upper - lower);
  }
  return positions;
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

PairSamples SamplePairs(const RobotModel& model, const std::vector<LinkSphere>& spheres,
                        int samples, std::uint64_t seed) {
  PlacedSpheres placed(model, spheres);
  PairSamples result{samples, placed.CheckablePairs()};
  std::mt19937_64 random(seed);
  for (int i = 0; i < samples; ++i) {
    placed.MoveTo(RandomPositions(model, &random));
    for (PairSamples::Pair& pair : result.pairs) {
      if (placed.Touch(pair.link_a, pair.link_b)) ++pair.contacts;
    }
  }
  return result;
}

std::vector<std::pair<int, int>> PairsInContact(const RobotModel& model,
                                                const std::vector<LinkSphere>& spheres,
                                                const std::vector<std::pair<int, int>>& allowed,
                                                const std::vector<double>& full_positions) {
  std::set<std::pair<int, int>> skipped;
  for (const auto& [a, b] : allowed) skipped.insert(std::minmax(a, b));
  PlacedSpheres placed(model, spheres);
  placed.MoveTo(full_positions);
  std::vector<std::pair<int, int>> touching;
  for (const PairSamples::Pair& pair : placed.CheckablePairs()) {
    const std::pair<int, int> links(pair.link_a, pair.link_b);
    if (!skipped.contains(links) && placed.Touch(pair.link_a, pair.link_b)) {
      touching.push_back(links);
    }
  }
  return touching;
}

double FreeShare(const RobotModel& model, const std::vector<LinkSphere>& spheres,
                 const std::vector<std::pair<int, int>>& allowed, int samples, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  int num_free = 0;
  for (int i = 0; i < samples; ++i) {
    const std::vector<double> positions = RandomPositions(model, &random);
    if (PairsInContact(model, spheres, allowed, positions).empty()) ++num_free;
  }
  return static_cast<double>(num_free) / samples;
}

}  // namespace planbench
