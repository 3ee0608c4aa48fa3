#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "geometry/ball.h"
#include "sphere_fitting/body_samples.h"
#include "sphere_fitting/link_body.h"

namespace planbench {

/// The centres of balls that contain samples of a link's meshes, boxes and cylinders and protrude
/// little: see FitOuterSpheres. Begins with one. Deterministic.
class CenterFit {
 public:
  /// `link` must have such shapes, and outlive this. About `samples` stand for its surface, fewer
  /// for its inside.
  CenterFit(const LinkBody& link, int samples);

  int size() const { return static_cast<int>(centers_.size()); }
  /// How far the ball that protrudes most does so, m.
  double Worst() const;
  /// One more centre, at the samples that are served worst, and a few moves of those around it.
  void Grow();
  /// All centres move for a while; then those that do little are put where much is to be done, as
  /// long as that helps, at most `rounds` times.
  void Improve(int rounds);
  /// So many centres fewer, one at least left: those whose samples the others serve best.
  void Shrink(int fewer);
  /// Points that are to be contained too.
  void AddSamples(const std::vector<Eigen::Vector3d>& points);
  double spacing_m() const { return spacing_m_; }

  /// The balls: centres to the tenth of a millimetre, radii rounded up to the micrometre.
  std::vector<Ball> Balls() const;

 private:
  struct Center {
    Eigen::Vector3d p;
    double depth = 0;       // m
    double protrusion = 0;  // The highest cost of its samples, m.
    bool moved = true;      // Its samples have changed since it came to rest.
    bool elsewhere = true;  // It has another place than when samples were given to centres last.
  };
  struct State {
    std::vector<Center> centers;
    std::vector<std::size_t> owner;  // Of each sample.
    std::vector<double> cost;
  };
  void Assign();
  void Settle(int rounds);
  void Recenter(std::size_t k, const std::vector<std::size_t>& samples);
  void Insert();
  std::size_t LeastMissed() const;
  double Burden() const;
  Center At(const Eigen::Vector3d& p) const;

  const LinkBody& link_;
  std::vector<Eigen::Vector3d> samples_;
  std::vector<Center> candidates_;
  std::vector<Center> centers_;
  std::vector<std::size_t> owner_;
  std::vector<double> cost_;
  double spacing_m_ = 0;
  std::mt19937_64 random_{1};
};

}  // namespace planbench
