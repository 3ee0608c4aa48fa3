#include "sphere_fitting/center_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "common/random.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

constexpr double kInsideShare = 0.8;  // As many samples in the bounding box as on the surface.
constexpr std::size_t kCandidates = 2000;
constexpr int kSettleRounds = 4;  // After a centre has come.
constexpr int kRestRounds = 12;
constexpr double kServedShare = 0.75;  // A new centre is to bring costs below this of the worst.
constexpr double kFinestStep = 1e-4;   // m

Vector3d RandomDirection(std::mt19937_64* random) {
  while (true) {
    // z first, as for the spheres that ship: of a call's arguments the compiler would choose.
    Vector3d v;
    for (const int axis : {2, 1, 0}) v[axis] = 2 * UniformFraction(random) - 1;
    const double norm2 = v.squaredNorm();
    if (norm2 > 0.01 && norm2 <= 1) return v / std::sqrt(norm2);
  }
}

}  // namespace

CenterFit::CenterFit(const LinkBody& link, int num_samples) : link_(link) {
  const BodySamples samples =
      SampleBody(link, num_samples, static_cast<int>(kInsideShare * num_samples));
  spacing_m_ = samples.spacing_m;
  samples_ = samples.surface;
  samples_.insert(samples_.end(), samples.inside.begin(), samples.inside.end());
  const std::size_t every = samples_.size() / kCandidates + 1;
  for (std::size_t i = 0; i < samples_.size(); i += every) {
    candidates_.push_back(At(samples_[i]));
  }
  const auto deepest =
      std::max_element(candidates_.begin(), candidates_.end(),
                       [](const Center& a, const Center& b) { return a.depth < b.depth; });
  centers_.push_back(*deepest);
  Settle(kSettleRounds);
}

CenterFit::Center CenterFit::At(const Vector3d& p) const { return {p, link_.Depth(p)}; }

double CenterFit::Worst() const {
  double worst = -std::numeric_limits<double>::infinity();
  for (const Center& center : centers_) worst = std::max(worst, center.protrusion);
  return worst;
}

// Gives every sample to the centre of the least cost, of several the first. Those whose centre has
// stayed may have gone to one that has not: the others cost what they did.
void CenterFit::Assign() {
  owner_.resize(samples_.size(), centers_.size());
  cost_.resize(samples_.size());
  std::vector<std::size_t> all(centers_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<std::size_t> elsewhere;
  for (const std::size_t k : all) {
    centers_[k].protrusion = -std::numeric_limits<double>::infinity();
    if (centers_[k].elsewhere) elsewhere.push_back(k);
  }
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const bool stayed = owner_[i] < centers_.size() && !centers_[owner_[i]].elsewhere;
    std::size_t best = stayed ? owner_[i] : 0;
    double least = stayed ? cost_[i] : std::numeric_limits<double>::infinity();
    for (const std::size_t k : stayed ? elsewhere : all) {
      const double cost = (samples_[i] - centers_[k].p).norm() - centers_[k].depth;
      if (cost < least || (cost == least && k < best)) {
        least = cost;
        best = k;
      }
    }
    if (owner_[i] != best) {
      if (owner_[i] < centers_.size()) centers_[owner_[i]].moved = true;
      centers_[best].moved = true;
      owner_[i] = best;
    }
    cost_[i] = least;
    centers_[best].protrusion = std::max(centers_[best].protrusion, least);
  }
  for (Center& center : centers_) center.elsewhere = false;
}

// Moves a centre downhill to where the highest cost of its samples is least: steps along the axes,
// towards the farthest sample and in random directions, halved when none helps.
void CenterFit::Recenter(std::size_t k, const std::vector<std::size_t>& samples) {
  const auto farthest = [&](const Vector3d& p) {
    std::pair<double, std::size_t> most = {-1, 0};
    for (const std::size_t i : samples) {
      const double distance2 = (samples_[i] - p).squaredNorm();
      if (distance2 >= most.first) most = {distance2, i};
    }
    return most;
  };
  Vector3d p = centers_[k].p;
  auto far = farthest(p);
  double depth = centers_[k].depth;
  double cost = std::sqrt(far.first) - depth;
  double step = 0.25 * std::sqrt(far.first);
  while (step > kFinestStep) {
    std::array<Vector3d, 10> directions;
    directions[0] = (samples_[far.second] - p).normalized();
    for (std::size_t d = 1; d <= 6; ++d) {
      directions[d] =
          Vector3d::Unit(static_cast<Eigen::Index>((d - 1) / 2)) * (d % 2 == 0 ? 1 : -1);
    }
    for (std::size_t d = 7; d < directions.size(); ++d) directions[d] = RandomDirection(&random_);
    bool better = false;
    for (const Vector3d& direction : directions) {
      const Vector3d to = p + step * direction;
      const auto far_there = farthest(to);
      // No depth can exceed that of the centre by more than the step.
      if (std::sqrt(far_there.first) - (depth + step) >= cost) continue;
      const double depth_there = link_.Depth(to);
      const double cost_there = std::sqrt(far_there.first) - depth_there;
      if (cost_there >= cost - 1e-9) continue;
      p = to;
      far = far_there;
      depth = depth_there;
      cost = cost_there;
      better = true;
      break;
    }
    if (!better) step /= 2;
  }
  centers_[k].elsewhere |= p != centers_[k].p;
  centers_[k].p = p;
  centers_[k].depth = depth;
}

// Assigns and moves in turn until centres rest.
void CenterFit::Settle(int rounds) {
  Assign();
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::vector<std::size_t>> samples(centers_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) samples[owner_[i]].push_back(i);
    bool rest = true;
    for (std::size_t k = 0; k < centers_.size(); ++k) {
      if (!centers_[k].moved || samples[k].empty()) continue;
      centers_[k].moved = false;
      Recenter(k, samples[k]);
      rest = false;
    }
    if (rest) return;
    Assign();
  }
}

// Adds the candidate that serves best the samples whose cost is near the worst, that one among
// them.
void CenterFit::Insert() {
  const auto worst =
      static_cast<std::size_t>(std::max_element(cost_.begin(), cost_.end()) - cost_.begin());
  const double served = kServedShare * cost_[worst];
  std::vector<std::size_t> bad;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (cost_[i] > served) bad.push_back(i);
  }
  Center best = At(samples_[worst]);
  std::size_t most = 0;
  for (const Center& candidate : candidates_) {
    const double reach = candidate.depth + served;
    const auto serves = [&](std::size_t i) {
      return reach > 0 && (samples_[i] - candidate.p).squaredNorm() <= reach * reach;
    };
    if (!serves(worst)) continue;
    const auto count = static_cast<std::size_t>(std::count_if(bad.begin(), bad.end(), serves));
    if (count > most) {
      most = count;
      best = candidate;
    }
  }
  centers_.push_back(best);
}

void CenterFit::Grow() {
  Insert();
  Settle(kSettleRounds);
}

// What the centres are to lower: high protrusions above all.
double CenterFit::Burden() const {
  double burden = 0;
  for (const std::size_t k : owner_) {
    const double protrusion = std::max(0.0, centers_[k].protrusion);
    burden += protrusion * protrusion * protrusion;
  }
  return burden;
}

// The centre whose samples the others would serve best.
std::size_t CenterFit::LeastMissed() const {
  std::vector<double> missed(centers_.size(), 0);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    double second = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < centers_.size(); ++k) {
      if (k == owner_[i]) continue;
      second = std::min(second, (samples_[i] - centers_[k].p).norm() - centers_[k].depth);
    }
    missed[owner_[i]] = std::max(missed[owner_[i]], second);
  }
  return static_cast<std::size_t>(std::min_element(missed.begin(), missed.end()) - missed.begin());
}

void CenterFit::Improve(int rounds) {
  Settle(rounds > 0 ? kRestRounds : kSettleRounds);
  for (int round = 0; round < rounds && size() > 2; ++round) {
    const State before = {centers_, owner_, cost_};
    const double burden = Burden();
    Shrink(1);
    Insert();
    Settle(2 * kSettleRounds);
    if (Burden() < burden) continue;
    centers_ = before.centers;
    owner_ = before.owner;
    cost_ = before.cost;
    return;
  }
}

void CenterFit::Shrink(int fewer) {
  for (; fewer > 0 && size() > 1; --fewer) {
    centers_.erase(centers_.begin() + static_cast<std::ptrdiff_t>(LeastMissed()));
    owner_.clear();  // The centres' numbers have changed.
    Assign();
  }
}

void CenterFit::AddSamples(const std::vector<Vector3d>& points) {
  samples_.insert(samples_.end(), points.begin(), points.end());
  owner_.clear();
  Assign();
}

std::vector<Ball> CenterFit::Balls() const {
  std::vector<Ball> balls;
  for (const Center& center : centers_) {
    const Vector3d rounded = (center.p * 1e4).array().round() / 1e4;
    balls.push_back({rounded, 1e-6});
  }
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    Ball& ball = balls[owner_[i]];
    ball.radius = std::max(ball.radius, (samples_[i] - ball.center).norm());
  }
  for (Ball& ball : balls) ball.radius = std::ceil(ball.radius * 1e6) / 1e6;
  return balls;
}

}  // namespace planbench
