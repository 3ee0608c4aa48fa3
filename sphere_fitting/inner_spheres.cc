#include "sphere_fitting/inner_spheres.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "sphere_fitting/body_samples.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

constexpr int kInsideSamples = 20'000;  // In the bounding box.
constexpr double kDepthMargin = 1e-6;   // m: more than rounding does to depths.
constexpr double kLeastGain = 0.002;    // of the samples

std::vector<Vector3d> InsideSamples(const LinkBody& link) {
  std::vector<Vector3d> samples = SampleBody(link, 1, kInsideSamples).inside;
  std::erase_if(samples, [&](const Vector3d& p) { return link.CoreDepth(p) <= kDepthMargin; });
  return samples;
}

// What a ball at a point of that depth adds: samples that no ball holds yet, and for its size.
double Gain(const std::vector<Vector3d>& left, const Vector3d& center, double depth) {
  if (depth <= kDepthMargin) return 0;
  const double depth2 = depth * depth;
  const auto held = std::count_if(left.begin(), left.end(), [&](const Vector3d& p) {
    return (p - center).squaredNorm() <= depth2;
  });
  return static_cast<double>(held) + depth;
}

}  // namespace

std::vector<Ball> FitInnerSpheres(const LinkBody& link, int most) {
  std::vector<Ball> balls = link.spheres();
  if (!link.has_solids()) return balls;
  std::vector<Vector3d> left = InsideSamples(link);
  std::vector<std::pair<Vector3d, double>> candidates;
  const std::size_t every = left.size() / 1500 + 1;
  for (std::size_t i = 0; i < left.size(); i += every) {
    candidates.emplace_back(left[i], link.CoreDepth(left[i]));
  }
  const double least = kLeastGain * static_cast<double>(left.size());
  while (balls.size() < static_cast<std::size_t>(most)) {
    Vector3d center = Vector3d::Zero();
    double depth = 0;
    double gain = 0;
    for (const auto& [p, depth_there] : candidates) {
      const double gain_there = Gain(left, p, depth_there);
      if (gain_there <= gain) continue;
      center = p;
      depth = depth_there;
      gain = gain_there;
    }
    double step = depth / 2;
    while (step > 1e-4) {
      bool better = false;
      for (int d = 0; d < 6 && !better; ++d) {
        const Vector3d to = center + (d % 2 == 0 ? step : -step) * Vector3d::Unit(d / 2);
        const double depth_there = link.CoreDepth(to);
        const double gain_there = Gain(left, to, depth_there);
        if (gain_there <= gain) continue;
        center = to;
        depth = depth_there;
        gain = gain_there;
        better = true;
      }
      if (!better) step /= 2;
    }
    if (gain < least || depth <= 0) break;
    const Vector3d rounded = (center * 1e4).array().round() / 1e4;
    const double radius = std::floor((link.CoreDepth(rounded) - kDepthMargin) * 1e6) / 1e6;
    if (radius <= 0) break;
    balls.push_back({rounded, radius});
    std::erase_if(left, [&](const Vector3d& p) { return (p - rounded).norm() <= radius; });
  }
  return balls;
}

}  // namespace planbench
